// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/io/bags/ros1_bag.h"

#include <algorithm>
#include <optional>
#include <set>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "kestrel/core/base/bytes.h"
#include "kestrel/core/base/error.h"

namespace kestrel {
namespace {

constexpr std::uint8_t kMessageData = 2;
constexpr std::uint8_t kBagHeader = 3;
constexpr std::uint8_t kChunk = 5;
constexpr std::uint8_t kChunkInfo = 6;
constexpr std::uint8_t kConnection = 7;

constexpr std::uint32_t kMaxHeader = 1 << 20;  // bytes; a message's definition takes most

// The fields "name=value" of a record's header, or of a connection's data.
class Fields {
 public:
  Fields(std::string_view bytes, std::string name) : bytes_(bytes), name_(std::move(name)) {}

  std::optional<std::string_view> Find(std::string_view key) const {
    ByteCursor cursor(bytes_, name_);
    while (cursor.left() > 0) {
      const std::string_view field = cursor.Text();
      const std::size_t end = field.find('=');
      if (end == std::string_view::npos) throw InputError(name_ + ": a field of it has no '='");
      if (field.substr(0, end) == key) return field.substr(end + 1);
    }
    return std::nullopt;
  }
  std::string_view Text(std::string_view key) const {
    const auto value = Find(key);
    if (!value) throw InputError(fmt::format("{}: has no field '{}', expected it", name_, key));
    return *value;
  }
  template <class Number>
  Number Get(std::string_view key) const {
    const std::string_view value = Text(key);
    if (value.size() != sizeof(Number)) {
      throw InputError(fmt::format("{}: its field '{}' has {} bytes, expected {}", name_, key,
                                   value.size(), sizeof(Number)));
    }
    return ByteCursor(value, name_).Take<Number>();
  }

 private:
  std::string_view bytes_;
  std::string name_;
};

// Converts a time of ROS 1: the lower 32 bits are seconds, the upper ones nanoseconds.
Time TimeOfField(std::uint64_t field) {
  return TimeFromNanoseconds(static_cast<std::int64_t>(field & 0xffffffff) * 1'000'000'000 +
                             static_cast<std::int64_t>(field >> 32));
}

}  // namespace

struct Ros1Bag::Record {
  std::string header;
  std::uint64_t offset = 0;       // start of the record
  std::uint64_t data_offset = 0;  // both in the source of the record
  std::uint32_t data_size = 0;
  std::string name;

