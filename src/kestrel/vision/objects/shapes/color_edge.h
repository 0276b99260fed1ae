// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include <Eigen/Core>
#include <opencv2/core.hpp>

namespace kestrel {

struct ColorEdge {
  double offset_px = 0;  // from the place where it was searched, -3 to 3
  double blur_px = 0;    // standard deviation of the Gaussian that blurs a sharp edge as much
};

// True when the image contains all pixels that FindColorEdge reads.
bool ShowsColorEdge(const cv::Size& image, const Eigen::Vector2d& start,
                    const Eigen::Vector2d& outward);

// Finds a colour edge to sub-pixel precision, along 'outward' (unit vector) from 'start' in a
// CV_8UC3 image: the place where the colour is half that of the inside and half that of the
// outside. Colours are mixed on a scale between that of light and that of the image's values (a
// camera's gamma is about 2). Both colours are read beside the edge, not from a model, because a
// disc may lie on anything, half in a shadow. Returns nothing when the profile leaves the image or
// shows no clear edge.
std::optional<ColorEdge> FindColorEdge(const cv::Mat& image, const Eigen::Vector2d& start,
                                       const Eigen::Vector2d& outward);

}  // namespace kestrel
