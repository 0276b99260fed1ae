// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/console/image_channel.h"

#include <cstring>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "kestrel/core/codec/image_codec.h"

namespace kestrel {
namespace {

using namespace std::chrono_literals;

ConsoleFrame GrayFrame(Time time, int value) {
  ConsoleFrame frame;
  frame.captured = time;
  frame.image = cv::Mat(48, 64, CV_8UC1, cv::Scalar(value));
  return frame;
}

// A browser that wants images of a view, and has drawn all that it got.
ImageFlow Wanting(std::size_t view = 0, bool is_held = false) {
  ImageFlow flow;
  flow.SetWish(true, view, is_held);
  return flow;
}

// The view is half as bright as the camera's image.
ConsoleFeed::Description WithDarkView() {
  ConsoleFeed::Description description;
  description.views.push_back({"dark", [](const cv::Mat& image) { return cv::Mat(image / 2); }});
  return description;
}

struct Unpacked {
  nlohmann::json text;
  cv::Mat image;
};
Unpacked Unpack(const std::string& message) {
  std::size_t size = 0;
  for (int i = 0; i < 4; ++i)
    size |= static_cast<std::size_t>(static_cast<unsigned char>(message[i])) << 8 * i;
  return {nlohmann::json::parse(message.substr(4, size)),
          DecodeImage(message.substr(4 + size), "image")};
}

TEST(ImageChannelTest, MessageHoldsImageAndItsFindings) {
  ConsoleFeed feed({});
  ImageChannel channel(&feed, 90, 20);
  const Time captured = TimeFromNanoseconds(1700000000123456789);
  EXPECT_FALSE(channel.NextFor(Wanting(), captured));
  ConsoleFrame frame = GrayFrame(captured, 77);
  frame.shapes.push_back({OverlayLayer::kRejected, {{1.52f, 2}, {3, 4}}, "ring: not \xff round"});
  feed.SetFrame(&frame);
  const auto image = channel.NextFor(Wanting(), captured + 30ms);
  ASSERT_TRUE(image);
  const Unpacked unpacked = Unpack(*image->message);
  EXPECT_EQ(unpacked.text["time"], "1700000000123456789");
  EXPECT_EQ(unpacked.text["age_ms"], 30);
  EXPECT_EQ(unpacked.text["sequence"], 1);
  EXPECT_EQ(unpacked.text["view"], "");
  EXPECT_EQ(unpacked.text["width"], 64);
  EXPECT_EQ(unpacked.text["shapes"][0]["layer"], "rejected");
  EXPECT_EQ(unpacked.text["shapes"][0]["outline"], (std::vector<double>{1.5, 2, 3, 4}));
  ASSERT_EQ(unpacked.image.size(), cv::Size(64, 48));
  EXPECT_NEAR(unpacked.image.at<uchar>(20, 20), 77, 2);
}

TEST(ImageChannelTest, EncodesNewestImageOnceForAllViewers) {
  ConsoleFeed feed({});
  ImageChannel channel(&feed, 70, 20);
  const Time start = TimeFromNanoseconds(0);
  for (int i = 0; i < 10; ++i) {
    ConsoleFrame frame = GrayFrame(start, 10 * i);
    feed.SetFrame(&frame);
  }
  ImageFlow flow = Wanting();
  const auto first = channel.NextFor(flow, start), second = channel.NextFor(Wanting(), start);
  ASSERT_TRUE(first && second);
  EXPECT_EQ(first->frame->sequence, 10u);
  EXPECT_EQ(first->message, second->message);
  flow.Sent(*first);
  flow.Acknowledged(10, start);
  EXPECT_FALSE(channel.NextFor(flow, start + 1s));
  EXPECT_EQ(channel.encoded(), 1u);
}

TEST(ImageChannelTest, LimitsRate) {
  ConsoleFeed feed({});
  ImageChannel channel(&feed, 70, 10);
  const Time start = TimeFromNanoseconds(0);
  int images = 0;
  ImageFlow flow = Wanting();
  for (int ms = 0; ms < 1000; ms += 10) {
    ConsoleFrame frame = GrayFrame(start + ms * 1ms, 5);
    feed.SetFrame(&frame);
    if (const auto image = channel.NextFor(flow, start + ms * 1ms)) {
      flow.Sent(*image);
      flow.Acknowledged(image->frame->sequence, start + ms * 1ms);
      ++images;
    }
  }
  EXPECT_EQ(images, 10);
}

TEST(ImageChannelTest, OmitsImageOfUnsupportedType) {
  ConsoleFeed feed({});
  ImageChannel channel(&feed, 70, 20);
  ConsoleFrame frame;
  frame.image = cv::Mat(4, 4, CV_32FC1, cv::Scalar(1));
  feed.SetFrame(&frame);
  EXPECT_FALSE(channel.NextFor(Wanting(), Time{}));
}

TEST(ImageChannelTest, DrawsViewOnceAndOnlyWhenRequested) {
  int drawn = 0;
  ConsoleFeed::Description description;
  description.views.push_back({"dark", [&drawn](const cv::Mat& image) {
                                 ++drawn;
                                 return cv::Mat(image / 2);
                               }});
  ConsoleFeed feed(std::move(description));
  ImageChannel channel(&feed, 90, 20);
  EXPECT_EQ(channel.FindView(""), 0u);
  EXPECT_EQ(channel.FindView("dark"), 1u);
  EXPECT_FALSE(channel.FindView("darker"));
  ConsoleFrame frame = GrayFrame(TimeFromNanoseconds(0), 120);
  feed.SetFrame(&frame);
  const auto camera = channel.NextFor(Wanting(), Time{});
  ASSERT_TRUE(camera);
  EXPECT_EQ(drawn, 0);
  const auto first = channel.NextFor(Wanting(1), Time{}),
             second = channel.NextFor(Wanting(1), Time{});
  ASSERT_TRUE(first && second);
  EXPECT_EQ(drawn, 1);
  EXPECT_EQ(first->message, second->message);
  const Unpacked unpacked = Unpack(*first->message);
  EXPECT_EQ(unpacked.text["view"], "dark");
  EXPECT_EQ(unpacked.text["sequence"], 1);
  EXPECT_NEAR(unpacked.image.at<uchar>(20, 20), 60, 2);
  EXPECT_NEAR(Unpack(*camera->message).image.at<uchar>(20, 20), 120, 2);
}

TEST(ImageChannelTest, ShowsHeldFrameInAnotherView) {
  ConsoleFeed feed(WithDarkView());
  ImageChannel channel(&feed, 90, 20);
  const Time start = TimeFromNanoseconds(0);
  ConsoleFrame frame = GrayFrame(start, 120);
  feed.SetFrame(&frame);
  ImageFlow flow = Wanting();
  const auto show = [&](Time now) {
    auto image = channel.NextFor(flow, now);
    if (image) {
      flow.Sent(*image);
      flow.Acknowledged(image->frame->sequence, now);
    }
    return image;
  };
  ASSERT_TRUE(show(start));
  flow.SetWish(true, 0, /*is_held=*/true);
  frame.image = cv::Mat(48, 64, CV_8UC1, cv::Scalar(250));
  feed.SetFrame(&frame);
  EXPECT_FALSE(show(start + 1s)) << "it has that frame";
  flow.SetWish(true, 1, /*is_held=*/true);
  const auto dark = show(start + 2s);
  ASSERT_TRUE(dark);
  EXPECT_EQ(dark->frame->sequence, 1u);
  EXPECT_NEAR(Unpack(*dark->message).image.at<uchar>(20, 20), 60, 2);
  EXPECT_FALSE(show(start + 3s));
  flow.SetWish(false, 1, true);
  EXPECT_FALSE(show(start + 4s));
  flow.SetWish(true, 1, true);
  EXPECT_EQ(show(start + 5s)->frame->sequence, 1u) << "the page has come back, with nothing";
  flow.SetWish(true, 1, false);
  EXPECT_EQ(show(start + 6s)->frame->sequence, 2u);
}

TEST(ImageFlowTest, SendsNextImageOnlyAfterAcknowledgement) {
  ImageFlow flow;
  EXPECT_FALSE(flow.wants_next());
  flow.SetWish(true, 0, false);
  EXPECT_TRUE(flow.wants_next());
  const Time captured = TimeFromNanoseconds(1000);
  auto frame = std::make_shared<ConsoleFrame>();
  frame->sequence = 3;
  frame->captured = captured;
  flow.Sent({frame, 0, nullptr});
  EXPECT_FALSE(flow.wants_next());
  flow.Acknowledged(2, captured);
  EXPECT_FALSE(flow.wants_next());
  flow.Acknowledged(3, captured + 40ms);
  EXPECT_TRUE(flow.wants_next());
  EXPECT_EQ(flow.draw_time(), 40ms);
}

TEST(TelemetryChannelTest, DropsOldestMessageAndCountsIt) {
  TelemetryChannel channel(2);
  for (const char* text : {"a", "b", "c"}) channel.Push(std::make_shared<const std::string>(text));
  EXPECT_EQ(channel.dropped(), 1u);
  EXPECT_EQ(*channel.Pop(), "b");
  EXPECT_EQ(*channel.Pop(), "c");
  EXPECT_EQ(channel.Pop(), nullptr);
}

}  // namespace
}  // namespace kestrel
