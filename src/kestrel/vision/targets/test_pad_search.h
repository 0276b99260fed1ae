// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include "kestrel/core/base/random.h"
#include "kestrel/core/camera/camera_model.h"
#include "kestrel/core/geometry/rigid_transform.h"
#include "kestrel/vision/helipad/test_helipad_images.h"
#include "kestrel/vision/target/target_detector.h"
#include "kestrel/vision/target/target_print.h"

namespace kestrel {

// Returns the same lens before a sensor with half the pixels per side.
inline CameraIntrinsics AtHalfResolution(CameraIntrinsics camera) {
  for (int* side : {&camera.width_px, &camera.height_px}) *side /= 2;
  for (double* px : {&camera.fx_px, &camera.fy_px, &camera.cx_px, &camera.cy_px}) *px /= 2;
  return camera;
}

// Returns whether a search without a track finds the pad in a rendered image from 'altitude', at
// its place to a quarter of the altitude.
inline bool IsFoundFrom(double altitude, const TargetDetector& detector, const TargetPrint& print,
                        const PadRenderer& renderer, std::uint64_t seed) {
  Random random(seed);
  const PadImageOptions taken = RandomPadImage(&random);
  const RigidTransform pose = RandomPadBelow(altitude, &random);
  TargetHint hint;
  hint.up_in_camera = pose.rotation * Eigen::Vector3d::UnitZ();
  const cv::Mat image = renderer.Render(print, pose, taken, random.Bits());
  const auto workspace = detector.MakeWorkspace();
  const TargetReport report = detector.Detect(image, hint, *workspace);
  if (!report.detection) return false;
  const Eigen::Vector3d& found = report.detection->camera_from_target.translation;
  return (found - pose.translation).norm() < 0.25 * altitude;
}

}  // namespace kestrel
