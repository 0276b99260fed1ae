// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/web_server/viewer_request.h"

#include <gtest/gtest.h>

namespace kestrel {
namespace {

TEST(ViewerRequestTest, ReadsSubscriptions) {
  const auto request = ParseViewerText(
      R"({"op": "subscribe", "subscriptions": [{"id": 0, "channelId": 3}, {"id": 4294967295, "channelId": 5}]})");
  ASSERT_TRUE(request);
  const auto& subscriptions = std::get<SubscribeRequest>(*request).subscriptions;
  ASSERT_EQ(subscriptions.size(), 2u);
  EXPECT_EQ(subscriptions[0].channel, 3u);
  EXPECT_EQ(subscriptions[1].id, 4294967295u);
  const auto end = ParseViewerText(R"({"op": "unsubscribe", "subscriptionIds": [0, 7]})");
  ASSERT_TRUE(end);
  EXPECT_EQ(std::get<UnsubscribeRequest>(*end).ids, (std::vector<std::uint32_t>{0, 7}));
}

TEST(ViewerRequestTest, RecognisesUnsupportedRequests) {
  const auto requests = [](const std::optional<ViewerRequest>& request) {
    return request ? std::get<OtherRequest>(*request).what : "";
  };
  EXPECT_EQ(requests(ParseViewerText(R"({"op": "getParameters", "parameterNames": []})")),
            "getParameters");
  EXPECT_EQ(requests(ParseViewerText(R"({"op": "advertise", "channels": [{"id": 1}]})")),
            "advertise");
  EXPECT_EQ(requests(ParseViewerBytes({"\x01\0\0\0\0", 5})), "message");
  EXPECT_EQ(requests(ParseViewerBytes({"\x02\0\0\0\0\0\0\0\0\0\0\0\0", 13})), "call");
}

TEST(ViewerRequestTest, RefusesMalformedRequests) {
  const std::string many = [] {
    std::string ids = "0";
    for (int i = 1; i < 300; ++i) ids.append(",").append(std::to_string(i));
    return R"({"op": "unsubscribe", "subscriptionIds": [)" + ids + "]}";
  }();
  for (const std::string& text :
       {std::string(), std::string("{"), std::string("[]"), std::string("{}"),
        std::string(R"({"op": 1})"), std::string(R"({"op": ""})"),
        std::string(R"({"op": "sub scribe"})"),
        std::string(R"({"op": ")") + std::string(65, 'a') + "\"}",
        std::string(R"({"op": "subscribe"})"),
        std::string(R"({"op": "subscribe", "subscriptions": {}})"),
        std::string(R"({"op": "subscribe", "subscriptions": [1]})"),
        std::string(R"({"op": "subscribe", "subscriptions": [{"id": -1, "channelId": 3}]})"),
        std::string(R"({"op": "subscribe", "subscriptions": [{"id": 1.5, "channelId": 3}]})"),
        std::string(
            R"({"op": "subscribe", "subscriptions": [{"id": 4294967296, "channelId": 3}]})"),
        std::string(R"({"op": "subscribe", "subscriptions": [{"id": 1}]})"),
        std::string(R"({"op": "unsubscribe", "subscriptionIds": ["1"]})"), many,
        std::string(R"({"op": "setParameters", "parameters": )") + std::string(20, '[') +
            std::string(20, ']') + "}"}) {
    EXPECT_FALSE(ParseViewerText(text)) << text.substr(0, 80);
  }
  for (const std::string& bytes :
       {std::string(), std::string("\x01\0\0\0", 4), std::string("\x02\0\0\0\0\0\0\0\0", 9),
        std::string("\x03\0\0\0\0\0\0\0\0\0\0\0\0", 13), std::string("{\"op\": 1}")}) {
    EXPECT_FALSE(ParseViewerBytes(bytes));
  }
}

}  // namespace
}  // namespace kestrel
