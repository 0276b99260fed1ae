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

#include "kestrel/vision/objects/segmentation.h"

namespace kestrel {

// Corners of the upper face of a cuboid in the image, px, in the order of a walk around it.
using FaceCorners = std::array<Eigen::Vector2d, 4>;

// Memory of FindCuboidFace.
struct CuboidFaceWorkspace {
  std::vector<std::uint8_t> mask;
  std::vector<std::uint8_t> values;
  std::vector<std::uint8_t> smooth;
  std::vector<std::uint8_t> filtered;
  std::vector<std::size_t> digit;  // pixels of it
  std::vector<std::size_t> queue;
  std::vector<Eigen::Vector2d> hull;
};

// The corners after the sides of the quadrilateral 'polygon' (four corners) are fitted to the
// sub-pixel edges along them. Nothing when that moves one by more than 6 px.
std::optional<FaceCorners> RefineCorners(const cv::Mat& image,
                                         std::span<const Eigen::Vector2d> polygon);

// The upper face of the cuboid that 'segment' (with its ambiguous pixels joined) shows. Side faces
// have the same hue and another brightness: kept are the pixels whose value is in the same hill of
// the histogram as those around the digit. The smallest quadrilateral around them is the face, to
// about 2 px: see RefineCorners. Nothing when the digit or four sides are not found.
std::optional<FaceCorners> FindCuboidFace(const cv::Mat& image, const Segment& segment,
                                          CuboidFaceWorkspace* workspace);

// Area of a quadrilateral (px^2), positive whichever way its corners go.
double QuadrilateralArea(const FaceCorners& corners);

}  // namespace kestrel
