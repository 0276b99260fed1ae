// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include "kestrel/vision/landing/image_region.h"
#include "kestrel/vision/landing/plane_warp.h"
#include "kestrel/vision/landing/print_outline.h"

namespace kestrel {

inline constexpr double kLensBlurPx = 0.7;  // of optics and pixels, standard deviation

// An edge of the image near to where a place of the outline is expected.
struct PrintEdge {
  const PrintOutline::Place* place;
  Eigen::Vector2d expected_px;  // where the place is expected, full resolution
  Eigen::Vector2d across;       // unit normal of the outline there, in the image
  double offset_px;             // of the edge from there along 'across'
  double bend;                  // half of the outline's curvature in the image, 1/px
  bool follows;                 // the edge before is its neighbour on the outline

  Eigen::Vector2d pixel() const { return expected_px + offset_px * across; }
};

// The edges of the image along the outlines of a print.
struct PrintEdges {
  std::array<PrintEdge, PrintOutline::kMaxPlaces> edges;
  std::size_t count = 0;
  int in_image = 0;                                     // places whose surroundings the image shows
  std::array<int, PrintOutline::kParts> part_places{};  // by part: looked for, in the image
  std::array<int, PrintOutline::kParts> part_in_image{};
  double spread_px = 0;  // of the black over the white: by how much all edges are off

  std::span<const PrintEdge> all() const { return std::span(edges).first(count); }

  // Whether a quarter of the places that were looked at is out of view.
  bool IsPart() const;

  // How far (px) an edge is off where it is expected, but for the spread.
  double ResidualOf(const PrintEdge& edge) const { return edge.offset_px - spread_px; }
};

// How edges are looked for.
struct EdgeSearch {
  double reach_px;         // how far from where they are expected, pixels of the image
  double min_step;         // gray values per pixel below which a change in full light is no edge
  std::size_t stride = 1;  // every so many places
};

// Looks along the normal of each place for the steepest rise of brightness, to a fraction of a
// pixel. 'image' is CV_8UC1 and shows 'region'. Does not allocate.
void FindPrintEdges(const cv::Mat& image, const ImageRegion& region, const PlaneWarp& warp,
                    std::span<const PrintOutline::Place> places, const EdgeSearch& search,
                    PrintEdges* found);

}  // namespace kestrel
