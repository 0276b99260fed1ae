// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/calibration/color_training/color_draft.h"

#include <array>
#include <cmath>

#include <fmt/format.h>

#include "kestrel/core/base/error.h"
#include "kestrel/core/base/yaml_reader.h"

namespace kestrel {
namespace {

constexpr std::array kTools = {StrokeTool::kBrush, StrokeTool::kRectangle, StrokeTool::kGrow};

StrokeTool ParseTool(const YamlReader& reader) {
  const std::string name = reader.Text();
  for (const StrokeTool tool : kTools) {
    if (name == ToString(tool)) return tool;
  }
  reader.Fail(fmt::format("'{}' is no tool, expected brush, rectangle or grow", name));
}

int ParsePixel(double number, const YamlReader& reader) {
  constexpr double kMaxPixel = 1e6;
  if (!(number >= 0 && number <= kMaxPixel && number == std::floor(number))) {
    reader.Fail("expected whole numbers of pixels, [u, v]");
  }
  return static_cast<int>(number);
}

ColorStroke ParseStroke(const YamlReader& item) {
  item.RequireKeys({"frame", "color", "tool", "size", "points"});
  ColorStroke stroke;
  const std::int64_t frame = item["frame"].Integer();
  if (frame < 0) item["frame"].Fail("a frame's number must not be negative");
  stroke.frame = static_cast<std::size_t>(frame);
  if (item.Has("color")) stroke.color = item["color"].Text();
  stroke.tool = ParseTool(item["tool"]);
  if (item.Has("size")) stroke.size = item["size"].Number();
  for (const YamlReader& point : item["points"].Items()) {
    const std::vector<double> numbers = point.Numbers(2);
    stroke.points.emplace_back(ParsePixel(numbers[0], point), ParsePixel(numbers[1], point));
  }
  return stroke;
}

// Returns any text as a YAML scalar.
std::string Quoted(const std::string& text) {
  std::string quoted = "'";
  for (const char c : text) quoted += c == '\'' ? "''" : std::string(1, c);
  return quoted + "'";
}

std::string Print(const ColorStroke& stroke) {
  std::string points;
  for (const cv::Point& point : stroke.points) {
    points += fmt::format("{}[{}, {}]", points.empty() ? "" : ", ", point.x, point.y);
  }
  const std::string color =
      stroke.color.empty() ? "" : fmt::format("color: {}, ", Quoted(stroke.color));
  return fmt::format("  - {{frame: {}, {}tool: {}, size: {}, points: [{}]}}\n", stroke.frame, color,
                     ToString(stroke.tool), stroke.size, points);
}

}  // namespace

void ColorDraft::Add(const ColorStroke& stroke) {
  const std::vector<std::string> violations = stroke.Validate();
  if (!violations.empty()) {
    throw InputError(
        fmt::format("a stroke on frame {}: {}", stroke.frame, fmt::join(violations, "; ")));
  }
  if (count_ >= kMaxStrokes) {
    throw InputError(fmt::format("there are {} strokes, at most as many", kMaxStrokes));
  }
  strokes_.resize(count_);
  strokes_.push_back(stroke);
  ++count_;
}

bool ColorDraft::Undo() {
  if (count_ == 0) return false;
  --count_;
  return true;
}

bool ColorDraft::Redo() {
  if (!can_redo()) return false;
  ++count_;
  return true;
}

std::string PrintColorDraft(const ColorDraft& draft, const std::string& recording) {
  std::string text = fmt::format("recording: {}\nstrokes:{}\n", Quoted(recording),
                                 draft.strokes().empty() ? " []" : "");
  for (const ColorStroke& stroke : draft.strokes()) text += Print(stroke);
  return text;
}

ColorDraft ParseColorDraft(const std::string& yaml, const std::string& recording,
                           const std::string& file) {
  const YamlReader root(yaml, file);
  root.RequireKeys({"recording", "strokes"});
  const std::string of = root["recording"].Text();
  if (of != recording) {
    root["recording"].Fail(fmt::format("is a draft of '{}', expected '{}'", of, recording));
  }
  ColorDraft draft;
  for (const YamlReader& item : root["strokes"].Items()) {
    const ColorStroke stroke = ParseStroke(item);
    try {
      draft.Add(stroke);
    } catch (const InputError& error) {
      item.Fail(error.what());
    }
  }
  return draft;
}

}  // namespace kestrel
