// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>

#include "kestrel/io/bags/bag_writer.h"
#include "kestrel/io/bags/sqlite_handles.h"

namespace kestrel {

// Writes a file of rosbag2's sqlite3 storage, with the tables that Humble and later versions read.
class SqliteWriter : public BagWriter {
 public:
  SqliteWriter(const std::string& path, bool replace);
  ~SqliteWriter() override;
  SqliteWriter(const SqliteWriter&) = delete;
  SqliteWriter& operator=(const SqliteWriter&) = delete;

  WireFormat format() const override { return WireFormat::kCdr; }
  std::size_t AddTopic(const std::string& name, std::string_view type, bool is_latched) override;
  void Write(std::size_t topic, Time time, std::string_view data) override;
  void Close() override;

 private:
  void Execute(const std::string& sql);
  SqliteStatement Prepare(const char* sql);
  void Run(const SqliteStatement& statement);
  [[noreturn]] void Fail() const;

  std::string path_;
  SqliteDatabase database_;
  SqliteStatement topic_;
  SqliteStatement message_;
  std::size_t topics_ = 0;
};

}  // namespace kestrel
