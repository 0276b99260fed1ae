// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include "kestrel/vision/objects/segmentation/segmentation.h"

namespace kestrel {

// Corners of a cuboid's upper face in the image, px, in order around it.
using FaceCorners = std::array<Eigen::Vector2d, 4>;

// Memory of FindCuboidFace.
struct CuboidFaceWorkspace {
  std::vector<std::uint8_t> mask;
  std::vector<std::uint8_t> values;
  std::vector<std::uint8_t> smooth;
  std::vector<std::uint8_t> filtered;
  std::vector<std::size_t> digit;  // pixels of the digit
  std::vector<std::size_t> queue;
  std::vector<Eigen::Vector2d> hull;
};

// Fits the sides of the quadrilateral 'polygon' (four corners) to the sub-pixel edges along them
// and returns the new corners. Returns nothing when a corner would move by more than 6 px.
std::optional<FaceCorners> RefineCorners(const cv::Mat& image,
                                         std::span<const Eigen::Vector2d> polygon);

// Finds the upper face of the cuboid in 'segment' (with its ambiguous pixels joined), to about 2
// px; see RefineCorners. Side faces have the same hue but another brightness: the face consists of
// the pixels whose value is in the same peak of the histogram as that of the pixels around the
// digit. The corners are those of the smallest quadrilateral around them. Returns nothing when the
// digit or four sides are not found.
std::optional<FaceCorners> FindCuboidFace(const cv::Mat& image, const Segment& segment,
                                          CuboidFaceWorkspace* workspace);

// Area of a quadrilateral (px^2), positive for either order of its corners.
double QuadrilateralArea(const FaceCorners& corners);

}  // namespace kestrel
