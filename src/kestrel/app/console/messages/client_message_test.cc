// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/console/messages/client_message.h"

#include <string>

#include <gtest/gtest.h>

namespace kestrel {
namespace {

TEST(ClientMessageTest, ReadsMessagesOfPage) {
  EXPECT_EQ(std::get<ImageAck>(*ParseClientMessage(R"({"ack": 7})")).sequence, 7u);
  EXPECT_TRUE(std::get<ImageWish>(*ParseClientMessage(R"({"images": true})")).is_wanted);
  EXPECT_FALSE(std::get<ImageWish>(*ParseClientMessage(R"({"images": false})")).is_wanted);
  const auto view =
      std::get<ImageWish>(*ParseClientMessage(R"({"images": "threshold 1/8", "hold": true})"));
  EXPECT_TRUE(view.is_wanted && view.is_held);
  EXPECT_EQ(view.view, "threshold 1/8");
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
  const auto save = std::get<ConsoleCommand>(
      *ParseClientMessage(R"({"command": "settings", "settings": ["landing.target.id=3"]})"));
  EXPECT_EQ(save.kind, ConsoleCommandKind::kSettings);
  EXPECT_EQ(save.settings, std::vector<std::string>{"landing.target.id=3"});
  EXPECT_FALSE(ParseClientMessage(R"({"command": "settings"})"));
  const auto mark = std::get<ConsoleCommand>(*ParseClientMessage(
      R"({"command": "mark", "settings": ["1700000000000000000", "1", "2", "30", "40"]})"));
  EXPECT_EQ(mark.kind, ConsoleCommandKind::kMark);
  EXPECT_EQ(mark.settings.size(), 5u);
  EXPECT_EQ(std::get<ConsoleCommand>(*ParseClientMessage(R"({"command": "point"})")).kind,
            ConsoleCommandKind::kPoint);
  EXPECT_EQ(std::get<ConsoleCommand>(*ParseClientMessage(R"({"command": "confirm"})")).kind,
            ConsoleCommandKind::kConfirm);
  EXPECT_EQ(std::get<ConsoleCommand>(*ParseClientMessage(R"({"command": "stop"})")).kind,
            ConsoleCommandKind::kStop);
}

TEST(ClientMessageTest, LimitsSettings) {
  const auto detect = [](int count, int size) {
    std::string list;
    for (int i = 0; i < count; ++i) list += ",\"" + std::string(size, 'x') + "\"";
    return ParseClientMessage(R"({"command": "detect", "settings": [)" +
                              list.substr(std::min<std::size_t>(1, list.size())) + "]}");
  };
  EXPECT_TRUE(detect(0, 1));
  EXPECT_TRUE(detect(32, 512));
  EXPECT_FALSE(detect(33, 1));
  EXPECT_FALSE(detect(1, 513));
}

std::string Mark(const std::string& frame, const std::string& tool, const std::string& size,
                 const std::string& points) {
  return R"({"colors": "mark", "color": "red", "frame": )" + frame + R"(, "tool": ")" + tool +
         R"(", "size": )" + size + R"(, "points": )" + points + "}";
}

TEST(ClientMessageTest, ReadsMessagesOfColourPage) {
  const auto mark =
      std::get<ColorRequest>(*ParseClientMessage(Mark("3", "brush", "4.5", "[1, 2, 3, 4]")));
  EXPECT_EQ(mark.action, ColorAction::kMark);
  EXPECT_EQ(mark.stroke, (ColorStroke{3, "red", StrokeTool::kBrush, 4.5, {{1, 2}, {3, 4}}}));
  const auto teach =
      std::get<ColorRequest>(*ParseClientMessage(R"({"colors": "teach", "color": "red"})"));
  EXPECT_EQ(teach.action, ColorAction::kTeach);
  EXPECT_EQ(teach.color, "red");
  EXPECT_EQ(std::get<ColorRequest>(*ParseClientMessage(R"({"colors": "keep"})")).action,
            ColorAction::kKeep);
  EXPECT_EQ(std::get<ColorRequest>(*ParseClientMessage(R"({"colors": "undo"})")).action,
            ColorAction::kUndo);
}

TEST(ClientMessageTest, LimitsStrokes) {
  const auto points = [](int count) {
    std::string list = "[1";
    for (int i = 1; i < count; ++i) list += ",1";
    return list + "]";
  };
  EXPECT_TRUE(ParseClientMessage(Mark("0", "brush", "4", points(2000))));
  for (const std::string& text :
       {Mark("0", "brush", "4", points(2002)), Mark("0", "brush", "4", points(3)),
        Mark("0", "brush", "4", "[]"), Mark("0", "brush", "4", "[-1, 2]"),
        Mark("0", "brush", "4", "[1.5, 2]"), Mark("0", "brush", "4", "[1, 100001]"),
        Mark("0", "brush", "4", "7"), Mark("0", "brush", "1e9", "[1, 2]"),
        Mark("0", "brush", "null", "[1, 2]"), Mark("-1", "brush", "4", "[1, 2]"),
        Mark("1e3", "brush", "4", "[1, 2]"), Mark("9999999999", "brush", "4", "[1, 2]"),
        Mark("0", "spray", "4", "[1, 2]"), Mark("0", "rectangle", "0", "[1, 2]"),
        std::string(R"({"colors": "teach"})"), std::string(R"({"colors": "format"})"),
        std::string(R"({"colors": 1})"), std::string(R"({"colors": "save", "path": "x"})"),
        R"({"colors": "teach", "color": ")" + std::string(65, 'x') + R"("})"}) {
    EXPECT_FALSE(ParseClientMessage(text)) << text;
  }
}

TEST(ClientMessageTest, RefusesMalformedMessages) {
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
                           R"({"images": true, "hold": 1})",
                           R"({"images": true, "held": true})",
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

TEST(ClientMessageTest, RefusesDeepNestingWithoutStackOverflow) {
  EXPECT_FALSE(ParseClientMessage(std::string(1 << 20, '[')));
  std::string text = "{\"ack\":";
  text.append(10000, '[').append(10000, ']').append("}");
  EXPECT_FALSE(ParseClientMessage(text));
}

}  // namespace
}  // namespace kestrel
