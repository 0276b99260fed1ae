// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/io/bags/sqlite_writer.h"

#include <filesystem>
#include <sqlite3.h>
#include <system_error>

#include "kestrel/core/base/error.h"
#include "kestrel/io/bags/growing_file.h"
#include "kestrel/io/bags/qos_text.h"
#include "kestrel/io/ros_messages/message_definitions.h"

namespace kestrel {
namespace {

constexpr const char* kTables =
    "CREATE TABLE schema(schema_version INTEGER PRIMARY KEY, ros_distro TEXT NOT NULL);"
    "CREATE TABLE metadata(id INTEGER PRIMARY KEY, metadata_version INTEGER NOT NULL,"
    " metadata TEXT NOT NULL);"
    "CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT NOT NULL, type TEXT NOT NULL,"
    " serialization_format TEXT NOT NULL, offered_qos_profiles TEXT NOT NULL);"
    "CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER NOT NULL,"
    " timestamp INTEGER NOT NULL, data BLOB NOT NULL);"
    "CREATE INDEX timestamp_idx ON messages (timestamp ASC);"
    "INSERT INTO schema(schema_version, ros_distro) VALUES (3, 'humble');";

void BindText(sqlite3_stmt* statement, int column, std::string_view text) {
  sqlite3_bind_text(statement, column, text.data(), static_cast<int>(text.size()),
                    SQLITE_TRANSIENT);
}

}  // namespace

SqliteWriter::SqliteWriter(const std::string& path, bool replace) : path_(path) {
  RequireNew(path, replace);
  const std::string part = GrowingFile::PartOf(path);
  std::error_code ignored;
  std::filesystem::remove(part, ignored);
  sqlite3* database = nullptr;
  const int status =
      sqlite3_open_v2(part.c_str(), &database, SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE, nullptr);
  database_.reset(database);
  if (status != SQLITE_OK) Fail();
  // Until Close the file has another name and nobody needs it: therefore no journal, and no waiting
  // for the disk.
  Execute("PRAGMA journal_mode=OFF; PRAGMA synchronous=OFF; BEGIN;");
  Execute(kTables);
  topic_ = Prepare("INSERT INTO topics VALUES (?, ?, ?, 'cdr', ?)");
  message_ = Prepare("INSERT INTO messages(topic_id, timestamp, data) VALUES (?, ?, ?)");
}

SqliteWriter::~SqliteWriter() {
  if (!database_) return;
  topic_.reset();
  message_.reset();
  database_.reset();
  std::error_code ignored;
  std::filesystem::remove(GrowingFile::PartOf(path_), ignored);
}

void SqliteWriter::Fail() const {
  const std::string reason = database_ ? sqlite3_errmsg(database_.get()) : "no memory";
  throw InputError(path_ + ": cannot be written: " + reason);
}

void SqliteWriter::Execute(const std::string& sql) {
  if (sqlite3_exec(database_.get(), sql.c_str(), nullptr, nullptr, nullptr) != SQLITE_OK) Fail();
}

SqliteStatement SqliteWriter::Prepare(const char* sql) {
  sqlite3_stmt* statement = nullptr;
  if (sqlite3_prepare_v2(database_.get(), sql, -1, &statement, nullptr) != SQLITE_OK) Fail();
  return SqliteStatement(statement);
}

void SqliteWriter::Run(const SqliteStatement& statement) {
  if (sqlite3_step(statement.get()) != SQLITE_DONE) Fail();
  sqlite3_reset(statement.get());
}

std::size_t SqliteWriter::AddTopic(const std::string& name, std::string_view type,
                                   bool is_latched) {
  sqlite3_bind_int64(topic_.get(), 1, static_cast<sqlite3_int64>(topics_) + 1);
  BindText(topic_.get(), 2, name);
  BindText(topic_.get(), 3, Ros2TypeName(type));
  BindText(topic_.get(), 4, QosText(is_latched));
  Run(topic_);
  return topics_++;
}

void SqliteWriter::Write(std::size_t topic, Time time, std::string_view data) {
  sqlite3_bind_int64(message_.get(), 1, static_cast<sqlite3_int64>(topic) + 1);
  sqlite3_bind_int64(message_.get(), 2, ToNanoseconds(time));
  sqlite3_bind_blob64(message_.get(), 3, data.data(), data.size(), SQLITE_STATIC);
  Run(message_);
}

void SqliteWriter::Close() {
  Execute("COMMIT;");
  topic_.reset();
  message_.reset();
  database_.reset();
  std::error_code error;
  std::filesystem::rename(GrowingFile::PartOf(path_), path_, error);
  if (error) throw InputError(path_ + ": cannot be written: " + error.message());
}

}  // namespace kestrel
