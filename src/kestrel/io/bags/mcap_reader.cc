// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/io/bags/mcap_reader.h"

#include <algorithm>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "kestrel/core/base/bytes.h"
#include "kestrel/core/base/error.h"
#include "kestrel/io/bags/checksum.h"
#include "kestrel/io/bags/mcap_opcodes.h"
#include "kestrel/io/ros_messages/foxglove_message.h"

namespace kestrel {
namespace {

constexpr std::uint64_t kRecordHead = 9;    // opcode and length
constexpr std::uint64_t kFooterSize = 20;   // without its head
constexpr std::uint64_t kMessageHead = 22;  // channel, sequence, two times

// Pairs: "cdr" with a schema of ROS 2, "ros1" with one of ROS 1.
WireFormat WireFormatOf(std::string_view message_encoding, std::string_view schema_encoding) {
  const bool is_ros2 = schema_encoding == "ros2msg" || schema_encoding == "ros2idl";
  if (message_encoding == "cdr" && is_ros2) return WireFormat::kCdr;
  if (message_encoding == "ros1" && schema_encoding == "ros1msg") return WireFormat::kRos1;
  return WireFormat::kOther;
}

}  // namespace

struct McapReader::Record {
  std::uint8_t opcode = 0;
  std::uint64_t offset = 0;          // start of the record
  std::uint64_t content_offset = 0;  // both in the source of the record
  std::uint64_t content_size = 0;
  std::string name;

