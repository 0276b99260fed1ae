// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/foxglove/observation_file.h"

#include <filesystem>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kestrel/app/foxglove/test_observations.h"
#include "kestrel/app/foxglove/test_protobuf.h"
#include "kestrel/core/base/error.h"
#include "kestrel/core/base/read_file.h"
#include "kestrel/core/codec/image_codec.h"
#include "kestrel/io/recording/test_files.h"

namespace kestrel {
namespace {

using ::testing::ElementsAre;

TEST(ObservationFileTest, WritesLanding) {
  const TestFolder folder;
  const std::string path = folder / "flight.mcap";
  {
    ObservationFile file(path, false, ObservedCamera(), ObservedView());
    for (int i = 0; i < 25; ++i) {
      const Frame frame = ObservedFrame(i);
      file.Write(frame, ObservedLanding(frame.time), DurationFromSeconds(0.015));
    }
    file.Close();
  }
  const auto messages = ReadMessages(path);
  for (const char* topic : {"/camera/image", "/camera/calibration", "/camera/annotations",
                            "/camera/pose", "/landing/target", "/scene", "/result"}) {
    ASSERT_EQ(messages.count(topic), 1u) << topic;
    ASSERT_EQ(messages.at(topic).size(), 25u) << topic;
    EXPECT_EQ(messages.at(topic)[24].time, ObservedFrame(24).time) << topic;
  }
  EXPECT_EQ(messages.at("/tf").size(), 50u);
  EXPECT_EQ(messages.at("/log").size(), 1u);  // the start of the track

  const ProtobufFields image = messages.at("/camera/image")[3].fields;
  EXPECT_EQ(image.time(1), ObservedFrame(3).time);
  EXPECT_EQ(image.bytes(3), "jpeg");
  const std::string jpeg = image.bytes(2);
  const cv::Mat decoded = DecodeImage(jpeg, "image");
  EXPECT_EQ(decoded.size(), cv::Size(64, 48));
  EXPECT_NEAR(decoded.at<std::uint8_t>(20, 20), 100, 1);

  const ProtobufFields calibration = messages.at("/camera/calibration")[0].fields;
  EXPECT_EQ(calibration.number<std::uint32_t>(2), 64u);
  EXPECT_EQ(calibration.bytes(4), "plumb_bob");
  EXPECT_THAT(calibration.doubles(5), ElementsAre(0, 0, 0, 0, 0));
  EXPECT_THAT(calibration.doubles(6), ElementsAre(40, 0, 31.5, 0, 40, 23.5, 0, 0, 1));

  const ProtobufFields result = messages.at("/result")[0].fields;
  EXPECT_EQ(result.bytes(2), "frame");
  EXPECT_DOUBLE_EQ(result.number<double>(3), 2);
  EXPECT_DOUBLE_EQ(result.number<double>(4), 15);
  EXPECT_EQ(result.bytes(5), "tracking");
  const ProtobufFields detection = result.message(7);
  EXPECT_EQ(detection.bytes(1), "ring");
  EXPECT_DOUBLE_EQ(detection.message(3).number<double>(1), 32);  // 0 is a corner, not a centre
  EXPECT_THAT(detection.doubles(5), ElementsAre(0.01, 0, 0, 0, 0.01, 0, 0, 0, 0.01));
  const ProtobufFields target = result.message(8);
  EXPECT_DOUBLE_EQ(target.message(1).number<double>(1), 1);
  EXPECT_EQ(target.doubles(5).size(), 36u);
}

TEST(ObservationFileTest, HasTopicsOfEachCamera) {
  const TestFolder folder;
  const std::string path = folder / "flight.mcap";
  {
    ObservationFile file(path, false, ObservedCamera(), ObservedView());
    file.writer().AddCamera("cam1", ObservedCamera(), ObservedView());
    for (int i = 0; i < 6; ++i) {
      Frame frame = ObservedFrame(i);
      frame.camera = i % 3 == 0 ? 0 : 1;
      file.Write(frame, ObservedLanding(frame.time));
    }
    file.Close();
  }
  const auto messages = ReadMessages(path);
  for (const char* topic : {"image", "calibration", "annotations", "pose"}) {
    EXPECT_EQ(messages.at(std::string("/camera/") + topic).size(), 2u) << topic;
    EXPECT_EQ(messages.at(std::string("/cam1/") + topic).size(), 4u) << topic;
  }
  EXPECT_EQ(messages.at("/cam1/calibration")[0].fields.bytes(9), "cam1_optical_frame");
  EXPECT_EQ(messages.at("/landing/target").size(), 6u);
  EXPECT_EQ(messages.at("/log").size(), 1u);  // one track
}

TEST(ObservationFileTest, KeepsWrittenMessagesWhenRunFails) {
  const TestFolder folder;
  const Frame frame = ObservedFrame(0);
  {
    ObservationFile file(folder / "a.mcap", false, ObservedCamera(), ObservedView());
    file.Write(frame, ObservedLanding(frame.time));
  }
  EXPECT_EQ(ReadMessages(folder / "a.mcap").at("/result").size(), 1u);
  { const ObservationFile file(folder / "b.mcap", false, ObservedCamera(), ObservedView()); }
  EXPECT_FALSE(std::filesystem::exists(folder / "b.mcap"));
}

TEST(ObservationFileTest, KeepsExistingFile) {
  const TestFolder folder;
  const std::string path = folder.Write("a.mcap", "mine");
  EXPECT_THROW(ObservationFile(path, false, ObservedCamera(), ObservedView()), InputError);
  EXPECT_EQ(ReadFile(path), "mine");
}

TEST(ObservationFileTest, WritesHunt) {
  const TestFolder folder;
  const std::string path = folder / "hunt.mcap";
  const HuntView view{DefaultObjectModel()};
  Frame frame = ObservedFrame(0);
  frame.image = cv::Mat(48, 64, CV_8UC3, cv::Scalar(10, 20, 200));
  HuntObservation observation;
  observation.time = frame.time;
  ObjectDetection& found = observation.report.detections.emplace_back();
  found.center_px = {10, 12};
  found.ellipse = {{10, 12}, 4, 3, 0};
  found.location = ObjectLocation{{0, 0, 4}, 0.01 * Eigen::Matrix3d::Identity()};
  found.class_probability = 0.8;
  observation.in_world.push_back(ObjectLocation{{7, 8, 0}, 0.04 * Eigen::Matrix3d::Identity()});
  {
    ObservationFile file(path, false, ObservedCamera(), view);
    file.Write(frame, observation);
    file.Close();
  }
  const auto messages = ReadMessages(path);
  const ProtobufFields result = messages.at("/result")[0].fields;
  const ProtobufFields detection = result.message(7);
  EXPECT_EQ(detection.bytes(1), view.model.classes[0].name);
  EXPECT_DOUBLE_EQ(detection.message(6).number<double>(2), 8);
  EXPECT_THAT(detection.doubles(7), ElementsAre(0.04, 0, 0, 0, 0.04, 0, 0, 0, 0.04));
  // Two standard deviations to either side.
  const ProtobufFields sphere = messages.at("/scene")[0].fields.message(2).message(9);
  EXPECT_NEAR(sphere.message(2).number<double>(1), 0.8, 1e-9);
  EXPECT_EQ(messages.at("/camera/annotations")[0].fields.count(2), 1u);
}

}  // namespace
}  // namespace kestrel
