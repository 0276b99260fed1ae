// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>

#include <opencv2/core.hpp>

#include "kestrel/vision/landing/image_region.h"
#include "kestrel/vision/landing/pattern_match.h"
#include "kestrel/vision/landing/plane_warp.h"
#include "kestrel/vision/landing/print_edges.h"
#include "kestrel/vision/landing/print_outline.h"

namespace kestrel {

// Where an image shows a print, by its edges and whatever else is true of the lens and the sheet.
struct PrintAlignment {
  PlaneWarp warp;
  PrintEdges edges;            // where the warp has them, and how far off they are
  double edge_rms_px = 0;      // of that, weighted
  double center_sigma_px = 0;  // of where the warp has the middle of the print, per axis

  // Of arms and ring, of their places in view those that have an edge in its place. Not in view is
  // what the image shows less than a quarter of.
  PartShares EdgeShares() const;
};

// Brings the displacement of 'warp' to where the edges of the print are in the image: robust least
// squares over a polynomial whose higher orders are held small by priors. 'view' shows 'region';
// steps that come from far away are made on it. 'reach_px', 'min_step': as in EdgeSearch, the
// former at full resolution. False when there are too few edges. Does not allocate.
bool AlignPrint(const cv::Mat& image, const cv::Mat& view, const ImageRegion& region,
                std::span<const PrintOutline::Place> places, double reach_px, double min_step,
                PrintAlignment* alignment);

}  // namespace kestrel
