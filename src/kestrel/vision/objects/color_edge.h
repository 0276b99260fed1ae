// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include <Eigen/Core>
#include <opencv2/core.hpp>

namespace kestrel {

struct ColorEdge {
  double offset_px = 0;  // from where it was looked for, -3 to 3
  double blur_px = 0;    // standard deviation of the Gaussian that would blur a sharp edge as much
};

// Whether the image shows all that FindColorEdge looks at.
bool ShowsColorEdge(const cv::Size& image, const Eigen::Vector2d& start,
                    const Eigen::Vector2d& outward);

// The sub-pixel place, along 'outward' (unit vector) from 'start' in a CV_8UC3 image, where the
// colour is half that inside and half that outside, on a scale between that of light and that of
// the image's values (a camera's gamma is about 2). What is inside and outside is read beside the
// edge, not from a model: a disc may lie on anything, half in a shadow. Nothing when the profile
// leaves the image or shows no clear edge.
std::optional<ColorEdge> FindColorEdge(const cv::Mat& image, const Eigen::Vector2d& start,
                                       const Eigen::Vector2d& outward);

}  // namespace kestrel
