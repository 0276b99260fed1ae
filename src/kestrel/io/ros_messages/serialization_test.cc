// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/io/ros_messages/serialization.h"

#include <string>
#include <string_view>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kestrel/core/base/error.h"
#include "kestrel/core/base/test_folder.h"

namespace kestrel {
namespace {

using ::testing::HasSubstr;
using namespace std::string_view_literals;

const Time kStamp = TimeFromNanoseconds(3'000'000'004);

TransformStampedMessage ExampleTransform() {
  return {{7, kStamp, "map"}, "uav1", {{1, 2, 3}, {0, 0, 0, 1}}};
}

// The numbers 0.0 to 3.0 as the eight bytes of a double.
constexpr std::string_view kZero = "\0\0\0\0\0\0\0\0"sv;
constexpr std::string_view kOne = "\0\0\0\0\0\0\xf0\x3f"sv;
constexpr std::string_view kTwo = "\0\0\0\0\0\0\0\x40"sv;
constexpr std::string_view kThree = "\0\0\0\0\0\0\x08\x40"sv;

std::string Joined(std::initializer_list<std::string_view> parts) {
  std::string text;
  for (const std::string_view part : parts) text += part;
  return text;
}

TEST(Serialization, Ros1HasNoAlignmentAndHasHeaderNumber) {
  EXPECT_EQ(SerializeMessage(ExampleTransform(), WireFormat::kRos1),
            Joined({"\7\0\0\0"sv, "\3\0\0\0\4\0\0\0"sv, "\3\0\0\0map"sv, "\4\0\0\0uav1"sv, kOne,
                    kTwo, kThree, kZero, kZero, kZero, kOne}));
}

// Texts end with a zero that is part of their length; the first double, after 25 bytes, is at 32.
TEST(Serialization, Ros2IsAlignedFromFourthByte) {
  EXPECT_EQ(SerializeMessage(ExampleTransform(), WireFormat::kCdr),
            Joined({"\0\1\0\0"sv, "\3\0\0\0\4\0\0\0"sv, "\4\0\0\0map\0"sv, "\5\0\0\0uav1\0"sv,
                    "\0\0\0\0\0\0\0"sv, kOne, kTwo, kThree, kZero, kZero, kZero, kOne}));
}

TEST(Serialization, RoundTripsInBothFormats) {
  CameraInfoMessage info;
  info.header = {0, kStamp, "camera"};
  info.width = 752;
  info.height = 480;
  info.distortion_model = "plumb_bob";
  info.d = {0.1, 0.2, 0.3};
  info.k[4] = 400;
  info.p[11] = 5;
  info.roi.do_rectify = 1;
  for (const WireFormat format : {WireFormat::kRos1, WireFormat::kCdr}) {
    const std::string bytes = SerializeMessage(info, format);
    const auto read = ParseMessage<CameraInfoMessage>(bytes, format, "info");
    EXPECT_EQ(read.header.stamp, kStamp);
    EXPECT_EQ(read.header.frame_id, "camera");
    EXPECT_EQ(read.width, 752u);
    EXPECT_EQ(read.distortion_model, "plumb_bob");
    EXPECT_EQ(read.d, info.d);
    EXPECT_EQ(read.k, info.k);
    EXPECT_EQ(read.p, info.p);
    EXPECT_EQ(read.roi.do_rectify, 1);
  }
}

TEST(Serialization, ReadsBigEndianCdr) {
  const std::string bytes = Joined({"\0\0\0\0"sv, "\0\0\0\3\0\0\0\4"sv, "\0\0\0\4map\0"sv});
  const auto header = ParseMessage<HeaderMessage>(bytes, WireFormat::kCdr, "header");
  EXPECT_EQ(header.stamp, kStamp);
  EXPECT_EQ(header.frame_id, "map");
}

TEST(Serialization, RefusesTruncatedBytes) {
  for (const WireFormat format : {WireFormat::kRos1, WireFormat::kCdr}) {
    const std::string bytes =
        SerializeMessage(TfMessage{{ExampleTransform(), ExampleTransform()}}, format);
    for (std::size_t size = 0; size < bytes.size(); ++size) {
      EXPECT_THAT(
          InputErrorOf([&] { ParseMessage<TfMessage>(bytes.substr(0, size), format, "/tf"); }),
          HasSubstr("/tf: the message ends"))
          << size;
    }
  }
}

TEST(Serialization, RefusesFalseLengths) {
  EXPECT_NE(
      InputErrorOf([] { ParseMessage<TfMessage>("\xff\xff\xff\xff"sv, WireFormat::kRos1, "/tf"); }),
      "");
  EXPECT_NE(InputErrorOf([] {
              ParseMessage<HeaderMessage>("\0\1\0\0\3\0\0\0\4\0\0\0\xff\xff\xff\xff"sv,
                                          WireFormat::kCdr, "header");
            }),
            "");
}

TEST(Serialization, RefusesOtherRepresentationsOfRos2) {
  EXPECT_EQ(
      InputErrorOf([] { ParseMessage<HeaderMessage>("\0\7\0\0"sv, WireFormat::kCdr, "header"); }),
      "header: is serialized as 0007, expected plain CDR (0000 or 0001)");
}

}  // namespace
}  // namespace kestrel
