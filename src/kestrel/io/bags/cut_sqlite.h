// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "kestrel/io/bags/sqlite_handles.h"

namespace kestrel {

// Sizes of an sqlite3 file that was cut off, in bytes.
struct SqliteCut {
  std::uint64_t whole_pages;  // size of the pages that are complete
  std::uint64_t expected;     // size of the file according to its header
};

// Returns where the file was cut off; nothing where it is complete or is no sqlite3 file.
std::optional<SqliteCut> FindSqliteCut(const std::string& path);

// The complete pages of a cut file as a database. SQLite would fill the page with the cut with
// zeros, and give out the messages on it as good.
class CutSqlite {
 public:
  // Throws InputError when the file cannot be read.
  CutSqlite(const std::string& path, const SqliteCut& cut);
  ~CutSqlite();
  CutSqlite(const CutSqlite&) = delete;
  CutSqlite& operator=(const CutSqlite&) = delete;

  // Makes the pages the content of 'database', which must not outlive this. Returns SQLite's
  // status.
  int OpenIn(sqlite3* database) const;

 private:
  unsigned char* pages_ = nullptr;
  std::size_t size_;
};

}  // namespace kestrel
