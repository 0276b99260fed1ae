// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace kestrel {

enum class Verdict { kGood, kDoubtful, kWrong, kNotChecked };
const char* ToString(Verdict verdict);  // "good", "doubtful", "wrong", "not checked"

// The value that a parameter of the autopilot should have.
struct ParameterFix {
  std::string name;  // its first name; the value is in that name's unit
  double value = 0;
  bool needs_reboot = false;
};

// Result of a check.
struct Finding {
  std::string check;                               // name of the check, as "frame rate"
  Verdict verdict = Verdict::kNotChecked;          //
  std::string measured;                            // what was measured, or why nothing was
  std::string advice = {};                         // what to do; empty where all is well
  std::optional<ParameterFix> fix = std::nullopt;  // setting that would make it good
};

Finding Good(std::string check, std::string measured);
Finding Doubtful(std::string check, std::string measured, std::string advice);
Finding Wrong(std::string check, std::string measured, std::string advice);
// 'advice': how to make the check possible.
Finding NotChecked(std::string check, std::string why, std::string advice = {});

// True when any of them is wrong.
bool AnyWrong(std::span<const Finding> findings);

// Returns a table for people: one line for each finding, one for each advice, and a count at the
// end. 'has_colors': with colours, for a terminal.
std::string FindingsTable(std::span<const Finding> findings, bool has_colors);

// {"wrong": 1, "doubtful": 0, ..., "findings": [{"check", "verdict", "measured", "advice", "fix":
// {"parameter", "value", "reboot"}}]}; advice and fix only where there are any.
std::string FindingsJson(std::span<const Finding> findings);

}  // namespace kestrel
