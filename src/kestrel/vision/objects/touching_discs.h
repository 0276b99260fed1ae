// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include <Eigen/Core>

namespace kestrel {

// As many points inside of a figure are enough for RadiusOfTouchingDiscs.
inline constexpr std::size_t kTouchingDiscsPoints = 150;

// The radius of the discs when a figure on a plane is two to eight discs of one size that touch
// each other: every one lies beside another, and the border is made of arcs of their circles.
// Nothing when it is any other figure, like a single disc, a cross or a bar.
//
// 'inside': points all over the figure; 'border': points all along its border; 'pixel': length on
// the plane that the image resolves. The centre of a disc is where the figure is as deep as
// anywhere, and between two centres it is narrow.
std::optional<double> RadiusOfTouchingDiscs(std::span<const Eigen::Vector2d> inside,
                                            std::span<const Eigen::Vector2d> border, double pixel);

}  // namespace kestrel
