// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/console/messages/study_json.h"

#include <optional>
#include <utility>

#include <nlohmann/json.hpp>

namespace kestrel {
namespace {

template <class Value>
nlohmann::json OrNull(const std::optional<Value>& value) {
  return value ? nlohmann::json(*value) : nlohmann::json();
}

nlohmann::json OutcomeJson(const StudyOutcome& outcome) {
  return {{"done", !outcome.key.empty()},       {"failure", outcome.failure},
          {"found", OrNull(outcome.found)},     {"false", OrNull(outcome.false_count)},
          {"error_m", OrNull(outcome.error_m)}, {"estimated", outcome.is_estimated}};
}

}  // namespace

nlohmann::json Message(const ConsoleStudy& study) {
  nlohmann::json rows = nlohmann::json::array();
  for (const StudyRow& row : study.comparison.rows) {
    rows.push_back({{"recording", row.recording},
                    {"piece", row.piece},
                    {"before", OutcomeJson(row.before)},
                    {"after", OutcomeJson(row.after)},
                    {"change", OrNull(row.Change())}});
  }
  return {{"kind", "study"},
          {"variants", study.variants},
          {"before", study.before},
          {"after", study.after},
          {"rows", std::move(rows)},
          {"total", study.comparison.total},
          {"judgement", study.comparison.judgement},
          {"remark", study.remark},
          {"error", study.error}};
}

nlohmann::json Message(const ConsoleStudyReplay& replay) {
  static constexpr const char* kStates[] = {"none", "running", "open", "cancelled", "failed"};
  return {{"kind", "study-replay"},        {"state", kStates[static_cast<int>(replay.state)]},
          {"recording", replay.recording}, {"before", replay.before},
          {"after", replay.after},         {"done", replay.done},
          {"frames", replay.frames},       {"error", replay.error}};
}

}  // namespace kestrel
