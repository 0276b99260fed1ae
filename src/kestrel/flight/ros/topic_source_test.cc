// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/ros/topic_source.h"

#include <chrono>
#include <functional>
#include <string>
#include <string_view>
#include <variant>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kestrel/core/base/error.h"
#include "kestrel/io/ros_messages/camera_info.h"
#include "kestrel/io/ros_messages/serialization.h"

namespace kestrel {
namespace {

using std::chrono::milliseconds;
using ::testing::HasSubstr;

constexpr Time kStamp = TimeFromNanoseconds(5'000'000'000);

// The message with which 'action' is refused; empty when it is not.
std::string ErrorOf(const std::function<void()>& action) {
  try {
    action();
    return "";
  } catch (const InputError& error) {
    return error.what();
  }
}

class TopicSourceTest : public ::testing::Test {
 protected:
  template <class Message>
  void Take(const Message& message, const std::string& topic) {
    source_.Take({topic, std::string(Message::kType), WireFormat::kCdr, {}},
                 SerializeMessage(message, WireFormat::kCdr));
  }
  void TakeImage(Time stamp, std::uint32_t width = 8) {
    ImageMessage message;
    message.header = {0, stamp, "camera"};
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
  // The stamp of the next frame; fails when the next event is none.
  Time NextFrame() {
    const auto event = source_.Next(Duration::zero());
    if (!event || !std::holds_alternative<Frame>(*event)) {
      ADD_FAILURE() << "no frame";
      return {};
    }
    return std::get<Frame>(*event).time - source_.from_stamps();
  }

  const CameraIntrinsics camera_{8, 4, 10, 10, 3.5, 1.5, DistortionModel::kNone, {}};
  TopicSource source_{TopicSourceOptions{.body_frame = "base_link"}};
};

TEST_F(TopicSourceTest, KeepsNewestImageOnlyBeforeStart) {
  TakeImage(kStamp);
  TakeImage(kStamp + milliseconds(50));
  source_.Begin(camera_);
  TakeImage(kStamp + milliseconds(100));
  EXPECT_EQ(NextFrame(), kStamp + milliseconds(50));
  EXPECT_EQ(NextFrame(), kStamp + milliseconds(100));
  EXPECT_FALSE(source_.Next(Duration::zero()));
  EXPECT_EQ(source_.counters().captured, 2);
  EXPECT_EQ(source_.counters().refused, 1);
}

TEST_F(TopicSourceTest, RefusesImagesOfAnotherSize) {
  TakeImage(kStamp, /*width=*/16);
  source_.Begin(camera_);
  EXPECT_FALSE(source_.Next(Duration::zero()));
  EXPECT_THROW(TakeImage(kStamp + milliseconds(50), /*width=*/16), InputError);
  EXPECT_NO_THROW(TakeImage(kStamp + milliseconds(100)));
}

TEST_F(TopicSourceTest, RefusesBrokenMessagesAndCountsTheirImages) {
  source_.Begin(camera_);
  TakeImage(kStamp);
  EXPECT_THAT(ErrorOf([&] { TakeImage(kStamp); }), HasSubstr("not later than the one before"));
  EXPECT_THAT(ErrorOf([&] { TakeImage(Time()); }), HasSubstr("have no stamps"));
  const RosTopic images{"/image", std::string(ImageMessage::kType), WireFormat::kCdr, {}};
  EXPECT_THAT(ErrorOf([&] { source_.Take(images, std::string_view("\0\1\0\0cut", 7)); }),
              HasSubstr("/image: the message ends after 7 bytes"));
  EXPECT_THAT(ErrorOf([&] {
                source_.Take({"/pose", "std_msgs/String", WireFormat::kCdr, {}}, "");
              }),
              HasSubstr("/pose: is of type std_msgs/String"));
  EXPECT_EQ(source_.counters().captured, 1);
  EXPECT_EQ(source_.counters().refused, 3);
  EXPECT_EQ(source_.counters().missed, 3);
}

TEST_F(TopicSourceTest, RefusesStampsThatJumpBack) {
  source_.Begin(camera_);
  TakePose(kStamp + milliseconds(2000));
  TakeImage(kStamp + milliseconds(2000));
  EXPECT_THAT(ErrorOf([&] { TakePose(kStamp); }), HasSubstr("jump back: start again"));
  EXPECT_THAT(ErrorOf([&] { TakeImage(kStamp); }), HasSubstr("jump back: start again"));
}

TEST(TopicSource, ShiftsOldStampsByFirstOne) {
  TopicSource source(TopicSourceOptions{.body_frame = "base_link"});
  const Time before = Now();
  for (const Duration later : {Duration::zero(), Duration(milliseconds(50))}) {
    const PoseStampedMessage pose{{0, kStamp + later, "map"}, {{1, 2, 3}, {}}};
    source.Take({"/pose", std::string(PoseStampedMessage::kType), WireFormat::kCdr, {}},
                SerializeMessage(pose, WireFormat::kCdr));
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

TEST_F(TopicSourceTest, TakesMountFromStaticTransformOfBody) {
  TakeImage(kStamp);
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
