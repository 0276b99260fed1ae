// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace kestrel {

enum class Verdict { kGood, kDoubtful, kWrong, kNotChecked };
const char* ToString(Verdict verdict);  // "good", "doubtful", "wrong", "not checked"

// A parameter of the autopilot as it should be.
struct ParameterFix {
  std::string name;  // the first of its names, in whose unit the value is
  double value = 0;
  bool needs_reboot = false;
};

// What a check came to.
struct Finding {
  std::string check;                               // its name, as "frame rate"
  Verdict verdict = Verdict::kNotChecked;          //
  std::string measured;                            // what was seen, or why nothing was
  std::string advice = {};                         // what to do; empty where all is well
  std::optional<ParameterFix> fix = std::nullopt;  // that would make it good
};

Finding Good(std::string check, std::string measured);
Finding Doubtful(std::string check, std::string measured, std::string advice);
Finding Wrong(std::string check, std::string measured, std::string advice);
// 'advice': how it can be checked.
Finding NotChecked(std::string check, std::string why, std::string advice = {});

// Whether any of them is wrong.
bool AnyWrong(std::span<const Finding> findings);

// A table for people, one line for each finding and one for each advice, and a count at the end.
// 'has_colors': for a terminal.
std::string FindingsTable(std::span<const Finding> findings, bool has_colors);

// {"wrong": 1, "doubtful": 0, ..., "findings": [{"check", "verdict", "measured", "advice", "fix":
// {"parameter", "value", "reboot"}}]}; advice and fix only where there are any.
std::string FindingsJson(std::span<const Finding> findings);

}  // namespace kestrel
