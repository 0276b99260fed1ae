// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/ros/topic_source.h"

#include <chrono>
#include <string>
#include <variant>

#include <gtest/gtest.h>

#include "kestrel/io/bags/camera_info.h"
#include "kestrel/io/bags/serialization.h"

namespace kestrel {
namespace {

using std::chrono::milliseconds;

constexpr Time kStamp = TimeFromNanoseconds(5'000'000'000);

class TopicSourceTest : public ::testing::Test {
 protected:
  template <class Message>
  void Take(const Message& message, const std::string& topic) {
    source_.Take({topic, std::string(Message::kType), WireFormat::kRos1, {}},
                 SerializeMessage(message, WireFormat::kRos1));
  }
  void TakeImage(std::uint32_t sequence, Time stamp, std::uint32_t width = 8) {
    ImageMessage message;
    message.header = {sequence, stamp, "camera"};
    message.width = width;
    message.height = 4;
    message.step = width;
    message.encoding = "mono8";
    const std::string pixels(width * 4, '\x40');
    message.data = pixels;
    Take(message, "/image");
  }
  void TakePose(Time stamp) {
    Take(PoseStampedMessage{{0, stamp, "map"}, {{1, 2, 3}, {}}}, "/pose");
  }
  // The time of the next frame; fails when the next event is none.
  Time NextFrame() {
    const auto event = source_.Next(Duration::zero());
    if (!event || !std::holds_alternative<Frame>(*event)) {
      ADD_FAILURE() << "no frame";
      return {};
    }
    return std::get<Frame>(*event).time;
  }

  const CameraIntrinsics camera_{8, 4, 10, 10, 3.5, 1.5, DistortionModel::kNone, {}};
  TopicSource source_{TopicSourceOptions{.body_frame = "base_link", .keeps_stamps = true}};
};

TEST_F(TopicSourceTest, BeforeItBeginsOnlyTheNewestImageIsKept) {
  TakeImage(1, kStamp);
  TakeImage(2, kStamp + milliseconds(50));
  source_.Begin(camera_);
  TakeImage(3, kStamp + milliseconds(100));
  EXPECT_EQ(NextFrame(), kStamp + milliseconds(50));
  EXPECT_EQ(NextFrame(), kStamp + milliseconds(100));
  EXPECT_FALSE(source_.Next(Duration::zero()));
  EXPECT_EQ(source_.counters().captured, 2);
  EXPECT_EQ(source_.counters().refused, 1);
}

TEST_F(TopicSourceTest, ImagesOfAnotherSizeAreRefused) {
  TakeImage(1, kStamp, /*width=*/16);
  source_.Begin(camera_);
  EXPECT_FALSE(source_.Next(Duration::zero()));
  EXPECT_THROW(TakeImage(2, kStamp + milliseconds(50), /*width=*/16), InputError);
  EXPECT_NO_THROW(TakeImage(3, kStamp + milliseconds(100)));
}

TEST_F(TopicSourceTest, WhatNeverCameAndWhatCouldNotBeUsedAreCountedApart) {
  source_.Begin(camera_);
  TakeImage(1, kStamp);
  TakeImage(5, kStamp + milliseconds(50));
  EXPECT_THROW(TakeImage(6, kStamp + milliseconds(50)), InputError);
  source_.Pause(true);
  TakeImage(7, kStamp + milliseconds(100));
  source_.Pause(false);
  TakeImage(20, kStamp + milliseconds(150));
  EXPECT_EQ(source_.counters().captured, 3);
  EXPECT_EQ(source_.counters().refused, 1);
  EXPECT_EQ(source_.counters().missed, 3 + 1);
}

TEST_F(TopicSourceTest, AfterTheClockWentBackARestartGoesOn) {
  source_.Begin(camera_);
  TakePose(kStamp + milliseconds(2000));
  EXPECT_THROW(TakePose(kStamp), ClockWentBack);
  TakeImage(1, kStamp + milliseconds(2000));
  EXPECT_THROW(TakeImage(2, kStamp), ClockWentBack);
  source_.Restart("base_link", "");
  EXPECT_FALSE(source_.has_poses());
  EXPECT_FALSE(source_.Next(Duration::zero())) << "what waited is of the time before";
  TakePose(kStamp);
  const auto event = source_.Next(Duration::zero());
  ASSERT_TRUE(event);
  EXPECT_EQ(std::get<PoseSample>(*event).time, kStamp);
}

TEST(TopicSource, StampsThatAreNotOfNowCountFromTheFirstOneOn) {
  TopicSource source(TopicSourceOptions{.body_frame = "base_link"});
  const Time before = Now();
  for (const Duration later : {Duration::zero(), Duration(milliseconds(50))}) {
    const PoseStampedMessage pose{{0, kStamp + later, "map"}, {{1, 2, 3}, {}}};
    source.Take({"/pose", std::string(PoseStampedMessage::kType), WireFormat::kRos1, {}},
                SerializeMessage(pose, WireFormat::kRos1));
  }
  const Time after = Now();
  const auto first = source.Next(Duration::zero());
  const auto second = source.Next(Duration::zero());
  ASSERT_TRUE(first && second);
  const Time time = std::get<PoseSample>(*first).time;
  EXPECT_TRUE(before <= time && time <= after);
  EXPECT_EQ(std::get<PoseSample>(*second).time - time, milliseconds(50));
  EXPECT_EQ(kStamp + source.from_stamps(), time);
}

TEST_F(TopicSourceTest, TheMountIsTheStaticTransformFromTheBody) {
  TakeImage(1, kStamp);
  EXPECT_FALSE(source_.Calibration()) << "no camera_info yet";
  Take(CameraInfoOf(camera_), "/camera_info");
  ASSERT_TRUE(source_.Calibration());
  EXPECT_FALSE(source_.Calibration()->body_from_camera);
  TfMessage tf;
  TransformStampedMessage& mount = tf.transforms.emplace_back();
  mount.header.frame_id = "base_link";
  mount.child_frame_id = "camera";
  mount.transform = {{0.1, 0, 0}, {1, 0, 0, 0}};
  Take(tf, kStaticTfTopic);
  ASSERT_TRUE(source_.Calibration()->body_from_camera);
  EXPECT_EQ(source_.Calibration()->body_from_camera->translation.x(), 0.1);
}

}  // namespace
}  // namespace kestrel
