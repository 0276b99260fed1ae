// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/console/client_message.h"

#include <string>

#include <gtest/gtest.h>

namespace kestrel {
namespace {

TEST(ClientMessageTest, ReadsWhatThePageSends) {
  EXPECT_EQ(std::get<ImageAck>(*ParseClientMessage(R"({"ack": 7})")).sequence, 7u);
  EXPECT_TRUE(std::get<ImageWish>(*ParseClientMessage(R"({"images": true})")).wanted);
  const auto seek =
      std::get<ConsoleCommand>(*ParseClientMessage(R"({"command": "seek", "value": 2.5})"));
  EXPECT_EQ(seek.kind, ConsoleCommandKind::kSeek);
  EXPECT_EQ(seek.value, 2.5);
  EXPECT_EQ(std::get<ConsoleCommand>(*ParseClientMessage(R"({"command":"snapshot"})")).kind,
            ConsoleCommandKind::kSnapshot);
  const auto detect = std::get<ConsoleCommand>(
      *ParseClientMessage(R"({"command": "detect", "settings": ["a=1", "b=2"]})"));
  EXPECT_EQ(detect.kind, ConsoleCommandKind::kDetect);
  EXPECT_EQ(detect.settings, (std::vector<std::string>{"a=1", "b=2"}));
  const auto calibrate = std::get<ConsoleCommand>(
      *ParseClientMessage(R"({"command": "calibrate", "settings": ["lens"]})"));
  EXPECT_EQ(calibrate.kind, ConsoleCommandKind::kCalibrate);
  EXPECT_EQ(calibrate.settings, std::vector<std::string>{"lens"});
  EXPECT_EQ(std::get<ConsoleCommand>(*ParseClientMessage(R"({"command":"calibrate-save"})")).kind,
            ConsoleCommandKind::kCalibrateSave);
}

TEST(ClientMessageTest, SettingsAreBounded) {
  const auto detect = [](int count, int size) {
    std::string list;
    for (int i = 0; i < count; ++i) list += ",\"" + std::string(size, 'x') + "\"";
    return ParseClientMessage(R"({"command": "detect", "settings": [)" +
                              list.substr(std::min<std::size_t>(1, list.size())) + "]}");
  };
  EXPECT_TRUE(detect(0, 1));
  EXPECT_TRUE(detect(32, 128));
  EXPECT_FALSE(detect(33, 1));
  EXPECT_FALSE(detect(1, 129));
}

TEST(ClientMessageTest, RefusesAllElse) {
  for (const char* text : {"",
                           "{",
                           "[]",
                           "{}",
                           "7",
                           "null",
                           R"({"ack": -1})",
                           R"({"ack": "7"})",
                           R"({"ack": 1.5})",
                           R"({"ack": 1, "images": true})",
                           R"({"images": 1})",
                           R"({"command": 1})",
                           R"({"command": "format"})",
                           R"({"command": "seek", "value": "2"})",
                           R"({"command": "seek", "value": 1e999})",
                           R"({"command": "seek", "path": 1})",
                           R"({"command": "seek", "value": 1, "path": 1})",
                           R"({"other": 1})",
                           R"({"command": "detect"})",
                           R"({"command": "detect", "settings": "a=1"})",
                           R"({"command": "detect", "settings": [1]})",
                           R"({"command": "detect", "settings": [["a"]]})",
                           R"({"command": "step", "settings": []})",
                           R"({"command": "calibrate"})",
                           R"({"command": "calibrate-save", "settings": ["/tmp"]})",
                           "\xff\xfe"}) {
    EXPECT_FALSE(ParseClientMessage(text)) << text;
  }
}

TEST(ClientMessageTest, DeepNestingCostsNoStack) {
  EXPECT_FALSE(ParseClientMessage(std::string(1 << 20, '[')));
  std::string text = "{\"ack\":";
  text.append(10000, '[').append(10000, ']').append("}");
  EXPECT_FALSE(ParseClientMessage(text));
}

}  // namespace
}  // namespace kestrel
