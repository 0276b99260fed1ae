// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/bags/mcap_writer.h"

#include <algorithm>

#include "kestrel/bags/byte_cursor.h"
#include "kestrel/bags/compression.h"
#include "kestrel/bags/mcap_opcodes.h"
#include "kestrel/bags/mcap_reader.h"
#include "kestrel/bags/message_definitions.h"
#include "kestrel/bags/qos_text.h"

namespace kestrel {
namespace {

constexpr std::size_t kMcapChunkSize = 1 << 20;
constexpr std::uint32_t kNoChecksum = 0;

std::string McapRecord(std::uint8_t opcode, std::string_view content) {
  std::string record;
  Put(opcode, &record);
  Put(static_cast<std::uint64_t>(content.size()), &record);
  record.append(content);
  return record;
}

}  // namespace

McapWriter::McapWriter(const std::string& path, Compression compression, bool replace)
    : file_(path, replace), compression_(compression) {
  file_.Append(kMcapMagic);
  std::string header;
  PutText("ros2", &header);
  PutText("kestrel", &header);
  file_.Append(McapRecord(kMcapHeader, header));
}

std::size_t McapWriter::AddTopic(const std::string& name, std::string_view type, bool is_latched) {
  const auto id = static_cast<std::uint16_t>(channels_.size());
  const auto schema_id = static_cast<std::uint16_t>(id + 1);  // 0 is no schema
  std::string schema;
  Put(schema_id, &schema);
  PutText(Ros2TypeName(type), &schema);
  PutText("ros2msg", &schema);
  PutText(MessageDefinition(type, WireFormat::kCdr), &schema);
  std::string metadata;
  PutText("offered_qos_profiles", &metadata);
  PutText(QosText(is_latched), &metadata);
  std::string channel;
  Put(id, &channel);
  Put(schema_id, &channel);
  PutText(name, &channel);
  PutText("cdr", &channel);
  PutText(metadata, &channel);
  channels_.push_back(McapRecord(kMcapSchema, schema) + McapRecord(kMcapChannel, channel));
  messages_.push_back(0);
  is_announced_.push_back(false);
  return id;
}

void McapWriter::Write(std::size_t topic, Time time, std::string_view data) {
  const std::int64_t time_ns = ToNanoseconds(time);
  const bool is_first = std::all_of(messages_.begin(), messages_.end(),
                                    [](std::uint64_t count) { return count == 0; });
  first_time_ = is_first ? time_ns : std::min(first_time_, time_ns);
  last_time_ = is_first ? time_ns : std::max(last_time_, time_ns);
  chunk_first_time_ = index_.empty() ? time_ns : std::min(chunk_first_time_, time_ns);
  chunk_last_time_ = index_.empty() ? time_ns : std::max(chunk_last_time_, time_ns);
  if (!is_announced_[topic]) chunk_ += channels_[topic];
  is_announced_[topic] = true;

  const auto channel = static_cast<std::uint16_t>(topic);
  index_[channel].emplace_back(time_ns, chunk_.size());
  std::string message;
  Put(channel, &message);
  Put(static_cast<std::uint32_t>(messages_[topic]++), &message);
  Put(time_ns, &message);  // when it was recorded
  Put(time_ns, &message);  // when it was published
  message.append(data);
  chunk_ += McapRecord(kMcapMessage, message);
  if (chunk_.size() >= kMcapChunkSize) FinishChunk();
}

void McapWriter::FinishChunk() {
  if (index_.empty()) return;
  const std::string records = Compress(compression_, chunk_);
  const std::string_view compression =
      compression_ == Compression::kNone ? "" : ToString(compression_);
  std::string chunk;
  Put(chunk_first_time_, &chunk);
  Put(chunk_last_time_, &chunk);
  Put(static_cast<std::uint64_t>(chunk_.size()), &chunk);
  Put(kNoChecksum, &chunk);
  PutText(compression, &chunk);
  Put(static_cast<std::uint64_t>(records.size()), &chunk);
  chunk.append(records);
  const std::uint64_t chunk_offset = file_.size();
  file_.Append(McapRecord(kMcapChunk, chunk));
  const std::uint64_t index_offset = file_.size();

  std::string offsets;  // of the message indexes
  for (const auto& [channel, messages] : index_) {
    Put(channel, &offsets);
    Put(file_.size(), &offsets);
    std::string entries;
    for (const auto& [time_ns, offset] : messages) {
      Put(time_ns, &entries);
      Put(offset, &entries);
    }
    std::string index;
    Put(channel, &index);
    PutText(entries, &index);
    file_.Append(McapRecord(kMcapMessageIndex, index));
  }

  std::string index;
  Put(chunk_first_time_, &index);
  Put(chunk_last_time_, &index);
  Put(chunk_offset, &index);
  Put(index_offset - chunk_offset, &index);
  PutText(offsets, &index);
  Put(file_.size() - index_offset, &index);
  PutText(compression, &index);
  Put(static_cast<std::uint64_t>(records.size()), &index);
  Put(static_cast<std::uint64_t>(chunk_.size()), &index);
  chunk_indexes_.push_back(McapRecord(kMcapChunkIndex, index));
  chunk_.clear();
  index_.clear();
}

std::string McapWriter::Statistics() const {
  std::string counts;
  std::uint64_t all = 0;
  for (std::size_t topic = 0; topic < messages_.size(); ++topic) {
    Put(static_cast<std::uint16_t>(topic), &counts);
    Put(messages_[topic], &counts);
    all += messages_[topic];
  }
  std::string statistics;
  Put(all, &statistics);
  Put(static_cast<std::uint16_t>(channels_.size()), &statistics);  // schemas
  Put(static_cast<std::uint32_t>(channels_.size()), &statistics);
  Put(std::uint32_t{0}, &statistics);  // attachments
  Put(std::uint32_t{0}, &statistics);  // metadata
  Put(static_cast<std::uint32_t>(chunk_indexes_.size()), &statistics);
  Put(first_time_, &statistics);
  Put(last_time_, &statistics);
  PutText(counts, &statistics);
  return McapRecord(kMcapStatistics, statistics);
}

void McapWriter::Close() {
  FinishChunk();
  std::string data_end;
  Put(kNoChecksum, &data_end);
  file_.Append(McapRecord(kMcapDataEnd, data_end));
  const std::uint64_t summary = file_.size();
  for (const std::string& channel : channels_) file_.Append(channel);
  file_.Append(Statistics());
  for (const std::string& index : chunk_indexes_) file_.Append(index);
  std::string footer;
  Put(summary, &footer);
  Put(std::uint64_t{0}, &footer);  // no offsets within the summary
  Put(kNoChecksum, &footer);
  file_.Append(McapRecord(kMcapFooter, footer));
  file_.Append(kMcapMagic);
  file_.Finish();
}

}  // namespace kestrel
