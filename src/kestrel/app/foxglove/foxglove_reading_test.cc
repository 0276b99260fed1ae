// SPDX-License-Identifier: BSD-3-Clause
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kestrel/app/foxglove/foxglove_messages.h"
#include "kestrel/core/base/error.h"
#include "kestrel/io/ros_messages/serialization.h"

namespace kestrel {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

const Time kTime = TimeFromNanoseconds(1'600'000'000'123'456'789);

template <class Message>
Message Read(const std::string& bytes) {
  return ParseMessage<Message>(bytes, WireFormat::kProtobuf, "file: /topic");
}

TEST(ReadFoxglove, ReadsCompressedImagesWithHeader) {
  const std::string bytes = ProtobufBytesOf(
      foxglove::CompressedImage{kTime, "camera", {std::string("\xff\xd8\0x", 4)}, "jpeg"});
  const auto image = Read<CompressedImageMessage>(bytes);
  EXPECT_EQ(image.header.stamp, kTime);
  EXPECT_EQ(image.header.frame_id, "camera");
  EXPECT_EQ(image.format, "jpeg");
  EXPECT_EQ(image.data, std::string_view("\xff\xd8\0x", 4));
  const auto header = Read<HeaderMessage>(bytes);
  EXPECT_EQ(header.stamp, kTime);
  EXPECT_EQ(header.frame_id, "camera");
}

TEST(ReadFoxglove, ReadsCalibrationsByRosNames) {
  foxglove::CameraCalibration written;
  written.width = 752;
  written.height = 480;
  written.distortion_model = "kannala_brandt";
  written.d = {0.5, -0.25};
  written.k = {100, 0, 50, 0, 101, 40, 0, 0, 1};
  const auto read = Read<CameraInfoMessage>(ProtobufBytesOf(written));
  EXPECT_EQ(read.width, 752u);
  EXPECT_EQ(read.distortion_model, "equidistant");
  EXPECT_THAT(read.d, ElementsAre(0.5, -0.25));
  EXPECT_EQ(read.k, written.k);
}

TEST(ReadFoxglove, ReadsPosesAndTransforms) {
  const foxglove::Pose pose{{1, 2, 3}, {0, 0, 0.6, 0.8}};
  const auto stamped =
      Read<PoseStampedMessage>(ProtobufBytesOf(foxglove::PoseInFrame{kTime, "map", pose}));
  EXPECT_EQ(stamped.header.frame_id, "map");
  EXPECT_EQ(stamped.pose.position.z, 3);
  EXPECT_EQ(stamped.pose.orientation.w, 0.8);
  foxglove::FrameTransform transform;
  transform.timestamp = kTime;
  transform.parent_frame_id = "map";
  transform.child_frame_id = "base_link";
  transform.translation = pose.position;
  const auto tf =
      Read<TfMessage>(ProtobufBytesOf(foxglove::FrameTransforms{{transform, transform}}));
  ASSERT_EQ(tf.transforms.size(), 2u);
  EXPECT_EQ(tf.transforms[1].child_frame_id, "base_link");
  EXPECT_EQ(tf.transforms[1].transform.translation.x, 1);
}

TEST(ReadFoxglove, RefusesMalformedMessages) {
  const std::string bytes =
      ProtobufBytesOf(foxglove::PoseInFrame{kTime, "map", {{1, 2, 3}, {0, 0, 0, 1}}});
  int refused = 0;
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    try {
      Read<PoseStampedMessage>(bytes.substr(0, size));
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(), HasSubstr("file: /topic: ends too early"));
      ++refused;
    }
  }
  EXPECT_GT(refused, 40);
  // Fields of another type have no numbers.
  EXPECT_TRUE(Read<CameraInfoMessage>(std::string("\x28\x05", 2)).d.empty());
  for (const std::string& broken : {std::string("\x0b"), std::string(11, '\xff')}) {
    EXPECT_THROW(Read<PoseStampedMessage>(broken), InputError);
  }
  const std::string far = ProtobufBytesOf(TimestampMessage{9'999'999'999'999, 0});
  EXPECT_THROW(Read<HeaderMessage>(std::string("\x0a") + static_cast<char>(far.size()) + far),
               InputError);
}

}  // namespace
}  // namespace kestrel
