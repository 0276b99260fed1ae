// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/web_server/viewer_flow.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace kestrel {
namespace {

using ::testing::HasSubstr;
using Json = nlohmann::json;

constexpr std::size_t kImages = 0, kResults = 1;

const std::vector<LiveChannel>& Channels() {
  static const std::vector<LiveChannel> channels = {
      {"/image", "protobuf", "Image", "protobuf", "a", true},
      {"/result", "protobuf", "Result", "protobuf", "ab", false}};
  return channels;
}

ChannelMessage Message(std::size_t channel, int time_ns) {
  return {channel, TimeFromNanoseconds(time_ns),
          std::make_shared<const std::string>(std::to_string(time_ns))};
}

class ViewerFlowTest : public testing::Test {
 protected:
  void Subscribe(std::uint32_t id, std::uint32_t channel) {
    flow_.Take(SubscribeRequest{{{id, channel}}});
  }
  // The contents of all waiting messages; for texts their message.
  std::vector<std::string> PopAll() {
    std::vector<std::string> all;
    while (const auto message = flow_.Pop()) {
      all.push_back(message->is_text ? Json::parse(message->head)["message"].get<std::string>()
                                     : *message->content);
    }
    return all;
  }

  ViewerFlow flow_{&Channels(), 3};
};

TEST_F(ViewerFlowTest, MessagesCarrySubscriptionAndTime) {
  flow_.Offer(Message(kResults, 1));  // nobody has subscribed to it
  Subscribe(0x01020304, kResults);
  EXPECT_EQ(flow_.wanted(), 2u);
  flow_.Offer(Message(kResults, 0x0506));
  const auto message = flow_.Pop();
  ASSERT_TRUE(message);
  EXPECT_FALSE(message->is_text);
  EXPECT_EQ(message->head, std::string("\x01\x04\x03\x02\x01\x06\x05\0\0\0\0\0\0", 13));
  EXPECT_EQ(*message->content, "1286");
  EXPECT_FALSE(flow_.Pop());
  flow_.Take(UnsubscribeRequest{{0x01020304}});
  EXPECT_EQ(flow_.wanted(), 0u);
  flow_.Offer(Message(kResults, 2));
  EXPECT_FALSE(flow_.Pop());
}

TEST_F(ViewerFlowTest, DropsImagesFirstOnSlowConnection) {
  Subscribe(1, kImages);
  Subscribe(2, kResults);
  for (int i = 1; i <= 3; ++i) {
    flow_.Offer(Message(kImages, i));
    flow_.Offer(Message(kResults, i));
  }
  EXPECT_THAT(PopAll(), testing::ElementsAre("1", "2", "3", "3"));
  flow_.ReportLosses();
  EXPECT_THAT(PopAll(), testing::ElementsAre(HasSubstr("2 images and 0 messages left out")));
  for (int i = 1; i <= 5; ++i) flow_.Offer(Message(kResults, i));
  EXPECT_THAT(PopAll(), testing::ElementsAre("3", "4", "5"));
  flow_.ReportLosses();
  EXPECT_THAT(PopAll(), testing::ElementsAre(HasSubstr("0 images and 2 messages left out")));
  flow_.ReportLosses();
  EXPECT_FALSE(flow_.Pop());
}

TEST_F(ViewerFlowTest, DropsImageAfterUnsubscribe) {
  Subscribe(1, kImages);
  flow_.Offer(Message(kImages, 1));
  flow_.Take(UnsubscribeRequest{{1}});
  EXPECT_FALSE(flow_.Pop());
}

TEST_F(ViewerFlowTest, ReportsInvalidRequests) {
  Subscribe(1, kResults);
  Subscribe(1, kImages);
  Subscribe(2, kResults);
  EXPECT_THAT(PopAll(), testing::ElementsAre(HasSubstr("subscription 1 already"),
                                             HasSubstr("subscribed to already")));
  Subscribe(3, 2);
  flow_.Take(UnsubscribeRequest{{9}});
  flow_.Take(OtherRequest{"setParameters"});
  EXPECT_THAT(PopAll(), testing::ElementsAre("there is no channel 2", "there is no subscription 9",
                                             HasSubstr("'setParameters' is not done here")));
  EXPECT_EQ(flow_.wanted(), 2u);
}

TEST(ViewerJsonTest, DescribesServerAndChannels) {
  const Json info = Json::parse(ServerInfoJson("a flight", "17"));
  EXPECT_EQ(info, (Json{{"op", "serverInfo"},
                        {"name", "a flight"},
                        {"capabilities", Json::array()},
                        {"sessionId", "17"}}));
  const Json advertisement = Json::parse(AdvertiseJson(Channels()));
  EXPECT_EQ(advertisement["op"], "advertise");
  EXPECT_EQ(advertisement["channels"][0]["schema"], "YQ==");
  EXPECT_EQ(advertisement["channels"][1], (Json{{"id", 1},
                                                {"topic", "/result"},
                                                {"encoding", "protobuf"},
                                                {"schemaName", "Result"},
                                                {"schema", "YWI="},
                                                {"schemaEncoding", "protobuf"}}));
}

}  // namespace
}  // namespace kestrel
