// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <sqlite3.h>
#include <stdexcept>
#include <string>

#include <fmt/format.h>

#include "kestrel/core/base/test_folder.h"
#include "kestrel/io/bags/sqlite_handles.h"

namespace kestrel {

// The results of a small study of two configurations, "usual" and "strict", as `kestrel study run`
// writes them: study.db.
class TestStudy {
 public:
  explicit TestStudy(const TestFolder& folder) : path_(folder / "study") {
    std::filesystem::create_directories(path_);
    sqlite3* database = nullptr;
    sqlite3_open((path_ + "/study.db").c_str(), &database);
    database_.reset(database);
    Run(R"(
PRAGMA synchronous = OFF;
CREATE TABLE unit(key TEXT PRIMARY KEY, recording TEXT, piece INTEGER, configuration TEXT,
  version TEXT, task TEXT, seed INTEGER, state TEXT, reason TEXT, frames INTEGER, path TEXT);
CREATE TABLE bin(key TEXT, quantity TEXT, lower REAL, upper REAL, frames INTEGER, found INTEGER,
  "false" INTEGER, error_sum REAL);
CREATE TABLE summary(key TEXT, name TEXT, value REAL);
CREATE TABLE worst(key TEXT, rank INTEGER, time_ns INTEGER, frame TEXT, what TEXT, value REAL);
CREATE TABLE detection(key TEXT, time_ns INTEGER, frame TEXT, found INTEGER, "false" INTEGER,
  error_m REAL);
CREATE TABLE configuration(name TEXT, version TEXT, task TEXT, place INTEGER, command TEXT,
  arguments TEXT, text TEXT, PRIMARY KEY(name, version, task));
INSERT INTO configuration VALUES('usual', 'v1', 'land', 0, 'kestrel', '[]', '');
INSERT INTO configuration VALUES('strict', 'v1', 'land', 1, 'kestrel', '["--altitude", "3"]',
  'landing: {detector: {min_quality: 1}}');)");
  }

  const std::string& path() const { return path_; }

  void Run(const std::string& sql) const {
    if (sqlite3_exec(database_.get(), sql.c_str(), nullptr, nullptr, nullptr) != SQLITE_OK) {
      throw std::runtime_error(sqlite3_errmsg(database_.get()));
    }
  }

  // Adds a unit that found so many of ten images, and its images 100 ms apart from 'begin_ns': the
  // first ones are those that were found.
  void AddDone(const std::string& recording, const std::string& configuration, int found,
               int false_count = 0, const std::string& path = "", long begin_ns = 0) const {
    const std::string key = recording + configuration;
    AddUnit(key, recording, configuration, "done", "", path);
    Run(
        fmt::format("INSERT INTO bin VALUES('{}', 'all', -1e999, 1e999, 10, {}, {}, 0);"
                    "INSERT INTO bin VALUES('{}', 'altitude_m', 0, 2, 10, 0, 0, 0)",
                    key, found, false_count, key));
    for (int i = 0; i < 10; ++i) {
      Run(fmt::format("INSERT INTO detection VALUES('{}', {}, '{}.png', {}, 0, {})", key,
                      begin_ns + i * 100'000'000L, i, i < found ? 1 : 0,
                      i < found ? fmt::format("{}", 0.01 * (i + 1)) : "NULL"));
    }
  }

  void AddFailed(const std::string& recording, const std::string& configuration,
                 const std::string& reason) const {
    AddUnit(recording + configuration, recording, configuration, "failed", reason, "");
  }

 private:
  void AddUnit(const std::string& key, const std::string& recording,
               const std::string& configuration, const std::string& state,
               const std::string& reason, const std::string& path) const {
    Run(
        fmt::format("INSERT INTO unit VALUES('{}', '{}', 0, '{}', 'v1', 'land', NULL, '{}', '{}', "
                    "10, '{}')",
                    key, recording, configuration, state, reason, path));
  }

  std::string path_;
  SqliteDatabase database_;
};

}  // namespace kestrel