  std::uint64_t end() const { return content_offset + content_size; }
  std::string_view Content(ByteSource* records) const {
    return records->View(content_offset, content_size);
  }
};

McapReader::McapReader(const std::string& path) : ChunkedBag(path) {
  if (file().View(0, kMcapMagic.size()) != kMcapMagic) {
    throw InputError(path + ": is no MCAP file, expected it to begin with MCAP's magic bytes");
  }
  if (ReadSummary()) return;
  schemas_.clear();
  topics_of_channels_.clear();
  mutable_topics().clear();
  chunks().clear();
  ReadThrough();
}

// Returns false when there is no further whole record.
bool McapReader::ReadRecord(ByteSource* records, std::uint64_t offset, Record* record) const {
  record->offset = offset;
  record->name = Place(offset);
  const std::string_view head = records->View(offset, kRecordHead);
  if (head.size() < kRecordHead) return false;
  ByteCursor cursor(head, record->name);
  record->opcode = cursor.Take<std::uint8_t>();
  record->content_size = cursor.Take<std::uint64_t>();
  record->content_offset = offset + kRecordHead;
  return record->content_size <= records->size() - record->content_offset;
}

bool McapReader::HasEndMagic() {
  return file().View(file().size() - kMcapMagic.size(), kMcapMagic.size()) == kMcapMagic;
}

// True when the bytes have the checksum; 0 stands for none.
bool McapReader::IsIntact(std::uint64_t offset, std::uint64_t size, std::uint32_t checksum) {
  BytesPart part(&file(), offset, size);
  return checksum == 0 || ChecksumOf(&part, size) == checksum;
}

// Returns false when there is no summary, or one with which not all messages can be found.
bool McapReader::ReadSummary() {
  constexpr std::uint64_t kEnd = kRecordHead + kFooterSize + kMcapMagic.size();
  const std::uint64_t size = file().size();
  if (size < kMcapMagic.size() + kEnd || !HasEndMagic()) return false;
  Record footer;
  if (!ReadRecord(&file(), size - kEnd, &footer) || footer.opcode != kMcapFooter ||
      footer.content_size != kFooterSize) {
    return false;
  }
  ByteCursor cursor(footer.Content(&file()), footer.name);
  const auto summary = cursor.Take<std::uint64_t>();
  if (summary == 0 || summary > footer.offset) return false;
  cursor.Bytes(8);  // place of the offsets within the summary
  const std::uint64_t checked_size = footer.end() - sizeof(std::uint32_t) - summary;
  try {
    if (!IsIntact(summary, checked_size, cursor.Take<std::uint32_t>())) return false;
    return ReadSummaryRecords(summary, footer.offset);
  } catch (const InputError&) {
    return false;
  }
}

bool McapReader::ReadSummaryRecords(std::uint64_t offset, std::uint64_t end) {
  std::vector<std::pair<Record, std::string>> chunk_indexes;  // with their content
  std::optional<std::string> statistics;
  Record record;
  for (; offset < end && ReadRecord(&file(), offset, &record); offset = record.end()) {
    const std::string content(record.Content(&file()));
    if (record.opcode == kMcapSchema) AddSchema(content, record.name);
    if (record.opcode == kMcapChannel) AddChannel(content, record.name);
    if (record.opcode == kMcapStatistics) statistics = content;
    if (record.opcode == kMcapChunkIndex) chunk_indexes.emplace_back(record, content);
  }
  if (offset != end || !statistics) return false;

  ByteCursor counts(*statistics, record.name);
  const auto message_count = counts.Take<std::uint64_t>();
  counts.Bytes(2 + 4 + 4 + 4);  // schemas, channels, attachments, metadata
  const auto chunk_count = counts.Take<std::uint32_t>();
  counts.Bytes(8 + 8);  // first and last time
  SetMessageCounts(counts.Text(), record.name);
  const bool lies_outside_of_chunks = chunk_indexes.empty() && message_count > 0;
  if (lies_outside_of_chunks || chunk_count != chunk_indexes.size()) return false;

  for (const auto& [index, content] : chunk_indexes) {
    ByteCursor cursor(content, index.name);
    cursor.Bytes(8 + 8);  // first and last time
    Record head;
    if (!ReadRecord(&file(), cursor.Take<std::uint64_t>(), &head) || head.opcode != kMcapChunk) {
      return false;
    }
    Chunk chunk = ReadChunkHead(head);
    cursor.Bytes(8);  // length of the chunk
    ByteCursor channels(cursor.Text(), index.name);
    chunk.has_topics = channels.left() > 0;
    while (channels.left() > 0) {
      chunk.topics.push_back(TopicOfChannel(channels.Take<std::uint16_t>(), index.name));
      channels.Bytes(8);  // place of the index of its messages
    }
    chunks().push_back(std::move(chunk));
  }
  std::sort(chunks().begin(), chunks().end(),
            [](const Chunk& a, const Chunk& b) { return a.offset < b.offset; });
  return true;
}

void McapReader::SetMessageCounts(std::string_view counts, const std::string& name) {
  for (RosTopic& topic : mutable_topics()) topic.messages = 0;
  for (ByteCursor cursor(counts, name); cursor.left() > 0;) {
    const std::size_t topic = TopicOfChannel(cursor.Take<std::uint16_t>(), name);
    *mutable_topics()[topic].messages += cursor.Take<std::uint64_t>();
  }
}

// Finds topics and chunks without the summary, up to the end of the file or to a record that makes
// no sense. Messages outside of chunks, and all that follows them, are treated as one chunk.
void McapReader::ReadThrough() {
  std::uint64_t offset = kMcapMagic.size();
  bool has_end = false;
  Record record;
  std::optional<Chunk> loose;
  const auto finish_loose = [&] {
    if (!loose) return;
    loose->stored_size = offset - loose->offset;
    BytesPart records(&file(), loose->offset, loose->stored_size);
    ReadRecordsThrough(&records, *std::exchange(loose, std::nullopt));
  };
  try {
    for (; !has_end && ReadRecord(&file(), offset, &record); offset = record.end()) {
      if (record.opcode == 0) throw InputError(record.name + ": is no record");
      const bool is_message = record.opcode == kMcapMessage;
      if (is_message && !loose) loose.emplace().offset = offset;
      if (!is_message && record.opcode != kMcapSchema && record.opcode != kMcapChannel) {
        finish_loose();
      }
      if (record.opcode == kMcapSchema) AddSchema(record.Content(&file()), record.name);
      if (record.opcode == kMcapChannel) AddChannel(record.Content(&file()), record.name);
      if (record.opcode == kMcapChunk) {
        const Chunk chunk = ReadChunkHead(record);
        ReadRecordsThrough(OpenChunk(chunk), chunk);
      }
      has_end = record.opcode == kMcapDataEnd;
    }
    finish_loose();
    if (has_end && HasEndMagic()) {
      CheckData(record);
      return;
    }
    // The last chunk may be cut off: its whole records count.
    if (record.content_offset > offset && record.opcode == kMcapChunk) {
      const Chunk chunk = ReadChunkHead(record, /*is_cut=*/true);
      ReadRecordsThrough(OpenChunk(chunk), chunk);
    }
  } catch (const InputError&) {
    finish_loose();
    if (chunks().empty()) throw;
  }
  SetCutRemark(offset);
}

// Messages outside of chunks, or in chunks without a checksum, only have the checksum of all data.
void McapReader::CheckData(const Record& data_end) {
  const bool are_checked = std::all_of(chunks().begin(), chunks().end(),
                                       [](const Chunk& chunk) { return chunk.checksum != 0; });
  if (are_checked) return;
  const std::string content(data_end.Content(&file()));
  const auto checksum = ByteCursor(content, data_end.name).Take<std::uint32_t>();
  if (IsIntact(0, data_end.offset, checksum)) return;
  SetRemark(path() + ": something in it is damaged: the checksum of all is wrong");
}

// Adds the chunk. If a record makes no sense, the one before it may be only half written.
void McapReader::ReadRecordsThrough(ByteSource* records, Chunk chunk) {
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
    for (; ReadRecord(records, offset, &record); last_offset = offset, offset = record.end()) {
      if (record.opcode == 0) throw InputError(record.name + ": is no record");
      if (record.opcode == kMcapSchema) AddSchema(record.Content(records), record.name);
      if (record.opcode == kMcapChannel) AddChannel(record.Content(records), record.name);
      if (record.opcode != kMcapMessage) continue;
      ByteCursor cursor(records->View(record.content_offset, kMessageHead), record.name);
      const std::size_t topic = TopicOfChannel(cursor.Take<std::uint16_t>(), record.name);
      CountMessage(topic);
      topics.insert(topic);
    }
  } catch (const InputError&) {
    chunk.records_end = last_offset;
    chunk.checksum = 0;
    add();
    throw;
  }
  add();
}

