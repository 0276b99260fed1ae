// SPDX-License-Identifier: BSD-3-Clause
// TargetShape::SightRange beside what a search finds in rendered images.
#include <memory>
#include <string>

#include <gtest/gtest.h>

#include "kestrel/core/base/random.h"
#include "kestrel/core/camera/paper_camera.h"
#include "kestrel/vision/helipad/test_helipad_images.h"
#include "kestrel/vision/targets/make_target_detector.h"

namespace kestrel {
namespace {

constexpr int kFrames = 30;

// The paper's lens before a sensor with half the pixels per side.
CameraIntrinsics SmallCamera() {
  CameraIntrinsics camera = PaperCamera();
  for (int* side : {&camera.width_px, &camera.height_px}) *side /= 2;
  for (double* px : {&camera.fx_px, &camera.fy_px, &camera.cx_px, &camera.cy_px}) *px /= 2;
  return camera;
}

class SightRangeTest : public testing::TestWithParam<std::string> {
 protected:
  SightRangeTest() {
    target_.kind = GetParam();
    detector_ = MakeTargetDetector(camera_, target_, {});
    print_ = PrintOfTarget(target_, {});
  }

  double Range() const { return detector_->shape().SightRange(camera_.intrinsics().fx_px); }

  // Returns in how many of kFrames frames from 'altitude' the pad is found without a track.
  int FoundFrom(double altitude) const {
    const auto workspace = detector_->MakeWorkspace();
    int found = 0;
    for (int i = 0; i < kFrames; ++i) {
      Random random(100 + i);
      PadImageOptions taken;
      taken.noise = random.Uniform(1, 5);
      taken.contrast = random.Uniform(0.5, 1);
      const RigidTransform pose = RandomPadBelow(altitude, &random);
      LandingHint hint;
      hint.up_in_camera = pose.rotation * Eigen::Vector3d::UnitZ();
      const cv::Mat image = renderer_.Render(print_, pose, taken, random.Bits());
      const LandingReport report = detector_->Detect(image, hint, *workspace);
      if (!report.detection) continue;
      const Eigen::Vector3d error =
          report.detection->camera_from_pattern.translation - pose.translation;
      found += error.norm() < 0.25 * altitude;
    }
    return found;
  }

  CameraModel camera_{SmallCamera()};
  PadRenderer renderer_{camera_};
  TargetOptions target_;
  std::unique_ptr<const TargetDetector> detector_;
  TargetPrint print_;
};

TEST_P(SightRangeTest, NearlyAllImagesShowThePadFromThereAndFewFromTwiceAsFar) {
  EXPECT_GE(FoundFrom(Range()), 0.9 * kFrames) << Range();
  EXPECT_LE(FoundFrom(2 * Range()), 0.5 * kFrames) << Range();
}

INSTANTIATE_TEST_SUITE_P(Kinds, SightRangeTest,
                         testing::Values("ring-cross", "apriltag", "aruco", "helipad"),
                         [](const auto& tested) {
                           std::string name = tested.param;
                           std::erase(name, '-');
                           return name;
                         });

}  // namespace
}  // namespace kestrel
