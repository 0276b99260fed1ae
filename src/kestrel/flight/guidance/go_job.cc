// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/guidance/go_job.h"

#include <algorithm>
#include <iterator>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "kestrel/core/base/error.h"
#include "kestrel/core/base/parse_number.h"

namespace kestrel {
namespace {

constexpr double kLeastHeight_m = 0, kMostHeight_m = 50;
constexpr double kLongestJob_s = 3600;

constexpr std::pair<std::string_view, GoJob> kUsual[] = {
    {"hover", {.action = GoAction::kHover, .height_m = 2.5, .seconds = 10}},
    {"look", {.action = GoAction::kLook, .height_m = 2.5, .seconds = 5}},
    {"drop", {.action = GoAction::kDrop, .height_m = 0.5, .seconds = 1}},
    {"pick", {.action = GoAction::kPick, .height_m = 0.05, .seconds = 1}},
};

// Takes the text up to the next comma.
std::string_view TakePart(std::string_view* text) {
  const std::size_t comma = text->find(',');
  const std::string_view part = text->substr(0, comma);
  text->remove_prefix(comma == std::string_view::npos ? text->size() : comma + 1);
  return part;
}

// False when there is a part that is no number from 'least' to 'most'.
bool ReadPart(std::string_view* text, double least, double most, double* value) {
  if (text->empty()) return true;
  const auto number = ParseNumber<double>(TakePart(text));
  if (!number || !(*number >= least && *number <= most)) return false;
  *value = *number;
  return true;
}

}  // namespace

GoJob ParseGoJob(std::string_view text) {
  std::string_view rest = text;
  const std::string_view action = TakePart(&rest);
  const auto usual = std::find_if(std::begin(kUsual), std::end(kUsual),
                                  [&](const auto& one) { return one.first == action; });
  if (usual != std::end(kUsual)) {
    GoJob job = usual->second;
    const bool is_read = ReadPart(&rest, kLeastHeight_m, kMostHeight_m, &job.height_m) &&
                         ReadPart(&rest, 0, kLongestJob_s, &job.seconds);
    if (is_read && rest.empty()) return job;
  }
  throw InputError(fmt::format(
      "--then '{}': expected hover, look, drop or pick, with a height ({:g} to {:g} m) and a "
      "time ({:g} s at most) if they are not the usual ones, as hover,3,20",
      text, kLeastHeight_m, kMostHeight_m, kLongestJob_s));
}

}  // namespace kestrel
