// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include "kestrel/vision/mapping/mapped_object.h"

namespace kestrel {

// Draws the map into a corner of a CV_8UC3 image, the lower right one unless another covers less of
// what is seen: from above, north up, with all objects in view and a scale. Objects are dots of
// their colour with their score, larger where their position is less certain; moving ones have a
// line to their position in one second. 'uav': position of the UAV (m), drawn as a cross. 'seen':
// boxes around what is seen in the image (px). Draws nothing when there is nothing to show.
void DrawMapInset(const std::vector<MappedObject>& objects, const ObjectModel& model,
                  const std::optional<Eigen::Vector2d>& uav, const std::vector<cv::Rect>& seen,
                  cv::Mat* image);

}  // namespace kestrel
