// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include "kestrel/core/camera/camera_model.h"
#include "kestrel/core/geometry/rigid_transform.h"
#include "kestrel/vision/landing/landing_pattern.h"

namespace kestrel {

// Which outline of a print an edge belongs to.
enum class PrintLine { kOuterCircle, kInnerCircle, kArmSide, kArmEnd };

// An edge of a print in an image.
struct PrintLineEdge {
  PrintLine line;
  Eigen::Vector2d outwards;  // of arms: unit vector of the plane from black to white
  Eigen::Vector2d pixel;
};

// Where the brightness rises half of its way from the black of ring and arms to the white beside
// them, along lines across all outlines of the print: wherever that is, not only near to where the
// pattern would have it. 'image' is CV_8UC1.
std::vector<PrintLineEdge> FindPrintLineEdges(const cv::Mat& image, const CameraModel& camera,
                                              const RigidTransform& camera_from_pattern,
                                              const LandingPattern& pattern);

}  // namespace kestrel
