// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/console/study/study_results.h"

#include <algorithm>
#include <filesystem>
#include <map>
#include <sqlite3.h>
#include <tuple>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "kestrel/app/console/study/study_judgement.h"
#include "kestrel/core/base/error.h"
#include "kestrel/core/base/shown.h"

namespace kestrel {
namespace {

constexpr int kMaxVariants = 200;
constexpr int kMaxTextBytes = 1 << 20;   // all options take 40 kB
constexpr std::size_t kMaxReason = 300;  // characters on the page
constexpr int kBusyTimeout_ms = 2000;    // a study commits in less

constexpr char kUnits[] = R"(
SELECT recording, piece, path, unit.key, state, reason, unit.frames, bin.frames, found,
  bin."false", coalesce(truth.value, 1)
FROM unit LEFT JOIN bin ON bin.key = unit.key AND quantity = 'all'
  LEFT JOIN summary AS truth ON truth.key = unit.key AND truth.name = 'has_truth'
WHERE configuration = ?1 AND version = ?2 AND task = ?3 AND state IN ('done', 'failed'))";

constexpr char kVariants[] = R"(
SELECT configuration, unit.version, unit.task
FROM unit LEFT JOIN configuration AS plan
  ON name = configuration AND plan.version = unit.version AND plan.task = unit.task
WHERE state IN ('done', 'failed') GROUP BY 1, 2, 3
ORDER BY min(place) IS NULL, min(place), 1, 2, 3)";

constexpr char kOptions[] =
    "SELECT arguments, text FROM configuration WHERE name = ?1 AND version = ?2 AND task = ?3";

// A frame that is in the table of one of the two only had nothing to find for the other.
constexpr char kLosses[] = R"(
SELECT time_ns,
  sum((found - detection."false") * CASE key WHEN ?1 THEN 1 ELSE -1 END) AS loss,
  max(coalesce(error_m, 0)) - min(coalesce(error_m, 0)) AS difference
FROM detection WHERE key IN (?1, ?2) GROUP BY time_ns
HAVING loss != 0 OR difference > 0
ORDER BY max(loss, 0) DESC, abs(loss) DESC, CASE loss WHEN 0 THEN difference END DESC, time_ns
LIMIT 1)";

constexpr char kWorst[] =
    "SELECT time_ns FROM worst WHERE key IN (?1, ?2) ORDER BY rank, key = ?1 LIMIT 1";

constexpr char kFirst[] =
    "SELECT time_ns FROM detection WHERE key IN (?1, ?2) ORDER BY time_ns LIMIT 1";

std::string TextAt(sqlite3_stmt* statement, int column) {
  const unsigned char* text = sqlite3_column_text(statement, column);
  return text == nullptr ? "" : reinterpret_cast<const char*>(text);
}

bool IsNull(sqlite3_stmt* statement, int column) {
  return sqlite3_column_type(statement, column) == SQLITE_NULL;
}

// The order in the table: 0 failed with the second only, 1 compared, 2 not comparable.
std::pair<int, double> OrderOf(const StudyRow& row) {
  const bool fails_now = !row.after.failure.empty() && row.before.found.has_value();
  if (fails_now) return {0, 0};
  const auto change = row.Change();
  return change ? std::pair(1, *change) : std::pair(2, 0.0);
}

auto NameOf(const StudyRow& row) { return std::tie(row.recording, row.piece); }

bool IsWorse(const StudyRow& a, const StudyRow& b) {
  const auto order_a = OrderOf(a), order_b = OrderOf(b);
  return order_a != order_b ? order_a < order_b : NameOf(a) < NameOf(b);
}

std::string JudgementOf(const std::vector<StudyRow>& rows) {
  std::map<std::string, std::int64_t> changes;  // by recording, summed over its pieces
  for (const StudyRow& row : rows) {
    if (!row.before.IsDone() || !row.after.IsDone()) continue;
    changes[row.recording] += row.after.found_count - row.before.found_count;
  }
  std::vector<std::int64_t> all;
  for (const auto& [recording, change] : changes) all.push_back(change);
  return StudyJudgement(all);
}

