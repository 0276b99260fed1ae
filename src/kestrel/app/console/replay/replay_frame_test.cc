// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/console/replay/replay_frame.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kestrel/core/camera/paper_camera.h"

namespace kestrel {
namespace {

using ::testing::ElementsAre;
using ::testing::Field;

LandingView PaperView() { return {CameraModel(PaperCamera()), {}, TurnNoise()}; }

std::string Marks(const std::vector<ReplayFrame>& frames) {
  std::string marks;
  for (const ReplayFrame& frame : frames) marks += "-flx"[static_cast<int>(frame.mark)];
  return marks;
}

TEST(MarkLostTest, MarksGapsAsLostAndRejectedDetectionsAsFalse) {
  std::vector<ReplayFrame> frames;
  for (int i = 0; i < 12; ++i) {
    LandingObservation observation;
    if (i == 3 || i == 4 || i == 6 || i == 9) {
      TargetDetection& detection = observation.report.detection.emplace();
      detection.camera_from_target.translation = {0, 0, 3};
    }
    if (i == 6) observation.fate = MeasurementFate::kFarFromTrack;
    frames.push_back(ReplayFrameOf(PaperView(), {{}, observation}));
  }
  MarkLost(&frames);
  EXPECT_EQ(Marks(frames), "---fflxllf--");
  std::vector<ReplayFrame> nothing(3);
  MarkLost(&nothing);
  EXPECT_EQ(Marks(nothing), "---");
}

TEST(FirstFoundTest, ReturnsFirstFrameWithDetection) {
  std::vector<ReplayFrame> frames(4);
  EXPECT_EQ(FirstFound(frames), 0u);
  frames[1].mark = FrameMark::kLost;
  frames[2].mark = frames[3].mark = FrameMark::kFound;
  EXPECT_EQ(FirstFound(frames), 2u);
}

TEST(ReplayFrameTest, ShowsObjectsOfHunt) {
  HuntView view;
  view.model.classes.resize(2);
  view.model.classes[1].name = "blue";
  HuntObservation observation;
  EXPECT_EQ(ReplayFrameOf(view, {{}, observation}).mark, FrameMark::kNothing);
  observation.world_from_camera.emplace().translation = {1, 2, 5};
  ObjectDetection& found = observation.report.detections.emplace_back();
  found.class_index = 1;
  found.class_probability = 0.875;
  found.ellipse = {{100, 50}, 20, 10, 0};
  ObjectLocation place;
  place.position = {3, 4, 0};
  observation.in_world.emplace_back(place);
  const ReplayFrame frame = ReplayFrameOf(view, {{}, observation});
  EXPECT_EQ(frame.mark, FrameMark::kFound);
  ASSERT_EQ(frame.shapes.size(), 1u);
  EXPECT_EQ(frame.shapes[0].label, "blue 0.88");
  EXPECT_EQ(frame.shapes[0].outline[0], cv::Point2f(120, 50));
  EXPECT_EQ(frame.facts[0].value, "1");
  ASSERT_EQ(frame.map.objects.size(), 1u);
  EXPECT_EQ(frame.map.objects[0].position, Eigen::Vector2d(3, 4));
  EXPECT_EQ(frame.sample.values[0], 1);
}

TEST(ReplayFrameTest, ShapesNameTheirRun) {
  ReplayResult first, second;
  first.frames.resize(2);
  second.frames.resize(2);
  first.frames[1].shapes = {{OverlayLayer::kPrediction, {{1, 1}}, ""}};
  second.frames[1].shapes = {{OverlayLayer::kDetection, {{2, 2}}, "found"}};
  EXPECT_EQ(ShapesOf(first, nullptr, 1).size(), 1u);
  EXPECT_THAT(ShapesOf(first, &second, 1),
              ElementsAre(Field(&OverlayShape::run, 1), Field(&OverlayShape::run, 2)));
  EXPECT_TRUE(ShapesOf(first, &second, 0).empty());
}

}  // namespace
}  // namespace kestrel
