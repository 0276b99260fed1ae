// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/web_server/viewer_hub.h"

#include <atomic>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kestrel/app/console/console_page.h"
#include "kestrel/app/web_server/test_browser.h"

namespace kestrel {
namespace {

using namespace std::chrono_literals;
using Json = nlohmann::json;

constexpr char kProtocols[] = "foxglove.sdk.v1, foxglove.websocket.v1";
constexpr char kSubscribeAll[] =
    R"({"op": "subscribe", "subscriptions": [{"id": 10, "channelId": 0}, {"id": 11, "channelId": 1}]})";
constexpr std::size_t kHeadBytes = 13;

class ViewerHubTest : public testing::Test {
 protected:
  void Serve(const ConsoleOptions& options) {
    server_.emplace(ServeConsole(options, &feed_, {}, &channels_));
  }
  TestSocket Connect(const std::string& origin = "", const std::string& target = "/foxglove",
                     const std::string& protocols = kProtocols) const {
    return TestSocket(server_->port(), origin, "", target, protocols);
  }
  bool LetsIn(const std::string& origin, const std::string& target = "/foxglove") const {
    return Connect(origin, target).is_open();
  }
  void Add(std::size_t channel, int time_ns, std::size_t bytes = 3) {
    channels_.Add(
        {channel, TimeFromNanoseconds(time_ns), std::make_shared<const std::string>(bytes, 'x')});
  }

