// SPDX-License-Identifier: BSD-3-Clause
// Pads that are followed under the shadow of the UAV, cut off by the rim of the image.
#include <memory>
#include <string>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "kestrel/core/base/random.h"
#include "kestrel/core/camera/paper_camera.h"
#include "kestrel/core/geometry/angles.h"
#include "kestrel/vision/helipad/test_helipad_images.h"
#include "kestrel/vision/targets/make_target_detector.h"
#include "kestrel/vision/targets/test_pad_search.h"

namespace kestrel {
namespace {

constexpr int kShadowFrames = 12;

// Shadow on a pad of 1 m: its middle, and the radius of the body that casts it.
struct OwnShadow {
  std::string kind;
  double x, y, radius;
};

class OwnShadowTest : public testing::TestWithParam<OwnShadow> {
 protected:
  OwnShadowTest() {
    target_.kind = GetParam().kind;
    target_.size_m = 1;
  }

  // Returns the number of frames in which the pad is found where it is followed, on the print of
  // 'shown'. A detection off its place fails the test.
  int Found(const TargetOptions& shown) const {
    const auto detector = MakeTargetDetector(camera_, target_, {});
    const auto workspace = detector->MakeWorkspace();
    const TargetPrint print = PrintOfTarget(shown, {});
    Random random(5);
    int found = 0;
    for (int i = 0; i < kShadowFrames; ++i) {
      const RigidTransform pose = RandomPadBelow(random.Uniform(0.4, 0.9), &random);
      PadImageOptions taken = RandomPadImage(&random);
      taken.contrast = 1;
      taken.shadow = {.shape = PadShadow::Shape::kFourArms,
                      .light = 0.3,
                      .center = {GetParam().x, GetParam().y},
                      .turn = random.Uniform(0, kPi),
                      .size_m = GetParam().radius};
      const TargetReport report = detector->Detect(
          renderer_.Render(print, pose, taken, random.Bits()), Followed(pose, &random), *workspace);
      if (!report.detection) continue;
      ++found;
      const RigidTransform& seen = report.detection->camera_from_target;
      EXPECT_LT((seen.translation - pose.translation).norm(), 0.02) << i;
    }
    return found;
  }

  TargetOptions target_;

 private:
  static TargetHint Followed(const RigidTransform& pose, Random* random) {
    TargetHint hint;
    const double x = random->Normal();
    const double y = random->Normal();
    hint.center_sigma_m = 0.02;
    hint.center_in_camera = pose.translation + hint.center_sigma_m * Eigen::Vector3d(x, y, 0);
    hint.up_in_camera = pose.rotation * Eigen::Vector3d::UnitZ();
    hint.rotation_in_camera = RotationBy({0, 0, 0.02}) * pose.rotation;
    return hint;
  }

  CameraModel camera_{AtHalfResolution(PaperCamera())};
  PadRenderer renderer_{camera_};
};

TEST_P(OwnShadowTest, FollowedPadStaysFollowed) { EXPECT_EQ(Found(target_), kShadowFrames); }

class TagShadowTest : public OwnShadowTest {};

TEST_P(TagShadowTest, RejectsAnotherIdInShadow) {
  for (const int id : {1, 2}) {
    TargetOptions shown = target_;
    shown.id = id;
    EXPECT_EQ(Found(shown), 0) << id;
  }
}

const OwnShadow kOnTag{"apriltag", 0.1, 0.1, 0.3};
const OwnShadow kOnMarker{"aruco", 0.1, 0, 0.25};
const OwnShadow kOnHelipad{"helipad", 0.1, 0, 0.15};
const auto kNameOf = [](const auto& tested) { return tested.param.kind; };

INSTANTIATE_TEST_SUITE_P(Kinds, OwnShadowTest, testing::Values(kOnTag, kOnMarker, kOnHelipad),
                         kNameOf);
INSTANTIATE_TEST_SUITE_P(Kinds, TagShadowTest, testing::Values(kOnTag, kOnMarker), kNameOf);

}  // namespace
}  // namespace kestrel
