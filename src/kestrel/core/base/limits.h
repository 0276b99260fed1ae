// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <limits>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace kestrel {

// Numbers from 'low' to 'high'.
struct Range {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  bool has_low = true;  // 'low' itself is one of them
  bool has_high = true;
};
constexpr Range AtLeast(double low) { return {.low = low}; }
constexpr Range MoreThan(double low) { return {.low = low, .has_low = false}; }
constexpr Range Between(double low, double high) { return {low, high, false, false}; }

// The length of a print or an object, m: more than 0. From 'least_wrong' on it was meant in mm.
struct Metres {
  double least_wrong = 20;
};

struct OneOf {
  std::vector<std::string_view> words;
};

// The values that a field may have. NaN and infinity are beyond all limits.
using Limits = std::variant<std::monostate, Range, Metres, OneOf>;

// Returns the limits in words: "0.5 to 30", "more than 0", "png or jpg"; empty where there are
// none.
std::string ToString(const Limits& limits);

// Adds "key is 31, expected 0.5 to 30" when the value is beyond its limits.
void Require(double value, const Limits& limits, const std::string& key,
             std::vector<std::string>* violations);
void Require(const std::string& word, const Limits& limits, const std::string& key,
             std::vector<std::string>* violations);

// Adds the violations of a part, each with the part's name before it.
void AddViolations(const std::string& part, const std::vector<std::string>& of_part,
                   std::vector<std::string>* violations);

}  // namespace kestrel
