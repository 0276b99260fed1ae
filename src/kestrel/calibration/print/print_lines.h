// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include "kestrel/core/camera/camera_model.h"
#include "kestrel/core/geometry/rigid_transform.h"
#include "kestrel/vision/landing/landing_pattern.h"

namespace kestrel {

// The outline of a print that an edge belongs to.
enum class PrintLine { kOuterCircle, kInnerCircle, kArmSide, kArmEnd };

// An edge of a print in an image.
struct PrintLineEdge {
  PrintLine line;
  Eigen::Vector2d outwards;  // for arms: unit vector in the plane from black to white
  Eigen::Vector2d pixel;
};

// Finds the points where the brightness has risen half of the way from the black of ring and arms
// to the white beside them, along lines across all outlines of the print. It takes the edge
// wherever it is on the line, not only near its expected place. 'image' is CV_8UC1.
std::vector<PrintLineEdge> FindPrintLineEdges(const cv::Mat& image, const CameraModel& camera,
                                              const RigidTransform& camera_from_target,
                                              const LandingPattern& pattern);

}  // namespace kestrel
