// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/core/base/limits.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace kestrel {
namespace {

struct ToWords {
  std::string operator()(std::monostate) const { return ""; }
  std::string operator()(const Metres&) const { return "more than 0"; }
  std::string operator()(const Range& range) const {
    if (!std::isfinite(range.high)) {
      return range.has_low ? fmt::format("{} or more", range.low)
                           : fmt::format("more than {}", range.low);
    }
    return fmt::format("{}{} to {}{}", range.has_low ? "" : "more than ", range.low,
                       range.has_high ? "" : "less than ", range.high);
  }
  std::string operator()(const OneOf& choice) const {
    const auto& words = choice.words;
    return fmt::format("{} or {}", fmt::join(words.begin(), words.end() - 1, ", "), words.back());
  }
};

bool Contains(const Range& range, double value) {
  return (range.has_low ? value >= range.low : value > range.low) &&
         (range.has_high ? value <= range.high : value < range.high);
}

}  // namespace

std::string ToString(const Limits& limits) { return std::visit(ToWords(), limits); }

void Require(double value, const Limits& limits, const std::string& key,
             std::vector<std::string>* violations) {
  constexpr double kMillimetre = 0.001;
  const auto* metres = std::get_if<Metres>(&limits);
  const auto* range = std::get_if<Range>(&limits);
  std::string expected;
  if (metres && value >= metres->least_wrong && std::isfinite(value)) {
    expected = fmt::format("metres: {:g}?", kMillimetre * value);
  } else if (!std::isfinite(value) || (metres && value <= 0) ||
             (range && !Contains(*range, value))) {
    expected = metres || range ? ToString(limits) : "a finite number";
  }
  if (!expected.empty()) {
    violations->push_back(fmt::format("{} is {}, expected {}", key, value, expected));
  }
}

void Require(const std::string& word, const Limits& limits, const std::string& key,
             std::vector<std::string>* violations) {
  const auto* choice = std::get_if<OneOf>(&limits);
  if (!choice || std::ranges::find(choice->words, word) != choice->words.end()) return;
  violations->push_back(fmt::format("{} is '{}', expected {}", key, word, ToString(limits)));
}

void AddViolations(const std::string& part, const std::vector<std::string>& of_part,
                   std::vector<std::string>* violations) {
  for (const std::string& violation : of_part) {
    violations->push_back(fmt::format("{}.{}", part, violation));
  }
}

}  // namespace kestrel
