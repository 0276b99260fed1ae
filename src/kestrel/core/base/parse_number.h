// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <charconv>
#include <cmath>
#include <concepts>
#include <limits>
#include <optional>
#include <string>
#include <string_view>

namespace kestrel {

// Parses 'text' as a single number. Blanks around it and a plus before it are ignored, and the
// locale has no effect. Returns nothing when there is any other text, when the number does not fit
// into Number, or when it is NaN or infinite.
template <class Number>
std::optional<Number> ParseNumber(std::string_view text) {
  constexpr std::string_view kBlanks = " \t\r";
  const std::size_t first = text.find_first_not_of(kBlanks);
  if (first == std::string_view::npos) return std::nullopt;
  text = text.substr(first, text.find_last_not_of(kBlanks) - first + 1);
  if (text.size() > 1 && text[0] == '+' && text[1] != '-') text.remove_prefix(1);
  Number number{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  if constexpr (std::floating_point<Number>) {
    if (!std::isfinite(number)) return std::nullopt;
  }
  return number;
}

// Parses a whole number that may be written as one with a fraction of zero: "320.0", as programs
// write that keep all their numbers as floating-point ones.
template <std::integral Number>
std::optional<Number> ParseWhole(std::string_view text) {
  if (const std::optional<Number> number = ParseNumber<Number>(text)) return number;
  constexpr double kExact = 1LL << std::min(53, std::numeric_limits<Number>::digits);
  const std::optional<double> number = ParseNumber<double>(text);
  if (!number || *number != std::floor(*number) || std::abs(*number) >= kExact) return std::nullopt;
  return static_cast<Number>(*number);
}

// Returns advice that follows "expected a number": for "8,5" that 8.5 is meant, else nothing.
inline std::string DecimalCommaAdvice(std::string text) {
  const std::size_t comma = text.find(',');
  if (comma == std::string::npos) return "";
  text[comma] = '.';
  return ParseNumber<double>(text) ? ": write " + text : "";
}

}  // namespace kestrel