std::string DatabaseIn(const std::string& folder) {
  return (std::filesystem::path(folder) / "study.db").string();
}

}  // namespace

bool StudyResults::IsIn(const std::string& folder) {
  std::error_code ignored;
  return std::filesystem::is_regular_file(DatabaseIn(folder), ignored);
}

StudyResults::StudyResults(const std::string& folder) : file_(DatabaseIn(folder)) {
  sqlite3* database = nullptr;
  const int status = sqlite3_open_v2(file_.c_str(), &database, SQLITE_OPEN_READONLY, nullptr);
  database_.reset(database);
  if (status != SQLITE_OK) Fail(sqlite3_errmsg(database));
  // The file may come from anybody: its schema must not run functions.
  sqlite3_db_config(database, SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0, nullptr);
  sqlite3_limit(database, SQLITE_LIMIT_LENGTH, kMaxTextBytes);
  sqlite3_busy_timeout(database, kBusyTimeout_ms);
  RequireTables();
}

void StudyResults::Fail(const std::string& why) const {
  throw InputError(
      fmt::format("{}: not the results of a study: {}", file_, Shown(why, kMaxReason)));
}

void StudyResults::RequireTables() const {
  for (const char* name : {"unit", "bin", "summary", "worst", "detection", "configuration"}) {
    // A view of this name could take for ever.
    const SqliteStatement table =
        Prepare("SELECT 1 FROM sqlite_master WHERE type = 'table' AND name = ?1", {name});
    if (!Step(table.get())) Fail(fmt::format("has no table '{}'", name));
  }
}

SqliteStatement StudyResults::Prepare(const std::string& sql,
                                      const std::vector<std::string>& values) const {
  sqlite3_stmt* made = nullptr;
  const int status = sqlite3_prepare_v2(database_.get(), sql.c_str(), -1, &made, nullptr);
  SqliteStatement statement(made);
  if (status != SQLITE_OK) Fail(sqlite3_errmsg(database_.get()));
  for (std::size_t i = 0; i < values.size(); ++i) {
    sqlite3_bind_text(made, static_cast<int>(i) + 1, values[i].data(),
                      static_cast<int>(values[i].size()), SQLITE_TRANSIENT);
  }
  return statement;
}

bool StudyResults::Step(sqlite3_stmt* statement) const {
  const int status = sqlite3_step(statement);
  if (status != SQLITE_ROW && status != SQLITE_DONE) Fail(sqlite3_errmsg(database_.get()));
  return status == SQLITE_ROW;
}

std::vector<StudyVariant> StudyResults::Variants() const {
  const SqliteStatement variant = Prepare(kVariants, {});
  std::vector<StudyVariant> variants;
  while (Step(variant.get())) {
    variants.push_back(
        {TextAt(variant.get(), 0), TextAt(variant.get(), 1), TextAt(variant.get(), 2)});
    if (variants.size() > kMaxVariants) {
      Fail(fmt::format("has more than {} configurations", kMaxVariants));
    }
  }
  if (variants.empty()) {
    throw InputError(file_ + ": has no results yet; `kestrel study run` makes them");
  }
  return variants;
}

StudyOptions StudyResults::OptionsOf(const StudyVariant& variant) const {
  const SqliteStatement row =
      Prepare(kOptions, {variant.configuration, variant.version, variant.task});
  if (!Step(row.get())) {
    Fail(fmt::format("has no options of '{}'", Shown(variant.configuration)));
  }
  StudyOptions options{{}, TextAt(row.get(), 1)};
  try {
    nlohmann::json::parse(TextAt(row.get(), 0)).get_to(options.arguments);
  } catch (const nlohmann::json::exception&) {
    Fail(
        fmt::format("the arguments of '{}' are not a list of words", Shown(variant.configuration)));
  }
  return options;
}

