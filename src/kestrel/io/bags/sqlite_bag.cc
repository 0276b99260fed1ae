// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/io/bags/sqlite_bag.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <span>
#include <sqlite3.h>
#include <string_view>
#include <zstd.h>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "kestrel/core/base/error.h"
#include "kestrel/io/bags/decompression.h"

namespace kestrel {
namespace {

std::string TextOf(sqlite3_stmt* statement, int column) {
  const void* text = sqlite3_column_text(statement, column);
  return {static_cast<const char*>(text),
          text == nullptr ? 0 : static_cast<std::size_t>(sqlite3_column_bytes(statement, column))};
}

std::string_view BlobOf(sqlite3_stmt* statement, int column) {
  const void* blob = sqlite3_column_blob(statement, column);
  return {static_cast<const char*>(blob),
          blob == nullptr ? 0 : static_cast<std::size_t>(sqlite3_column_bytes(statement, column))};
}

// Returns a file name as a URI, so that '?' and '#' in it do not begin parameters.
std::string UriOf(const std::string& path) {
  std::string uri = "file:";
  for (const unsigned char c : std::filesystem::absolute(path).string()) {
    const bool is_plain = std::isalnum(c) || c == '/' || c == '.' || c == '-' || c == '_';
    uri += is_plain ? std::string(1, static_cast<char>(c)) : fmt::format("%{:02x}", c);
  }
  return uri;
}

// Big-endian number of 'count' bytes at 'offset'.
std::uint32_t BigEndian(std::span<const char> bytes, std::size_t offset, std::size_t count) {
  std::uint32_t number = 0;
  for (const char byte : bytes.subspan(offset, count)) {
    number = number << 8 | static_cast<unsigned char>(byte);
  }
  return number;
}

}  // namespace

void CloseSqlite::operator()(sqlite3* database) const { sqlite3_close(database); }
void FinalizeSqlite::operator()(sqlite3_stmt* statement) const { sqlite3_finalize(statement); }

SqliteBag::SqliteBag(const std::string& path, bool has_compressed_messages)
    : path_(path), has_compressed_messages_(has_compressed_messages) {
  RequireWhole();
  Open();
  ReadTopics();
}

bool SqliteBag::HasJournal() const {
  std::error_code error;
  return std::filesystem::file_size(path_ + "-wal", error) > 0 && !error;
}

// SQLite itself fills a page that was cut off with zeros, and gives out the messages on it as good.
// What lies in a journal is not in the file yet.
void SqliteBag::RequireWhole() const {
  constexpr std::size_t kPageSize = 16, kPages = 28;  // offsets, sqlite.org/fileformat2.html
  std::array<char, kPages + 4> header{};
  std::ifstream file(path_, std::ios::binary);
  if (!file.read(header.data(), header.size()) || HasJournal()) return;
  if (!std::string_view(header.data(), header.size()).starts_with(kSqliteMagic)) return;
  const std::uint64_t stored_size = BigEndian(header, kPageSize, 2);
  const std::uint64_t page_size = stored_size == 1 ? 65536 : stored_size;
  const std::uint64_t expected = page_size * BigEndian(header, kPages, 4);
  const std::uint64_t size = std::filesystem::file_size(path_);
  if (size >= expected) return;
  throw InputError(fmt::format(
      "{}: was cut off, has {} of {} bytes (a power loss, an unfinished copy?): copy it "
      "again, or save its whole pages, {} bytes, as docs/bags.md says",
      path_, size, expected, size - size % page_size));
}

void SqliteBag::Open() {
  // A journal beside the file belongs to a bag that was not closed. Reading it needs some write
  // access to the file; without a journal the bag is opened so that it cannot change.
  const std::string uri = UriOf(path_) + (HasJournal() ? "?mode=ro" : "?mode=ro&immutable=1");
  sqlite3* database = nullptr;
  const int status =
      sqlite3_open_v2(uri.c_str(), &database, SQLITE_OPEN_READONLY | SQLITE_OPEN_URI, nullptr);
  database_.reset(database);
  if (status != SQLITE_OK) Fail();
}

SqliteStatement SqliteBag::Prepare(const std::string& sql) const {
  sqlite3_stmt* statement = nullptr;
  if (sqlite3_prepare_v2(database_.get(), sql.c_str(), -1, &statement, nullptr) != SQLITE_OK) {
    Fail();
  }
  return SqliteStatement(statement);
}

bool SqliteBag::Step(sqlite3_stmt* statement) const {
  const int status = sqlite3_step(statement);
  if (status != SQLITE_ROW && status != SQLITE_DONE) Fail();
  return status == SQLITE_ROW;
}

void SqliteBag::Fail() const {
  throw InputError(fmt::format("{}: cannot be read as a bag of rosbag2 (sqlite3): {}", path_,
                               database_ ? sqlite3_errmsg(database_.get()) : "no memory"));
}

void SqliteBag::ReadTopics() {
  const SqliteStatement topics =
      Prepare("SELECT id, name, type, serialization_format FROM topics ORDER BY id");
  while (Step(topics.get())) {
    RosTopic topic;
    topic.name = PlainTopicName(TextOf(topics.get(), 1));
    topic.type = PlainTopicName(NormalTypeName(TextOf(topics.get(), 2)));
    if (TextOf(topics.get(), 3) == "cdr") topic.wire_format = WireFormat::kCdr;
    ids_.push_back(sqlite3_column_int64(topics.get(), 0));
    topics_.push_back(topic);
  }
}

bool SqliteBag::HasTimeIndex() const {
  const SqliteStatement index = Prepare(
      "SELECT 1 FROM sqlite_master WHERE type='index' AND tbl_name='messages' AND "
      "name='timestamp_idx'");
  return Step(index.get());
}

// The order is that of the index on the time. Without an index it is the order of recording, as
// sorting would need the memory or disk space of all messages.
void SqliteBag::Select(const std::vector<std::size_t>& topics) {
  std::vector<std::int64_t> ids;
  for (const std::size_t topic : topics) ids.push_back(ids_.at(topic));
  messages_ = Prepare(fmt::format(
      "SELECT topic_id, timestamp, data FROM messages WHERE topic_id IN ({}) ORDER BY {}",
      fmt::join(ids, ","), HasTimeIndex() ? "timestamp" : "id"));
}

std::size_t SqliteBag::TopicOfId(std::int64_t id) const {
  return static_cast<std::size_t>(std::find(ids_.begin(), ids_.end(), id) - ids_.begin());
}

bool SqliteBag::Next(BagMessage* message) {
  if (!messages_ || !Step(messages_.get())) {
    messages_.reset();
    return false;
  }
  message->topic = TopicOfId(sqlite3_column_int64(messages_.get(), 0));
  message->arrival = TimeFromNanoseconds(sqlite3_column_int64(messages_.get(), 1));
  message->data = BlobOf(messages_.get(), 2);
  if (!has_compressed_messages_) return true;
  const std::string name = fmt::format("{}: {}", path_, topics_[message->topic].name);
  const auto size = ZSTD_getFrameContentSize(message->data.data(), message->data.size());
  if (size == ZSTD_CONTENTSIZE_UNKNOWN || size == ZSTD_CONTENTSIZE_ERROR) {
    throw InputError(name + ": a message is not compressed by zstd, as metadata.yaml says it is");
  }
  Decompress(Compression::kZstd, message->data, size, name, &decompressed_);
  message->data = decompressed_;
  return true;
}

}  // namespace kestrel
