// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/console/image_channel.h"

#include <cstring>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>

namespace kestrel {
namespace {

using namespace std::chrono_literals;

ConsoleFrame GrayFrame(Time time, int value) {
  ConsoleFrame frame;
  frame.captured = time;
  frame.image = cv::Mat(48, 64, CV_8UC1, cv::Scalar(value));
  return frame;
}

struct Unpacked {
  nlohmann::json text;
  cv::Mat image;
};
Unpacked Unpack(const std::string& message) {
  std::size_t size = 0;
  for (int i = 0; i < 4; ++i)
    size |= static_cast<std::size_t>(static_cast<unsigned char>(message[i])) << 8 * i;
  const std::vector<char> jpeg(message.begin() + 4 + size, message.end());
  return {nlohmann::json::parse(message.substr(4, size)), cv::imdecode(jpeg, cv::IMREAD_UNCHANGED)};
}

TEST(ImageChannelTest, OneMessageHoldsTheImageAndWhatWasFoundInIt) {
  ConsoleFeed feed({});
  ImageChannel channel(&feed, 90, 20);
  const Time captured = TimeFromNanoseconds(1700000000123456789);
  EXPECT_FALSE(channel.NewestAfter(0, captured));
  ConsoleFrame frame = GrayFrame(captured, 77);
  frame.shapes.push_back({OverlayLayer::kRejected, {{1.52f, 2}, {3, 4}}, "ring: not \xff round"});
  feed.SetFrame(&frame);
  const auto image = channel.NewestAfter(0, captured + 30ms);
  ASSERT_TRUE(image);
  const Unpacked unpacked = Unpack(*image->message);
  EXPECT_EQ(unpacked.text["time"], "1700000000123456789");
  EXPECT_EQ(unpacked.text["age_ms"], 30);
  EXPECT_EQ(unpacked.text["sequence"], 1);
  EXPECT_EQ(unpacked.text["width"], 64);
  EXPECT_EQ(unpacked.text["shapes"][0]["layer"], "rejected");
  EXPECT_EQ(unpacked.text["shapes"][0]["outline"], (std::vector<double>{1.5, 2, 3, 4}));
  ASSERT_EQ(unpacked.image.size(), cv::Size(64, 48));
  EXPECT_NEAR(unpacked.image.at<uchar>(20, 20), 77, 2);
}

TEST(ImageChannelTest, EncodesTheNewestOnlyAndOnceForAll) {
  ConsoleFeed feed({});
  ImageChannel channel(&feed, 70, 20);
  const Time start = TimeFromNanoseconds(0);
  for (int i = 0; i < 10; ++i) {
    ConsoleFrame frame = GrayFrame(start, 10 * i);
    feed.SetFrame(&frame);
  }
  const auto first = channel.NewestAfter(0, start), second = channel.NewestAfter(0, start);
  ASSERT_TRUE(first && second);
  EXPECT_EQ(first->sequence, 10u);
  EXPECT_EQ(first->message, second->message);
  EXPECT_FALSE(channel.NewestAfter(10, start + 1s));
  EXPECT_EQ(channel.encoded(), 1u);
}

TEST(ImageChannelTest, KeepsToItsRate) {
  ConsoleFeed feed({});
  ImageChannel channel(&feed, 70, 10);
  const Time start = TimeFromNanoseconds(0);
  int images = 0;
  std::uint64_t seen = 0;
  for (int ms = 0; ms < 1000; ms += 10) {
    ConsoleFrame frame = GrayFrame(start + ms * 1ms, 5);
    feed.SetFrame(&frame);
    if (const auto image = channel.NewestAfter(seen, start + ms * 1ms)) {
      seen = image->sequence;
      ++images;
    }
  }
  EXPECT_EQ(images, 10);
}

TEST(ImageChannelTest, AnImageThatIsNoneIsLeftOut) {
  ConsoleFeed feed({});
  ImageChannel channel(&feed, 70, 20);
  ConsoleFrame frame;
  frame.image = cv::Mat(4, 4, CV_32FC1, cv::Scalar(1));
  feed.SetFrame(&frame);
  EXPECT_FALSE(channel.NewestAfter(0, Time{}));
}

TEST(ImageFlowTest, OneIsOnItsWayUntilItIsDrawn) {
  ImageFlow flow;
  EXPECT_FALSE(flow.wants_next());
  flow.SetWanted(true);
  EXPECT_TRUE(flow.wants_next());
  const Time captured = TimeFromNanoseconds(1000);
  flow.Sent({3, captured, nullptr});
  EXPECT_FALSE(flow.wants_next());
  flow.Acknowledged(2, captured);
  EXPECT_FALSE(flow.wants_next());
  flow.Acknowledged(3, captured + 40ms);
  EXPECT_TRUE(flow.wants_next());
  EXPECT_EQ(flow.draw_time(), 40ms);
}

TEST(TelemetryChannelTest, TheOldestGoesAndIsCounted) {
  TelemetryChannel channel(2);
  for (const char* text : {"a", "b", "c"}) channel.Push(std::make_shared<const std::string>(text));
  EXPECT_EQ(channel.dropped(), 1u);
  EXPECT_EQ(*channel.Pop(), "b");
  EXPECT_EQ(*channel.Pop(), "c");
  EXPECT_EQ(channel.Pop(), nullptr);
}

}  // namespace
}  // namespace kestrel
