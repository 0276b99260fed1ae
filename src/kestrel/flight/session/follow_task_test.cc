// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/session/follow_task.h"

#include <chrono>
#include <cmath>
#include <memory>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kestrel/core/base/test_folder.h"
#include "kestrel/vision/region/test_region_scene.h"

namespace kestrel {
namespace {

using ::testing::HasSubstr;

CameraIntrinsics Intrinsics() {
  return {
      kRegionImageWidth, kRegionImageHeight, 500, 500, 319.5, 239.5, DistortionModel::kNone, {}};
}

std::unique_ptr<Vision> VisionWith(const FollowMark& mark) {
  SessionCamera camera;
  camera.calibration.intrinsics = Intrinsics();
  return FollowTask({}, mark).MakeVision(camera);
}

std::unique_ptr<Vision> LiveVision() {
  SessionCamera camera;
  camera.calibration.intrinsics = Intrinsics();
  camera.is_live = true;
  return FollowTask({}).MakeVision(camera);
}

// The target in one of the pictures.
struct ShownTarget {
  Time time;
  cv::Rect2d box_px;
};

// Shows pictures in which target and camera move by so many pixels each. Returns the target in
// picture number 'marked'.
ShownTarget Show(int pictures, int marked, const Eigen::Vector2d& target_px,
                 const Eigen::Vector2d& camera_px, RegionScene* scene, Vision* vision) {
  ShownTarget shown;
  for (int i = 0; i < pictures; ++i) {
    scene->target.center_px += target_px;
    scene->camera_px += camera_px;
    const cv::Mat image = scene->Take();
    if (i == marked) shown = {scene->time, scene->Box()};
    const Observation seen = vision->Process({"", scene->time, image});
    EXPECT_FALSE(std::get<FollowObservation>(seen.seen).region);
  }
  return shown;
}

TEST(FollowTaskTest, FollowsFromTheMarkedFrameOn) {
  RegionScene scene(1);
  std::unique_ptr<Vision> vision = VisionWith({scene.Box(), "2"});
  for (int i = 0; i < 6; ++i) {
    const cv::Mat image = scene.Take();
    const Observation seen = vision->Process({"image", scene.time, image});
    EXPECT_EQ(std::get<FollowObservation>(seen.seen).region.has_value(), i >= 2) << i;
  }
  vision->Finish();
  EXPECT_EQ(vision->Found(), "followed in 4, coasted in 0, lost in 0");
}

TEST(FollowTaskTest, FrameIsMarkedByItsName) {
  RegionScene scene(1);
  const auto vision = VisionWith({scene.Box(), "b.png"});
  for (const char* name : {"data/a.png", "data/bb.png", "data/b.png"}) {
    const cv::Mat image = scene.Take();
    const Observation seen = vision->Process({name, scene.time, image});
    EXPECT_EQ(std::get<FollowObservation>(seen.seen).region.has_value(),
              name == std::string("data/b.png"));
  }
}

TEST(FollowTaskTest, BoxOutsideOfTheImageNamesTheFrame) {
  RegionScene scene(1);
  const auto vision = VisionWith({{900, 10, 20, 20}});
  EXPECT_THAT(InputErrorOf([&] {
                const cv::Mat image = scene.Take();
                vision->Process({"image_7", scene.time, image});
              }),
              HasSubstr("image_7: box 900,10,20,20: expected one within the image of 640 x 480"));
}

TEST(FollowTaskTest, RecordingThatEndsBeforeTheMarkIsAnError) {
  RegionScene scene(1);
  const auto vision = VisionWith({scene.Box(), "5"});
  vision->Process({"image", scene.time, scene.Take()});
  EXPECT_THAT(InputErrorOf([&] { vision->Finish(); }),
              HasSubstr("--at 5: the source has 1 frames and none of that name"));
}

TEST(FollowTaskTest, RecordingNeedsAMark) {
  EXPECT_THAT(InputErrorOf([] { FollowTask({}).MakeVision({}); }), HasSubstr("expected a box"));
}

// What a person marks in a picture that is 0.3 s old is followed in the newest one, though it has
// left that place and the camera turns.
TEST(FollowTaskTest, MarkOnALatePictureIsAppliedToThatPicture) {
  RegionScene scene(3);
  const auto vision = LiveVision();
  const auto [marked, box] = Show(20, 13, {5, 0}, {-9, 4}, &scene, vision.get());
  ASSERT_GT(std::abs(box.x - scene.Box().x), box.width) << "somewhere else by now";
  EXPECT_EQ(vision->snapshot().mark, 0);
  vision->Mark(marked, box);
  EXPECT_EQ(vision->snapshot().mark, 1);
  const cv::Mat image = scene.Take();
  const Observation seen = vision->Process({"", scene.time, image});
  const auto& region = std::get<FollowObservation>(seen.seen).region;
  ASSERT_TRUE(region);
  EXPECT_EQ(region->state, RegionState::kFollowing);
  EXPECT_GT((region->box_px & scene.Box()).area(), 0.6 * scene.Box().area());
  EXPECT_THAT(InputErrorOf([&, box = box] { vision->Mark(Time(), box); }),
              HasSubstr("mark a newer one"));
  EXPECT_THAT(InputErrorOf([&, marked = marked] {
                vision->Mark(marked, {-90, 0, 9, 9});
              }),
              HasSubstr("expected one within the image"));
  EXPECT_EQ(vision->snapshot().mark, 1) << "only those that are followed";
}

// A ground station knows the time of its click, not that of a picture.
TEST(FollowTaskTest, MarkBetweenTwoPicturesCountsInTheOneBefore) {
  RegionScene scene(3);
  const auto vision = LiveVision();
  const auto [marked, box] = Show(10, 4, {9, 0}, {0, 0}, &scene, vision.get());
  vision->Mark(marked + std::chrono::milliseconds(5), box);
  const auto follow = [&] {
    const cv::Mat image = scene.Take();
    const Observation seen = vision->Process({"", scene.time, image});
    EXPECT_TRUE(vision->snapshot().followed);
    return std::get<FollowObservation>(seen.seen).region;
  };
  const auto region = follow();
  ASSERT_TRUE(region);
  EXPECT_EQ(region->state, RegionState::kFollowing);
  EXPECT_GT((region->box_px & scene.Box()).area(), 0.6 * scene.Box().area());
  vision->Unmark();
  EXPECT_FALSE(follow()) << "nothing is marked any more";
  EXPECT_EQ(vision->snapshot().mark, 2) << "a confirmation was for the mark before";
}

}  // namespace
}  // namespace kestrel
