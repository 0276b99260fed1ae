// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include "kestrel/vision/landing/alignment/print_outline.h"
#include "kestrel/vision/landing/image_region.h"
#include "kestrel/vision/target/plane_warp.h"

namespace kestrel {

// For fits to the edges of a print.
struct EdgeFit {
  static constexpr std::size_t kLeastEdges = 12;  // two for each unknown of a pose
  static constexpr double kLeastScalePx = 0.25;  // for robust weights; edges are that exact at best
  // The first steps use every kCoarseStride-th edge or place, when these have at least kFewEdges
  // edges. The stride is odd so that both sides of the arms are used.
  static constexpr std::size_t kCoarseStride = 3;
  static constexpr std::size_t kFewEdges = 36;
};

// An edge of the image near the expected image of a place of the outline.
struct PrintEdge {
  const PrintOutline::Place* place;
  Eigen::Vector2d expected_px;  // expected image of the place, full resolution
  Eigen::Vector2d across;       // unit normal of the outline there, in the image
  double offset_px;             // offset of the edge from there, along 'across'
  double bend;                  // half of the outline's curvature in the image, 1/px
  bool follows;  // true when the edge before this one is its neighbour on the outline

  Eigen::Vector2d pixel() const { return expected_px + offset_px * across; }
};

// The edges of an image along the outlines of a print.
struct PrintEdges {
  std::array<PrintEdge, PrintOutline::kMaxPlaces> edges;
  std::size_t count = 0;
  int in_image = 0;                                     // places whose surroundings are in view
  std::array<int, PrintOutline::kParts> part_places{};  // by part: looked for
  std::array<int, PrintOutline::kParts> part_in_image{};
  double spread_px = 0;  // spread of the black over the white: common offset of all edges

  std::span<const PrintEdge> all() const { return std::span(edges).first(count); }

  // True when more than a quarter of the places looked for is out of view.
  bool IsPart() const;

  // Offset (px) of an edge from where it is expected, without the spread.
  double ResidualOf(const PrintEdge& edge) const { return edge.offset_px - spread_px; }
};

// Parameters of the search for edges.
struct EdgeSearch {
  double reach_px;         // distance from the expected image, in pixels of the image searched
  double min_step;         // gray values per pixel; a smaller change in full light is no edge
  std::size_t stride = 1;  // looks at every stride-th place
};

// Finds the steepest rise of brightness along the normal of each place, to a fraction of a pixel.
// 'image' is CV_8UC1 and shows 'region'. Does not allocate.
void FindPrintEdges(const cv::Mat& image, const ImageRegion& region, const PlaneWarp& warp,
                    std::span<const PrintOutline::Place> places, const EdgeSearch& search,
                    PrintEdges* found);

}  // namespace kestrel
