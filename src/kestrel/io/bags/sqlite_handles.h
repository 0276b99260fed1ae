// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

struct sqlite3;
struct sqlite3_stmt;

namespace kestrel {

struct CloseSqlite {
  void operator()(sqlite3* database) const;
};
struct FinalizeSqlite {
  void operator()(sqlite3_stmt* statement) const;
};

// The database must outlive its statements.
using SqliteDatabase = std::unique_ptr<sqlite3, CloseSqlite>;
using SqliteStatement = std::unique_ptr<sqlite3_stmt, FinalizeSqlite>;

}  // namespace kestrel