ChunkedBag::Chunk McapReader::ReadChunkHead(const Record& record, bool is_cut) {
  constexpr std::uint64_t kMaxHead = 128;  // its only text is the name of the compression
  const std::string_view bytes =
      file().View(record.content_offset, std::min(record.content_size, kMaxHead));
  ByteCursor cursor(bytes, record.name);
  cursor.Bytes(8 + 8);  // first and last time
  Chunk chunk;
  chunk.size = cursor.Take<std::uint64_t>();
  const auto checksum = cursor.Take<std::uint32_t>();
  if (!is_cut) chunk.checksum = checksum;
  chunk.compression = CompressionOf(cursor.Text(), record.name);
  chunk.stored_size = cursor.Take<std::uint64_t>();
  chunk.offset = record.content_offset + (bytes.size() - cursor.left());
  if (!is_cut && chunk.stored_size > record.end() - chunk.offset) {
    throw InputError(record.name + ": the chunk's records are longer than the chunk");
  }
  return chunk;
}

void McapReader::AddSchema(std::string_view content, const std::string& name) {
  ByteCursor cursor(content, name);
  const auto id = cursor.Take<std::uint16_t>();
  Schema& schema = schemas_[id];
  schema.name = cursor.Text();
  schema.encoding = cursor.Text();
}

void McapReader::AddChannel(std::string_view content, const std::string& name) {
  ByteCursor cursor(content, name);
  const auto id = cursor.Take<std::uint16_t>();
  const auto schema = schemas_.find(cursor.Take<std::uint16_t>());
  RosTopic topic;
  topic.name = PlainTopicName(cursor.Text());
  if (schema != schemas_.end()) {
    topic.type = PlainTopicName(NormalTypeName(schema->second.name));
    const std::string_view encoding = cursor.Text();
    topic.wire_format = WireFormatOf(encoding, schema->second.encoding);
    const auto ros_type = RosTypeOfFoxglove(schema->second.name);
    if (encoding == "protobuf" && ros_type) {
      topic.type = *ros_type;
      topic.wire_format = WireFormat::kProtobuf;
    }
  }
  topics_of_channels_[id] = TopicOf(topic);
}

std::size_t McapReader::TopicOfChannel(std::uint16_t channel, const std::string& name) const {
  const auto topic = topics_of_channels_.find(channel);
  if (topic == topics_of_channels_.end()) {
    throw InputError(fmt::format(
        "{}: has a message of channel {}, which the file does not describe", name, channel));
  }
  return topic->second;
}

bool McapReader::NextMessage(ByteSource* records, std::uint64_t* offset, BagMessage* message) {
  Record record;
  while (ReadRecord(records, *offset, &record)) {
    *offset = record.end();
    if (record.opcode != kMcapMessage) continue;
    if (record.content_size < kMessageHead) {
      throw InputError(record.name + ": the message has no times, expected two");
    }
    ByteCursor cursor(records->View(record.content_offset, kMessageHead), record.name);
    message->topic = TopicOfChannel(cursor.Take<std::uint16_t>(), record.name);
    if (!IsWanted(message->topic)) continue;
    cursor.Take<std::uint32_t>();  // sequence
    message->arrival = TimeFromNanoseconds(cursor.Take<std::int64_t>());
    message->data =
        records->View(record.content_offset + kMessageHead, record.content_size - kMessageHead);
    return true;
  }
  return false;
}

}  // namespace kestrel
