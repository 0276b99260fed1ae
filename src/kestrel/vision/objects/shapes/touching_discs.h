// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include <Eigen/Core>

namespace kestrel {

// Number of points inside of a figure that suffices for RadiusOfTouchingDiscs.
inline constexpr std::size_t kTouchingDiscsPoints = 150;

// Returns the radius of the discs when a figure on a plane consists of two to eight touching discs
// of one size: each disc lies beside another, and the border consists of arcs of their circles.
// Nothing for any other figure, such as a single disc, a cross or a bar.
//
// 'inside': points distributed over the figure; 'border': points along its border; 'pixel':
// resolution of the image on the plane. The centres of the discs are the deepest points of the
// figure, and between two centres the figure is narrow.
std::optional<double> RadiusOfTouchingDiscs(std::span<const Eigen::Vector2d> inside,
                                            std::span<const Eigen::Vector2d> border, double pixel);

}  // namespace kestrel
