// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "kestrel/io/bags/bag_reader.h"
#include "kestrel/io/bags/cut_sqlite.h"
#include "kestrel/io/bags/sqlite_handles.h"

namespace kestrel {

// First bytes of an sqlite3 file.
inline constexpr std::string_view kSqliteMagic("SQLite format 3\0", 16);

// Reads a file of rosbag2's sqlite3 storage (.db3), in all versions of its tables.
class SqliteBag : public BagReader {
 public:
  // 'has_compressed_messages': each message is compressed by zstd, as metadata.yaml says
  // (compression_mode: MESSAGE). A file that was cut off is read up to there, as long as the pages
  // that list its messages are left. Throws InputError when the file is not such a bag or is
  // broken.
  explicit SqliteBag(const std::string& path, bool has_compressed_messages = false);

  const std::vector<BagTopic>& topics() const override { return topics_; }
  void Select(const std::vector<std::size_t>& topics) override;
  bool Next(BagMessage* message) override;
  std::string remark() const override { return remark_; }

 private:
  bool HasJournal() const;
  void Open();
  void OpenCut(const SqliteCut& cut);
  SqliteStatement Prepare(const std::string& sql) const;
  // Returns whether there is a row; none behind a cut.
  bool Step(sqlite3_stmt* statement) const;
  [[noreturn]] void Fail() const;
  bool HasTimeIndex() const;
  void ReadTopics();
  std::size_t TopicOfId(std::int64_t id) const;

  std::string path_;
  bool has_compressed_messages_;
  std::unique_ptr<CutSqlite> cut_;  // of a file that was cut off
  SqliteDatabase database_;
  std::vector<BagTopic> topics_;
  std::vector<std::int64_t> ids_;  // the database's ids of the topics
  SqliteStatement messages_;
  std::string decompressed_;
  std::string remark_;
};

}  // namespace kestrel
