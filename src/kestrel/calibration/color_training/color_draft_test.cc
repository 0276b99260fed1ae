// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/calibration/color_training/color_draft.h"

#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kestrel/core/base/error.h"

namespace kestrel {
namespace {

using ::testing::HasSubstr;

ColorStroke Brush(std::size_t frame, const std::string& color) {
  return {frame, color, StrokeTool::kBrush, 2.5, {{3, 4}, {5, 6}}};
}

std::string ErrorOf(const std::string& yaml) {
  try {
    ParseColorDraft(yaml, "flight", "draft.yaml");
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(ColorDraft, UndoesAndRedoes) {
  ColorDraft draft;
  EXPECT_FALSE(draft.Undo());
  draft.Add(Brush(0, "red"));
  draft.Add(Brush(1, "red"));
  EXPECT_TRUE(draft.Undo());
  EXPECT_EQ(draft.strokes().size(), 1U);
  EXPECT_TRUE(draft.Redo());
  EXPECT_FALSE(draft.Redo());
  EXPECT_EQ(draft.strokes().back().frame, 1U);
  draft.Undo();
  draft.Add(Brush(2, "red"));
  EXPECT_FALSE(draft.Redo()) << "what was undone is gone";
  EXPECT_EQ(draft.strokes().back().frame, 2U);
}

TEST(ColorDraft, LimitsStrokes) {
  ColorDraft draft;
  for (std::size_t i = 0; i < ColorDraft::kMaxStrokes; ++i) draft.Add(Brush(i, "red"));
  EXPECT_THROW(draft.Add(Brush(0, "red")), InputError);
  EXPECT_EQ(draft.strokes().size(), ColorDraft::kMaxStrokes);
  EXPECT_THROW(ColorDraft().Add({0, "red", StrokeTool::kBrush, 0, {}}), InputError);
}

TEST(ParseColorDraft, RoundTripsThroughText) {
  ColorDraft draft;
  draft.Add(Brush(0, "red: 'it''s' #1"));
  draft.Add({3, "", StrokeTool::kRectangle, 0, {{1, 2}, {30, 40}}});
  draft.Add({3, "blue", StrokeTool::kGrow, 12, {{7, 8}}});
  draft.Add(Brush(9, "undone"));
  draft.Undo();
  const ColorDraft again =
      ParseColorDraft(PrintColorDraft(draft, "flight"), "flight", "draft.yaml");
  EXPECT_TRUE(std::ranges::equal(again.strokes(), draft.strokes()));
  EXPECT_FALSE(again.can_redo());
  EXPECT_EQ(ErrorOf(PrintColorDraft({}, "flight")), "");
}

TEST(ParseColorDraft, NamesFileLineAndKey) {
  const auto with = [](const std::string& stroke) {
    return ErrorOf("recording: flight\nstrokes:\n  - {" + stroke + "}\n");
  };
  EXPECT_EQ(with("frame: 1, tool: grow, size: 9, points: [[1, 2]]"), "");
  EXPECT_THAT(with("frame: 1, tool: pen, points: [[1, 2]]"),
              HasSubstr("draft.yaml:3: strokes[0].tool: 'pen' is no tool"));
  EXPECT_THAT(with("frame: -1, tool: grow, size: 9, points: [[1, 2]]"),
              HasSubstr("must not be negative"));
  EXPECT_THAT(with("frame: 1, tool: grow, size: 9, points: [[1, 2.5]]"),
              HasSubstr("whole numbers of pixels"));
  EXPECT_THAT(with("frame: 1, tool: grow, size: 900, points: [[1, 2]]"), HasSubstr("1 to 100"));
  EXPECT_THAT(with("frame: 1, tol: grow, size: 9, points: [[1, 2]]"), HasSubstr("unknown key"));
  EXPECT_THAT(ErrorOf("recording: other\nstrokes: []\n"),
              HasSubstr("is a draft of 'other', expected 'flight'"));
}

}  // namespace
}  // namespace kestrel
