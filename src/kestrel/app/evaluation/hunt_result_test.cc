// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/evaluation/hunt_result.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kestrel/core/base/error.h"
#include "kestrel/core/base/test_folder.h"
#include "kestrel/io/recording/tables/object_csv.h"

namespace kestrel {
namespace {

using ::testing::HasSubstr;

constexpr Time kFirst = TimeFromNanoseconds(1'000'000'000);
constexpr Time kSecond = TimeFromNanoseconds(1'100'000'000);

// A table with two objects in the first of two frames and none in the second.
std::string Table() {
  ObjectModel model;
  model.classes.resize(2);
  model.classes[0].name = "red";
  model.classes[1].name = "blue";
  HuntObservation observation;
  observation.time = kFirst;
  observation.detect_time = std::chrono::milliseconds(3);
  for (const std::size_t i : {1U, 0U}) {
    ObjectDetection& found = observation.report.detections.emplace_back();
    found.class_index = i;
    found.class_probability = 0.75;
    found.center_px = {100, 50.5};
    found.ellipse = {{101, 51}, 20, 10, 0.5};
    found.location.emplace().position = {0, 0, 5};
    observation.in_world.emplace_back();
  }
  observation.in_world[0].emplace().position = {3, 4, 0};
  std::string table = ObjectCsvHeader() + ObjectCsvRows("a.png", observation, model);
  observation.time = kSecond;
  observation.report.detections.clear();
  observation.in_world.clear();
  return table + ObjectCsvRows("b.png", observation, model);
}

TEST(HuntResultTest, FramesMatchTable) {
  const TestFolder folder;
  HuntResult result(folder.Write("object_detections.csv", Table()));
  EXPECT_EQ(result.text(), Table());
  RigidTransform camera;
  camera.translation = {1, 2, 5};
  const HuntObservation first = result.Next(kFirst, camera);
  EXPECT_EQ(first.detect_time, std::chrono::milliseconds(3));
  ASSERT_TRUE(first.world_from_camera);
  ASSERT_EQ(first.report.detections.size(), 2u);
  const ObjectDetection& found = first.report.detections[0];
  EXPECT_EQ(result.model().classes[found.class_index].name, "blue");
  EXPECT_EQ(found.class_probability, 0.75);
  EXPECT_EQ(found.ellipse.center, Eigen::Vector2d(100, 50.5));
  EXPECT_EQ(found.ellipse.semi_minor, 10);
  ASSERT_TRUE(first.in_world[0]);
  EXPECT_EQ(first.in_world[0]->position, Eigen::Vector3d(3, 4, 0));
  EXPECT_FALSE(first.in_world[1]);
  EXPECT_THAT(InputErrorOf([&] { result.RequireEnd(); }), HasSubstr("has rows of 2 frames"));
  EXPECT_TRUE(result.Next(kSecond, std::nullopt).report.detections.empty());
  result.RequireEnd();
}

TEST(HuntResultTest, RefusesResultOfAnotherRecording) {
  const TestFolder folder;
  HuntResult result(folder.Write("object_detections.csv", Table()));
  EXPECT_THAT(InputErrorOf([&] { result.Next(kSecond, std::nullopt); }),
              HasSubstr("no row of the recording's frame at 1100000000 ns"));
  EXPECT_THROW(HuntResult(folder.Write("other.csv", "frame,timestamp_ns\n")), InputError);
}

}  // namespace
}  // namespace kestrel