  ConsoleFeed feed_{
      {.title = "test", .is_live = true, .series = {}, .layers = {}, .views = {}, .offers = {}}};
  ChannelFeed channels_{{{"/image", "protobuf", "Image", "protobuf", "a", true},
                         {"/result", "protobuf", "Result", "protobuf", "ab", false}}};
  std::optional<WebServer> server_;
};

TEST_F(ViewerHubTest, SendsSubscribedChannels) {
  Serve(AnyPort());
  TestSocket viewer = Connect();
  ASSERT_TRUE(viewer.is_open());
  EXPECT_EQ(viewer.subprotocol(), "foxglove.sdk.v1");
  EXPECT_EQ(Json::parse(*viewer.Read())["op"], "serverInfo");
  EXPECT_EQ(Json::parse(*viewer.Read())["channels"].size(), 2u);
  EXPECT_FALSE(channels_.IsWatched());
  EXPECT_FALSE(feed_.IsWatched());
  viewer.Send(R"({"op": "subscribe", "subscriptions": [{"id": 7, "channelId": 1}]})");
  ASSERT_TRUE(Eventually([&] { return channels_.IsWanted(1); }));
  EXPECT_FALSE(channels_.IsWanted(0));  // images need not be made
  Add(0, 1);
  Add(1, 0x0102);
  const auto message = viewer.Read();
  ASSERT_TRUE(message);
  EXPECT_FALSE(viewer.is_text());
  EXPECT_EQ(*message, std::string("\x01\x07\0\0\0\x02\x01\0\0\0\0\0\0xxx", 16));
  viewer.Send(R"({"op": "unsubscribe", "subscriptionIds": [7]})");
  EXPECT_TRUE(Eventually([&] { return !channels_.IsWatched(); }));
}

TEST_F(ViewerHubTest, ServesOlderApps) {
  Serve(AnyPort());
  EXPECT_EQ(Connect("", "/foxglove", "foxglove.websocket.v1").subprotocol(),
            "foxglove.websocket.v1");
  EXPECT_FALSE(Connect("", "/foxglove", "").is_open());
  EXPECT_FALSE(Connect("", "/foxglove", "foxglove.websocket.v9").is_open());
  EXPECT_FALSE(Connect("", "/foxglove/", kProtocols).is_open());
}

TEST_F(ViewerHubTest, AdmitsListedOriginsOnly) {
  ConsoleOptions options = AnyPort();
  options.viewer_origins = "https://app.foxglove.dev, https://lichtblick.example";
  Serve(options);
  EXPECT_TRUE(LetsIn(""));
  EXPECT_TRUE(LetsIn("https://app.foxglove.dev"));
  EXPECT_TRUE(LetsIn("http://127.0.0.1:" + std::to_string(server_->port())));
  for (const char* origin : {"http://app.foxglove.dev", "https://app.foxglove.dev.evil.example",
                             "https://evil.example", "null", "file://"}) {
    EXPECT_FALSE(LetsIn(origin)) << origin;
  }
  // The origin is allowed to get the viewers' messages, but not to send the page's commands.
  EXPECT_FALSE(LetsIn("https://app.foxglove.dev", "/live"));
  EXPECT_FALSE(LetsIn("", "/live"));
}

TEST_F(ViewerHubTest, RefusesForeignOriginsByDefault) {
  Serve(AnyPort());
  EXPECT_TRUE(LetsIn(""));
  EXPECT_FALSE(LetsIn("https://app.foxglove.dev"));
}

TEST_F(ViewerHubTest, RequiresTokenInAddress) {
  Serve(AnyPort(kSecret));
  EXPECT_THAT(server_->viewer_url(), testing::EndsWith("/foxglove?token=0123456789abcdef"));
  EXPECT_TRUE(LetsIn("", "/foxglove?token=0123456789abcdef"));
  for (const char* target : {"/foxglove", "/foxglove?token=", "/foxglove?token=0123456789abcdee",
                             "/foxglove?token=0123456789abcdef&x"}) {
    EXPECT_FALSE(LetsIn("", target)) << target;
  }
  EXPECT_FALSE(LetsIn("https://evil.example", "/foxglove?token=0123456789abcdef"));
  EXPECT_FALSE(LetsIn("http://127.0.0.1:" + std::to_string(server_->port()),
                      "/live?token=0123456789abcdef"));
}

TEST_F(ViewerHubTest, RefusesWriteRequestsWithStatus) {
  Serve(AnyPort());
  TestSocket viewer = Connect();
  viewer.Read();
  viewer.Read();
  viewer.Send(R"({"op": "setParameters", "parameters": [{"name": "x", "value": 1}]})");
  const Json status = Json::parse(*viewer.Read());
  EXPECT_EQ(status["op"], "status");
  EXPECT_EQ(status["level"], 1);
  EXPECT_THAT(status["message"].get<std::string>(), testing::HasSubstr("setParameters"));
  viewer.Send(std::string("\x01\0\0\0\0hello", 10), /*is_text=*/false);
  EXPECT_EQ(Json::parse(*viewer.Read())["op"], "status");
}

TEST_F(ViewerHubTest, ClosesConnectionAfterInvalidMessage) {
  Serve(AnyPort());
  for (const std::string& text :
       {std::string("{}"), std::string("garbage"), std::string(20000, ' '),
        std::string(R"({"op": "subscribe", "subscriptions": [{"id": -1, "channelId": 0}]})")}) {
    TestSocket viewer = Connect();
    viewer.Send(text);
    EXPECT_TRUE(viewer.IsEnded()) << text.substr(0, 20);
  }
  TestSocket binary = Connect();
  binary.Send("\x09", /*is_text=*/false);
  EXPECT_TRUE(binary.IsEnded());
  TestSocket flood = Connect();
  for (int i = 0; i < 2000; ++i) flood.Send(R"({"op": "getParameters"})");
  EXPECT_TRUE(flood.IsEnded());
  EXPECT_TRUE(Eventually([&] { return server_->counters().viewers == 0; }));
  EXPECT_GE(server_->counters().refused, 5u);
}

TEST_F(ViewerHubTest, RefusesViewersWithoutChannels) {
  server_.emplace(ServeConsole(AnyPort(), &feed_, {}));
  EXPECT_FALSE(LetsIn(""));
}

// The oldest messages of a viewer that does not read are dropped; the others get all.
TEST_F(ViewerHubTest, StalledViewerDoesNotDelayOthers) {
  ConsoleOptions options = AnyPort();
  options.idle_timeout_s = 2;
  Serve(options);
  TestSocket good = Connect(), stalled = Connect();
  good.Send(kSubscribeAll);
  stalled.Send(kSubscribeAll);
  ASSERT_TRUE(
      Eventually([&] { return server_->counters().viewers == 2 && channels_.IsWanted(0); }));
  good.Read();
  good.Read();
  constexpr std::size_t kLarge = 4 << 20;  // more than the system's buffers hold
  for (int i = 1; i <= 20; ++i) {
    Add(0, i, kLarge);
    Add(1, i);
    bool has_image = false, has_result = false;
    while (!has_image || !has_result) {
      const auto message = good.Read();
      ASSERT_TRUE(message);
      EXPECT_EQ(message->at(5), i);  // the time
      (message->size() > kLarge ? has_image : has_result) = true;
      EXPECT_GT(message->size(), kHeadBytes);
    }
  }
  // The stalled viewer is disconnected.
  std::atomic<bool> is_over{false};
  std::thread reader([&] {
    while (!is_over && good.Read()) {
    }
  });
  EXPECT_TRUE(Eventually([&] { return server_->counters().viewers == 1; }));
  is_over = true;
  Add(1, 21);  // wakes the reader
  reader.join();
}

}  // namespace
}  // namespace kestrel
