// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/calibration/lens/lens_guide.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kestrel/calibration/lens/test_lens_views.h"

namespace kestrel {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

constexpr Duration kFrame = std::chrono::milliseconds(100);

CameraIntrinsics Lens() { return {640, 480, 400, 400, 320, 240, DistortionModel::kNone, {}}; }

class LensGuideTest : public ::testing::Test {
 protected:
  // Shows a view to the guide for some frames.
  bool Show(const LensView& view, int frames = 3) {
    bool was_taken = false;
    for (int i = 0; i < frames; ++i) was_taken |= guide_.Look(view, time_ += kFrame, Lens());
    return was_taken;
  }

  LensGuide guide_{cv::Size(640, 480)};
  Time time_{};
};

LensView Moved(LensView view, double px) {
  for (LensEdge& edge : view.edges) edge.pixel.x() += px;
  return view;
}

TEST_F(LensGuideTest, DoesNotTakeMovingBoard) {
  const LensView view = MakeLensViews(Lens(), {.count = 1, .share_of_image = 0.2}).front();
  for (int i = 0; i < 10; ++i) EXPECT_FALSE(Show(Moved(view, 8 * i), 1)) << i;
  EXPECT_THAT(guide_.Advice(), StartsWith("hold it still"));
  EXPECT_TRUE(Show(Moved(view, 80)));
}

TEST_F(LensGuideTest, TakesSameViewOnce) {
  const LensView view = MakeLensViews(Lens(), {.count = 1, .share_of_image = 0.2}).front();
  EXPECT_TRUE(Show(view));
  EXPECT_FALSE(Show(Moved(view, 3)));
  EXPECT_EQ(guide_.views().size(), 1u);
  EXPECT_THAT(guide_.Advice(), HasSubstr("corner"));
}

TEST_F(LensGuideTest, ReportsMissingBoard) {
  EXPECT_FALSE(guide_.Look(std::nullopt, time_, Lens()));
  EXPECT_THAT(guide_.Advice(), HasSubstr("the board is not found"));
}

TEST_F(LensGuideTest, AcceptsManyDifferentViewsAsEnough) {
  for (const LensView& view : MakeLensViews(Lens(), {.count = 300, .seed = 4})) Show(view);
  EXPECT_GT(guide_.variety().left, 1);
  EXPECT_GT(guide_.variety().bottom, 1);
  EXPECT_THAT(guide_.variety().coverage.EmptyParts(), ::testing::IsEmpty());
}

// A print whose face looks to the right has its left side nearer.
TEST_F(LensGuideTest, CountsViewsTiltedToEachSide) {
  const auto tilted = [](double about_x, double about_y) {
    LensView view = MakeLensViews(Lens(), {.count = 1, .share_of_image = 0.1}).front();
    view.camera_from_target = {
        RotationBy({about_x, about_y, 0}) *
            Eigen::Quaterniond(Eigen::AngleAxisd(std::numbers::pi, Eigen::Vector3d::UnitX())),
        {0, 0, 1}};
    return view;
  };
  // Turned by the right-hand rule about y, which points down, its right side goes away.
  const LensView view = tilted(0, -0.5);
  const Eigen::Vector3d left = view.camera_from_target * Eigen::Vector3d(-0.3, 0, 0);
  const Eigen::Vector3d right = view.camera_from_target * Eigen::Vector3d(0.3, 0, 0);
  ASSERT_LT(left.z(), right.z());
  Show(view);
  EXPECT_EQ(guide_.variety().left, 1);
  EXPECT_EQ(guide_.variety().right, 0);
  Show(Moved(tilted(0.5, 0), 200));
  const Eigen::Vector3d top = tilted(0.5, 0).camera_from_target * Eigen::Vector3d(0, 0.3, 0);
  EXPECT_EQ(top.z() < 1 ? guide_.variety().top : guide_.variety().bottom, 1);
}

}  // namespace
}  // namespace kestrel
