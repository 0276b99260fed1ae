// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "kestrel/io/bags/bag_reader.h"
#include "kestrel/io/bags/sqlite_handles.h"

namespace kestrel {

// First bytes of an sqlite3 file.
inline constexpr std::string_view kSqliteMagic("SQLite format 3\0", 16);

// Reads a file of rosbag2's sqlite3 storage (.db3), in all versions of its tables.
class SqliteBag : public BagReader {
 public:
  // 'has_compressed_messages': each message is compressed by zstd, as in metadata.yaml
  // (compression_mode: MESSAGE). Throws InputError when the file is not such a bag, was cut off or
  // is broken.
  explicit SqliteBag(const std::string& path, bool has_compressed_messages = false);

  const std::vector<RosTopic>& topics() const override { return topics_; }
  void Select(const std::vector<std::size_t>& topics) override;
  bool Next(BagMessage* message) override;

 private:
  bool HasJournal() const;
  void RequireWhole() const;
  void Open();
  SqliteStatement Prepare(const std::string& sql) const;
  // Returns whether there is a row.
  bool Step(sqlite3_stmt* statement) const;
  [[noreturn]] void Fail() const;
  bool HasTimeIndex() const;
  void ReadTopics();
  std::size_t TopicOfId(std::int64_t id) const;

  std::string path_;
  bool has_compressed_messages_;
  SqliteDatabase database_;
  std::vector<RosTopic> topics_;
  std::vector<std::int64_t> ids_;  // the database's ids of the topics
  SqliteStatement messages_;
  std::string decompressed_;
};

}  // namespace kestrel
