// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>

#include <opencv2/core.hpp>

#include "kestrel/vision/landing/alignment/part_shares.h"
#include "kestrel/vision/landing/alignment/print_edges.h"
#include "kestrel/vision/landing/alignment/print_outline.h"
#include "kestrel/vision/landing/image_region.h"
#include "kestrel/vision/target/plane_warp.h"

namespace kestrel {

// Location of a print in an image by its edges, independent of errors of lens and sheet.
struct PrintAlignment {
  PlaneWarp warp;
  PrintEdges edges;            // expected where the warp has the outlines
  double edge_rms_px = 0;      // weighted root mean square of their offsets
  double center_sigma_px = 0;  // standard deviation of the warped middle of the print, per axis

  // Returns for arms and ring the share of places in view with an edge in its place. Negative where
  // less than a quarter of a part's places is in view.
  PartShares EdgeShares() const;
};

// Fits the displacement of 'warp' to the edges of the print in the image: robust least squares over
// a polynomial, with priors that keep its higher orders small. 'view' shows 'region'; the first
// steps, which search far, use it. 'reach_px' (at full resolution) and 'min_step': as in
// EdgeSearch. False when there are too few edges. Does not allocate.
bool AlignPrint(const cv::Mat& image, const cv::Mat& view, const ImageRegion& region,
                std::span<const PrintOutline::Place> places, double reach_px, double min_step,
                PrintAlignment* alignment);

}  // namespace kestrel
