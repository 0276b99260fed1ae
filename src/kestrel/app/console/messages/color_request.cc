// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/console/messages/color_request.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include <nlohmann/json.hpp>

namespace kestrel {
namespace {

using Json = nlohmann::json;

constexpr std::array kActions = {ColorAction::kChoose, ColorAction::kMark,  ColorAction::kUndo,
                                 ColorAction::kRedo,   ColorAction::kTeach, ColorAction::kRevert,
                                 ColorAction::kSave,   ColorAction::kKeep};
constexpr std::array kTools = {StrokeTool::kBrush, StrokeTool::kRectangle, StrokeTool::kGrow};

// Finds one of the values by its name in the message.
template <class Value, std::size_t kCount>
std::optional<Value> Named(const Json& message, const char* key,
                           const std::array<Value, kCount>& values) {
  const auto name = message.find(key);
  if (name == message.end() || !name->is_string()) return std::nullopt;
  for (const Value value : values) {
    if (name->template get_ref<const std::string&>() == ToString(value)) return value;
  }
  return std::nullopt;
}

std::optional<std::string> ReadColor(const Json& message) {
  constexpr std::size_t kMaxBytes = 64;
  const auto color = message.find("color");
  if (color == message.end() || !color->is_string()) return std::nullopt;
  auto name = color->get<std::string>();
  if (name.size() > kMaxBytes) return std::nullopt;
  return name;
}

// The numbers are u and v in turn.
bool ReadPoints(const Json& message, std::vector<cv::Point>* points) {
  constexpr std::size_t kMaxNumbers = 2000;
  constexpr std::uint64_t kMaxPixel = 100'000;
  const auto list = message.find("points");
  if (list == message.end() || !list->is_array()) return false;
  if (list->size() % 2 != 0 || list->size() > kMaxNumbers) return false;
  const auto is_pixel = [](const Json& number) {
    return number.is_number_unsigned() && number.get<std::uint64_t>() <= kMaxPixel;
  };
  for (std::size_t i = 0; i < list->size(); i += 2) {
    const Json& u = (*list)[i];
    const Json& v = (*list)[i + 1];
    if (!is_pixel(u) || !is_pixel(v)) return false;
    points->emplace_back(u.get<int>(), v.get<int>());
  }
  return true;
}

std::optional<ColorStroke> ReadStroke(const Json& message) {
  constexpr std::uint64_t kMaxFrame = 1'000'000'000;
  constexpr std::size_t kKeys = 6;
  const auto frame = message.find("frame");
  const auto size = message.find("size");
  const auto color = ReadColor(message);
  const auto tool = Named(message, "tool", kTools);
  if (!color || !tool || message.size() != kKeys || frame == message.end() ||
      size == message.end()) {
    return std::nullopt;
  }
  if (!frame->is_number_unsigned() || frame->get<std::uint64_t>() > kMaxFrame) return std::nullopt;
  if (!size->is_number()) return std::nullopt;
  ColorStroke stroke{frame->get<std::size_t>(), *color, *tool, size->get<double>(), {}};
  if (!ReadPoints(message, &stroke.points) || !stroke.Validate().empty()) return std::nullopt;
  return stroke;
}

}  // namespace

const char* ToString(ColorAction action) {
  switch (action) {
    case ColorAction::kChoose:
      return "choose";
    case ColorAction::kMark:
      return "mark";
    case ColorAction::kUndo:
      return "undo";
    case ColorAction::kRedo:
      return "redo";
    case ColorAction::kTeach:
      return "teach";
    case ColorAction::kRevert:
      return "revert";
    case ColorAction::kSave:
      return "save";
    case ColorAction::kKeep:
      return "keep";
  }
  return "";
}

std::optional<ColorRequest> ReadColorRequest(const Json& message) {
  const auto action = Named(message, "colors", kActions);
  if (!action) return std::nullopt;
  ColorRequest request{*action};
  if (*action == ColorAction::kMark) {
    auto stroke = ReadStroke(message);
    if (!stroke) return std::nullopt;
    request.stroke = *std::move(stroke);
    return request;
  }
  const bool has_color = *action == ColorAction::kChoose || *action == ColorAction::kTeach;
  if (message.size() != (has_color ? 2U : 1U)) return std::nullopt;
  if (!has_color) return request;
  auto color = ReadColor(message);
  if (!color) return std::nullopt;
  request.color = *std::move(color);
  return request;
}

}  // namespace kestrel
