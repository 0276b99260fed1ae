// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/doctor/finding.h"

#include <algorithm>
#include <cstddef>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace kestrel {
namespace {

constexpr Verdict kVerdicts[] = {Verdict::kGood, Verdict::kDoubtful, Verdict::kWrong,
                                 Verdict::kNotChecked};

const char* ColorOf(Verdict verdict) {
  switch (verdict) {
    case Verdict::kGood:
      return "\x1b[32m";
    case Verdict::kDoubtful:
      return "\x1b[33m";
    case Verdict::kWrong:
      return "\x1b[31;1m";
    case Verdict::kNotChecked:
      return "\x1b[2m";
  }
  return "";
}

auto Count(std::span<const Finding> findings, Verdict verdict) {
  return std::ranges::count(findings, verdict, &Finding::verdict);
}

nlohmann::ordered_json ToJson(const Finding& finding) {
  nlohmann::ordered_json json = {{"check", finding.check},
                                 {"verdict", ToString(finding.verdict)},
                                 {"measured", finding.measured}};
  if (!finding.advice.empty()) json["advice"] = finding.advice;
  if (finding.fix) {
    json["fix"] = {{"parameter", finding.fix->name},
                   {"value", finding.fix->value},
                   {"reboot", finding.fix->needs_reboot}};
  }
  return json;
}

}  // namespace

const char* ToString(Verdict verdict) {
  switch (verdict) {
    case Verdict::kGood:
      return "good";
    case Verdict::kDoubtful:
      return "doubtful";
    case Verdict::kWrong:
      return "wrong";
    case Verdict::kNotChecked:
      return "not checked";
  }
  return "";
}

Finding Good(std::string check, std::string measured) {
  return {std::move(check), Verdict::kGood, std::move(measured)};
}

Finding Doubtful(std::string check, std::string measured, std::string advice) {
  return {std::move(check), Verdict::kDoubtful, std::move(measured), std::move(advice)};
}

Finding Wrong(std::string check, std::string measured, std::string advice) {
  return {std::move(check), Verdict::kWrong, std::move(measured), std::move(advice)};
}

Finding NotChecked(std::string check, std::string why, std::string advice) {
  return {std::move(check), Verdict::kNotChecked, std::move(why), std::move(advice)};
}

bool AnyWrong(std::span<const Finding> findings) { return Count(findings, Verdict::kWrong) > 0; }

std::string FindingsTable(std::span<const Finding> findings, bool has_colors) {
  std::size_t widest = 0;
  for (const Finding& finding : findings) widest = std::max(widest, finding.check.size());
  std::string table;
  for (const Finding& finding : findings) {
    const char* const color = has_colors ? ColorOf(finding.verdict) : "";
    table += fmt::format("{:{}}  {}{:11}{}  {}\n", finding.check, widest, color,
                         ToString(finding.verdict), has_colors ? "\x1b[0m" : "", finding.measured);
    if (!finding.advice.empty()) {
      table += fmt::format("{:{}}               -> {}\n", "", widest, finding.advice);
    }
  }
  std::string counts;
  for (const Verdict verdict : kVerdicts) {
    counts += fmt::format("{}{} {}", counts.empty() ? "" : ", ", Count(findings, verdict),
                          ToString(verdict));
  }
  return table + counts + "\n";
}

std::string FindingsJson(std::span<const Finding> findings) {
  nlohmann::ordered_json json;
  for (const Verdict verdict : kVerdicts) json[ToString(verdict)] = Count(findings, verdict);
  json["findings"] = nlohmann::ordered_json::array();
  for (const Finding& finding : findings) json["findings"].push_back(ToJson(finding));
  constexpr int kIndent = 2;
  // Texts from the autopilot may have no valid encoding.
  return json.dump(kIndent, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

}  // namespace kestrel
