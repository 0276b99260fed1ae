// SPDX-License-Identifier: BSD-3-Clause
// HelipadDetector does not allocate once it has warmed up, also where it finds nothing.
#include <gtest/gtest.h>

#include "count_allocations.h"
#include "kestrel/core/camera/paper_camera.h"
#include "kestrel/vision/helipad/helipad_detector.h"
#include "kestrel/vision/helipad/test_helipad_images.h"

namespace kestrel {
namespace {

TEST(HelipadAllocationTest, AllocatesNothingAfterFirstFrame) {
  const CameraModel camera(PaperCamera());
  const HelipadDetectorOptions options;
  const HelipadDetector detector(camera, options);
  const PadRenderer renderer(camera);
  const auto workspace = detector.MakeWorkspace();
  const Eigen::Quaterniond down(Eigen::AngleAxisd(kPi, Eigen::Vector3d::UnitX()));
  for (int i = 0; i < 9; ++i) {
    const RigidTransform pose{down, {0.1, 0.2, 1.0 + i}};
    cv::Mat image = renderer.Render(PrintOf(options), pose, {}, i);
    const bool shows_pad = i % 3 != 2;
    if (!shows_pad) image.setTo(120, image < 200);  // the ground alone
    TargetHint hint;
    if (i % 3 == 1) {
      hint.center_in_camera = pose.translation;
      hint.rotation_in_camera = pose.rotation;
    }
    TargetReport report;
    const int count = CountAllocations([&] { report = detector.Detect(image, hint, *workspace); });
    EXPECT_EQ(report.detection.has_value(), shows_pad) << i;
    if (i == 0) {
      EXPECT_GT(count, 0) << "the count does not see the workspace grow";
    } else {
      EXPECT_EQ(count, 0) << "frame " << i;
    }
  }
}

}  // namespace
}  // namespace kestrel
