// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// The search for edges at many places of an outline at once, with the best instructions of the
// machine at run time.

#include <array>
#include <cstddef>

#include <opencv2/core.hpp>

#include "kestrel/vision/landing/print_outline.h"

namespace kestrel {

// Places of an outline, by columns.
struct PlaceColumns {
  using Column = std::array<float, PrintOutline::kMaxPlaces>;

  Column x_m, y_m;            // in the plane
  Column normal_x, normal_y;  // the same, unit vector from black to white
  // Where an image shows the places; NaN where the lens does not. Derivative by the place, px/m.
  Column x_px, y_px;
  std::array<Column, 4> by_place;  // row by row

  Column across_x, across_y;  // unit normal of the outline in the image
  Column px_per_m;            // along it
  Column bend;       // half of an outline's curvature in the image over that in the plane, m/px
  Column offset_px;  // of the edge along it; see SearchEdges
};

// Turns the outline's normals into those of the image.
void TurnNormals(std::size_t count, PlaceColumns* places);

// Where an edge is looked for, pixels of the image.
struct EdgeWindow {
  float offset_x, offset_y, scale;  // pixel of the image = offset + scale * pixel of a place
  int reach;
  float min_step;  // gray values per pixel
};

// How far along its normal each place has the steepest rise of brightness, pixels of the image: NaN
// where that does not show all that is looked at, infinity where there is no edge.
void SearchEdges(const cv::Mat& image, const EdgeWindow& window, std::size_t count,
                 PlaceColumns* places);

}  // namespace kestrel
