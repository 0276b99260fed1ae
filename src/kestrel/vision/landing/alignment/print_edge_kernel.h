// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Searches for edges at many places of an outline at once, with the best vector instructions of the
// machine, chosen at run time.

#include <array>
#include <cstddef>

#include <opencv2/core.hpp>

#include "kestrel/vision/landing/alignment/print_outline.h"

namespace kestrel {

// Places of an outline, by columns.
struct PlaceColumns {
  using Column = std::array<float, PrintOutline::kMaxPlaces>;

  Column x_m, y_m;            // in the plane of the print
  Column normal_x, normal_y;  // unit vector in the plane, from black to white
  // Image of the places, px; NaN where the lens does not show them. Derivative by the place, px/m.
  Column x_px, y_px;
  std::array<Column, 4> by_place;  // row by row

  Column across_x, across_y;  // unit normal of the outline in the image
  Column px_per_m;            // scale along that normal
  Column bend;  // half of (curvature of an outline in the image / its curvature in the plane), m/px
  Column offset_px;  // offset of the edge along the normal; see SearchEdges
};

// Computes the outline's normals in the image from those in the plane.
void TurnNormals(std::size_t count, PlaceColumns* places);

// The search window of an edge, in pixels of the image.
struct EdgeWindow {
  float offset_x, offset_y, scale;  // pixel of the image = offset + scale * pixel of a place
  int reach;
  float min_step;  // gray values per pixel
};

// Writes for each place the offset along its normal of the steepest rise of brightness, in pixels
// of the image: NaN where a part of the window is out of view, infinity where there is no edge.
void SearchEdges(const cv::Mat& image, const EdgeWindow& window, std::size_t count,
                 PlaceColumns* places);

}  // namespace kestrel
