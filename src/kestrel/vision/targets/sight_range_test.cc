// SPDX-License-Identifier: BSD-3-Clause
// TargetShape::SightRange beside what a search finds in rendered images.
#include <memory>
#include <string>

#include <gtest/gtest.h>

#include "kestrel/core/camera/paper_camera.h"
#include "kestrel/vision/helipad/test_helipad_images.h"
#include "kestrel/vision/targets/make_target_detector.h"
#include "kestrel/vision/targets/test_pad_search.h"

namespace kestrel {
namespace {

constexpr int kFrames = 30;

class SightRangeTest : public testing::TestWithParam<std::string> {
 protected:
  SightRangeTest() {
    target_.kind = GetParam();
    detector_ = MakeTargetDetector(camera_, target_, {});
    print_ = PrintOfTarget(target_, {});
  }

  double Range() const { return detector_->shape().SightRange(camera_.intrinsics()); }

  // Returns in how many of kFrames frames from 'altitude' the pad is found without a track.
  int FoundFrom(double altitude) const {
    int found = 0;
    for (int i = 0; i < kFrames; ++i) {
      found += IsFoundFrom(altitude, *detector_, print_, renderer_, 100 + i);
    }
    return found;
  }

  CameraModel camera_{AtHalfResolution(PaperCamera())};
  PadRenderer renderer_{camera_};
  TargetOptions target_;
  std::unique_ptr<const TargetDetector> detector_;
  TargetPrint print_;
};

TEST_P(SightRangeTest, PadIsFoundAtRangeButRarelyAtTwiceTheRange) {
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