  Fields fields() const { return {header, name}; }
  std::uint8_t kind() const { return fields().Get<std::uint8_t>("op"); }
  std::uint64_t end() const { return data_offset + data_size; }
};

Ros1Bag::Ros1Bag(const std::string& path) : ChunkedBag(path) {
  if (file().View(0, kRos1BagMagic.size()) != kRos1BagMagic) {
    throw InputError(path +
                     ": is no ROS 1 bag of version 2.0, expected it to begin '#ROSBAG V2.0'");
  }
  Record head;
  if (ReadRecord(&file(), kRos1BagMagic.size(), &head) == RecordStatus::kCut) {
    throw InputError(path + ": is cut off within its first record");
  }
  if (head.kind() != kBagHeader) throw InputError(head.name + ": is no bag header, expected it");
  const auto encryptor = head.fields().Find("encryptor");
  if (encryptor && !encryptor->empty()) {
    throw InputError(path + ": is encrypted, expected a bag that is not (rosbag decrypt)");
  }
  const auto index_offset = head.fields().Get<std::uint64_t>("index_pos");
  // The index of a bag that was closed without a message is empty.
  if (index_offset == file().size() && head.fields().Get<std::uint32_t>("chunk_count") == 0) return;
  if (ReadIndex(index_offset)) return;
  topics_of_connections_.clear();
  mutable_topics().clear();
  chunks().clear();
  ReadThrough(head.end());
}

Ros1Bag::RecordStatus Ros1Bag::ReadRecord(ByteSource* records, std::uint64_t offset,
                                          Record* record) const {
  record->offset = offset;
  record->name = Place(offset);
  const std::string_view head = records->View(offset, sizeof(std::uint32_t));
  if (head.size() < sizeof(std::uint32_t)) return RecordStatus::kCut;
  const auto header_size = ByteCursor(head, record->name).Take<std::uint32_t>();
  if (header_size > kMaxHeader) {
    throw InputError(fmt::format("{}: a record's header claims {} bytes, expected at most {}",
                                 record->name, header_size, kMaxHeader));
  }
  const std::uint64_t rest = header_size + sizeof(std::uint32_t);
  const std::string_view bytes = records->View(offset + sizeof(std::uint32_t), rest);
  if (bytes.size() < rest) return RecordStatus::kCut;
  record->header.assign(bytes.substr(0, header_size));
  record->data_size = ByteCursor(bytes.substr(header_size), record->name).Take<std::uint32_t>();
  record->data_offset = offset + sizeof(std::uint32_t) + rest;
  return record->end() > records->size() ? RecordStatus::kCut : RecordStatus::kOk;
}

// Returns false when there is no index, or one that does not fit the bag.
bool Ros1Bag::ReadIndex(std::uint64_t index_offset) {
  if (index_offset == 0 || index_offset >= file().size()) return false;
  try {
    std::vector<Record> infos;
    Record record;
    std::uint64_t offset = index_offset;
    for (; ReadRecord(&file(), offset, &record) == RecordStatus::kOk; offset = record.end()) {
      if (record.kind() == kConnection) {
        AddConnection(record, &file());
      } else if (record.kind() == kChunkInfo) {
        infos.push_back(record);
      }
    }
    if (offset != file().size()) return false;
    for (const Record& info : infos) {
      Record head;
      if (ReadRecord(&file(), info.fields().Get<std::uint64_t>("chunk_pos"), &head) ==
              RecordStatus::kCut ||
          head.kind() != kChunk) {
        return false;
      }
      Chunk chunk = ReadChunkHead(head);
      chunk.has_topics = true;
      const std::string counts(file().View(info.data_offset, info.data_size));
      ByteCursor cursor(counts, info.name);
      while (cursor.left() > 0) {
        const std::size_t topic = TopicOfConnection(cursor.Take<std::uint32_t>(), info.offset);
        auto& messages = mutable_topics()[topic].messages;
        messages = messages.value_or(0) + cursor.Take<std::uint32_t>();
        chunk.topics.push_back(topic);
      }
      chunks().push_back(std::move(chunk));
    }
  } catch (const InputError&) {
    return false;
  }
  std::sort(chunks().begin(), chunks().end(),
            [](const Chunk& a, const Chunk& b) { return a.offset < b.offset; });
  return true;
}

// Finds topics and chunks without the index, up to the end of the file or to a record that makes no
// sense: after a crash the file system may fill up a file with zeros.
void Ros1Bag::ReadThrough(std::uint64_t offset) {
  Record record;
  bool has_index = false;
  try {
    for (; ReadRecord(&file(), offset, &record) == RecordStatus::kOk; offset = record.end()) {
      const std::uint8_t kind = record.kind();
      if (kind == kChunkInfo) has_index = true;
      if (kind == kConnection) AddConnection(record, &file());
      if (kind != kChunk) continue;
      if (record.data_size == 0) break;  // not finished: its sizes are filled in at its end
      ReadChunkThrough(ReadChunkHead(record));
    }
    if (offset == file().size() && has_index) return;
    // The whole records of the last chunk count.
    if (record.data_offset > offset && record.kind() == kChunk) {
      Chunk chunk = ReadChunkHead(record);
      if (record.data_size == 0) {
        chunk.stored_size = file().size() - chunk.offset;
        chunk.size.reset();
      }
      ReadChunkThrough(std::move(chunk));
    }
  } catch (const InputError&) {
    if (chunks().empty()) throw;
  }
  SetCutRemark(offset);
}

// Adds the chunk. If a record makes no sense, the one before it may be only half written.
void Ros1Bag::ReadChunkThrough(Chunk chunk) {
  ByteSource* records = OpenChunk(chunk);
  std::set<std::size_t> topics;
  Record record;
  std::uint64_t offset = 0;
  std::uint64_t last_offset = 0;
  const auto add = [&] {
    chunk.has_topics = true;
    chunk.topics.assign(topics.begin(), topics.end());
    chunks().push_back(chunk);
  };
  try {
    for (; ReadRecord(records, offset, &record) == RecordStatus::kOk;
         last_offset = offset, offset = record.end()) {
      const std::uint8_t kind = record.kind();
      if (kind == kConnection) AddConnection(record, records);
      if (kind != kMessageData) continue;
      const std::size_t topic =
          TopicOfConnection(record.fields().Get<std::uint32_t>("conn"), chunk.offset);
      CountMessage(topic);
      topics.insert(topic);
    }
  } catch (const InputError&) {
    chunk.records_end = last_offset;
    add();
    throw;
  }
  add();
}

ChunkedBag::Chunk Ros1Bag::ReadChunkHead(const Record& record) {
  Chunk chunk;
  chunk.offset = record.data_offset;
  chunk.stored_size = record.data_size;
  chunk.compression = CompressionOf(record.fields().Text("compression"), record.name);
  chunk.size = record.fields().Get<std::uint32_t>("size");
  return chunk;
}

void Ros1Bag::AddConnection(const Record& record, ByteSource* records) {
  const auto connection = record.fields().Get<std::uint32_t>("conn");
  const Fields data(records->View(record.data_offset, record.data_size), record.name);
  RosTopic topic;
  topic.name = PlainTopicName(record.fields().Text("topic"));
  topic.type = PlainTopicName(data.Text("type"));
  topic.wire_format = WireFormat::kRos1;
  topics_of_connections_[connection] = TopicOf(topic);
}

std::size_t Ros1Bag::TopicOfConnection(std::uint32_t connection, std::uint64_t offset) const {
  const auto topic = topics_of_connections_.find(connection);
  if (topic == topics_of_connections_.end()) {
    throw InputError(
        fmt::format("{}: has a message of connection {}, which the bag does not describe",
                    Place(offset), connection));
  }
  return topic->second;
}

bool Ros1Bag::NextMessage(ByteSource* records, std::uint64_t* offset, BagMessage* message) {
  Record record;
  while (ReadRecord(records, *offset, &record) == RecordStatus::kOk) {
    *offset = record.end();
    if (record.kind() != kMessageData) continue;
    message->topic = TopicOfConnection(record.fields().Get<std::uint32_t>("conn"), record.offset);
    if (!IsWanted(message->topic)) continue;
    message->arrival = TimeOfField(record.fields().Get<std::uint64_t>("time"));
    message->data = records->View(record.data_offset, record.data_size);
    return true;
  }
  return false;
}

}  // namespace kestrel