StudyOutcome StudyResults::OutcomeOf(sqlite3_stmt* unit) const {
  StudyOutcome outcome{.key = TextAt(unit, 3), .frames = sqlite3_column_int64(unit, 6)};
  if (TextAt(unit, 4) == "failed") {
    outcome.failure = Shown(TextAt(unit, 5), kMaxReason);
    if (outcome.failure.empty()) outcome.failure = "no reason was given";
    return outcome;
  }
  const auto requested = sqlite3_column_int64(unit, 7), found = sqlite3_column_int64(unit, 8);
  if (found < 0 || found > std::max<std::int64_t>(requested, 0)) {
    Fail(fmt::format("the unit {} has found {} of {}", Shown(outcome.key), found, requested));
  }
  if (!IsNull(unit, 9)) outcome.false_count = sqlite3_column_int64(unit, 9);
  outcome.found_count = found;
  if (requested > 0) {
    const auto count = static_cast<double>(requested);
    outcome.found = static_cast<double>(found) / count;
    outcome.false_found = static_cast<double>(outcome.false_count.value_or(0)) / count;
  }
  outcome.is_estimated = sqlite3_column_double(unit, 10) == 0;
  return outcome;
}

std::vector<StudyRow> StudyResults::Units(const StudyVariant& variant) const {
  const SqliteStatement unit =
      Prepare(kUnits, {variant.configuration, variant.version, variant.task});
  std::vector<StudyRow> rows;
  while (Step(unit.get())) {
    StudyRow& row = rows.emplace_back();
    row.recording = TextAt(unit.get(), 0);
    row.piece = sqlite3_column_int64(unit.get(), 1);
    row.path = TextAt(unit.get(), 2);
    row.before = OutcomeOf(unit.get());
  }
  return rows;
}

StudyComparison StudyResults::Compare(const StudyVariant& before, const StudyVariant& after) const {
  std::map<std::pair<std::string, std::int64_t>, StudyRow> rows;
  for (StudyRow& unit : Units(before)) rows[{unit.recording, unit.piece}] = std::move(unit);
  for (StudyRow& unit : Units(after)) {
    StudyRow& row = rows[{unit.recording, unit.piece}];
    row.after = std::move(unit.before);
    std::tie(row.recording, row.piece, row.path) = std::tie(unit.recording, unit.piece, unit.path);
  }
  StudyComparison comparison{{}, rows.size()};
  for (auto& [name, row] : rows) comparison.rows.push_back(std::move(row));
  if (before != after) comparison.judgement = JudgementOf(comparison.rows);
  std::sort(comparison.rows.begin(), comparison.rows.end(), IsWorse);
  if (comparison.rows.size() > kMaxRows) comparison.rows.resize(kMaxRows);
  for (StudyRow& row : comparison.rows) {
    row.before.error_m = MedianError(row.before.key);
    row.after.error_m = MedianError(row.after.key);
  }
  return comparison;
}

std::optional<double> StudyResults::MedianError(const std::string& key) const {
  const SqliteStatement error = Prepare(
      "SELECT error_m FROM detection WHERE key = ?1 AND error_m IS NOT NULL ORDER BY error_m",
      {key});
  std::vector<double> errors;
  while (Step(error.get())) errors.push_back(sqlite3_column_double(error.get(), 0));
  if (errors.empty()) return std::nullopt;
  return (errors[(errors.size() - 1) / 2] + errors[errors.size() / 2]) / 2;
}

std::optional<Time> StudyResults::TimeOf(const std::string& sql,
                                         const std::vector<std::string>& keys) const {
  const SqliteStatement frame = Prepare(sql, keys);
  if (!Step(frame.get())) return std::nullopt;
  return TimeFromNanoseconds(sqlite3_column_int64(frame.get(), 0));
}

std::optional<Time> StudyResults::WorstFrame(const StudyRow& row) const {
  const std::vector<std::string> keys = {row.before.key, row.after.key};
  for (const char* sql : {kLosses, kWorst, kFirst}) {
    if (const auto time = TimeOf(sql, keys)) return time;
  }
  return std::nullopt;
}

}  // namespace kestrel
