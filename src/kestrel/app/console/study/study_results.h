// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "kestrel/app/console/messages/study_state.h"
#include "kestrel/core/base/time.h"
#include "kestrel/io/bags/sqlite_handles.h"

namespace kestrel {

// A configuration, run by a version of the program: a study compares several.
struct StudyVariant {
  std::string configuration;
  std::string version;
  std::string task;  // as "land"

  bool operator==(const StudyVariant&) const = default;
};

// The options with which a variant was run.
struct StudyOptions {
  std::vector<std::string> arguments;  // arguments of the command, as {"--altitude", "3"}
  std::string text;                    // every option, as YAML
};

// The results of `kestrel study run` in a folder: its file study.db, which a study may be writing.
// All functions throw InputError when it cannot be read or is not the file of a study.
class StudyResults {
 public:
  // The most rows of a comparison.
  static constexpr std::size_t kMaxRows = 1000;

  explicit StudyResults(const std::string& folder);

  // True for a folder that has the results of a study.
  static bool IsIn(const std::string& folder);

  // Returns what was run, in the order of the study's plan; at least one.
  std::vector<StudyVariant> Variants() const;

  StudyOptions OptionsOf(const StudyVariant& variant) const;

  StudyComparison Compare(const StudyVariant& before, const StudyVariant& after) const;

  // Returns the time of the first frame in which the second outcome is worst against the first:
  // found less or more that is false; else of the frame in which they differ most; else of the
  // worst frame of either; else of the first. Nothing when no frame is known.
  std::optional<Time> WorstFrame(const StudyRow& row) const;

 private:
  SqliteStatement Prepare(const std::string& sql, const std::vector<std::string>& values) const;
  bool Step(sqlite3_stmt* statement) const;
  [[noreturn]] void Fail(const std::string& why) const;
  void RequireTables() const;
  std::vector<StudyRow> Units(const StudyVariant& variant) const;
  StudyOutcome OutcomeOf(sqlite3_stmt* unit) const;
  std::optional<double> MedianError(const std::string& key) const;
  std::optional<Time> TimeOf(const std::string& sql, const std::vector<std::string>& keys) const;

  std::string file_;
  SqliteDatabase database_;
};

}  // namespace kestrel
