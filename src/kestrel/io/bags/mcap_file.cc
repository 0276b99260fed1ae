// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/io/bags/mcap_file.h"

#include <algorithm>

#include "kestrel/core/base/bytes.h"
#include "kestrel/io/bags/checksum.h"
#include "kestrel/io/bags/compression.h"
#include "kestrel/io/bags/mcap_opcodes.h"
#include "kestrel/io/bags/mcap_reader.h"

namespace kestrel {
namespace {

constexpr std::size_t kMcapChunkSize = 1 << 20;
constexpr std::int64_t kMcapChunk_ns = 1'000'000'000;  // limit of what a crash can lose

std::string McapRecord(std::uint8_t opcode, std::string_view content) {
  std::string record;
  Put(opcode, &record);
  Put(static_cast<std::uint64_t>(content.size()), &record);
  record.append(content);
  return record;
}

// The name of a compression in the records and indexes of chunks.
std::string_view NameOf(Compression compression) {
  return compression == Compression::kNone ? "" : ToString(compression);
}

}  // namespace

McapFile::McapFile(const std::string& path, const McapFileOptions& options)
    : file_(path, options.replace, options.name), compression_(options.compression) {
  Append(kMcapMagic);
  std::string header;
  PutText(options.profile, &header);
  PutText("kestrel", &header);
  Append(McapRecord(kMcapHeader, header));
}

void McapFile::Append(std::string_view bytes) {
  checksum_ = Checksum(bytes, checksum_);
  file_.Append(bytes);
}

std::size_t McapFile::AddChannel(const McapChannel& channel) {
  const auto id = static_cast<std::uint16_t>(channels_.size());
  const auto schema_id = static_cast<std::uint16_t>(id + 1);  // 0 is no schema
  std::string schema;
  Put(schema_id, &schema);
  PutText(channel.schema_name, &schema);
  PutText(channel.schema_encoding, &schema);
  PutText(channel.schema, &schema);
  std::string metadata;
  for (const auto& [key, value] : channel.metadata) {
    PutText(key, &metadata);
    PutText(value, &metadata);
  }
  std::string record;
  Put(id, &record);
  Put(schema_id, &record);
  PutText(channel.topic, &record);
  PutText(channel.message_encoding, &record);
  PutText(metadata, &record);
  channels_.push_back(McapRecord(kMcapSchema, schema) + McapRecord(kMcapChannel, record));
  messages_.push_back(0);
  is_announced_.push_back(false);
  return id;
}

void McapFile::Write(std::size_t channel, Time time, std::string_view data) {
  const std::int64_t time_ns = ToNanoseconds(time);
  if (!index_.empty() &&
      std::max(chunk_last_time_, time_ns) - std::min(chunk_first_time_, time_ns) > kMcapChunk_ns) {
    FinishChunk();
  }
  StretchTimes(time_ns);
  if (!is_announced_[channel]) chunk_ += channels_[channel];
  is_announced_[channel] = true;

  const auto id = static_cast<std::uint16_t>(channel);
  index_[id].emplace_back(time_ns, chunk_.size());
  std::string message;
  Put(id, &message);
  Put(static_cast<std::uint32_t>(messages_[channel]++), &message);
  Put(time_ns, &message);  // time of recording
  Put(time_ns, &message);  // time of publication
  message.append(data);
  chunk_ += McapRecord(kMcapMessage, message);
  if (chunk_.size() >= kMcapChunkSize) FinishChunk();
}

// Extends the range of times of the file and of the chunk.
void McapFile::StretchTimes(std::int64_t time_ns) {
  first_time_ = has_messages_ ? std::min(first_time_, time_ns) : time_ns;
  last_time_ = has_messages_ ? std::max(last_time_, time_ns) : time_ns;
  has_messages_ = true;
  chunk_first_time_ = index_.empty() ? time_ns : std::min(chunk_first_time_, time_ns);
  chunk_last_time_ = index_.empty() ? time_ns : std::max(chunk_last_time_, time_ns);
}

std::string McapFile::ChunkRecord(std::string_view stored) const {
  std::string chunk;
  Put(chunk_first_time_, &chunk);
  Put(chunk_last_time_, &chunk);
  Put(static_cast<std::uint64_t>(chunk_.size()), &chunk);
  Put(Checksum(chunk_), &chunk);
  PutText(NameOf(compression_), &chunk);
  Put(static_cast<std::uint64_t>(stored.size()), &chunk);
  chunk.append(stored);
  return McapRecord(kMcapChunk, chunk);
}

std::string McapFile::ChunkIndexRecord(std::uint64_t chunk_offset, std::uint64_t index_offset,
                                       const std::string& offsets, std::size_t stored_size) const {
  std::string index;
  Put(chunk_first_time_, &index);
  Put(chunk_last_time_, &index);
  Put(chunk_offset, &index);
  Put(index_offset - chunk_offset, &index);
  PutText(offsets, &index);
  Put(file_.size() - index_offset, &index);
  PutText(NameOf(compression_), &index);
  Put(static_cast<std::uint64_t>(stored_size), &index);
  Put(static_cast<std::uint64_t>(chunk_.size()), &index);
  return McapRecord(kMcapChunkIndex, index);
}

void McapFile::FinishChunk() {
  if (index_.empty()) return;
  const std::string stored = Compress(compression_, chunk_);
  const std::uint64_t chunk_offset = file_.size();
  Append(ChunkRecord(stored));
  const std::uint64_t index_offset = file_.size();
  std::string offsets;  // offsets of the message indexes
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
    Append(McapRecord(kMcapMessageIndex, index));
  }
  chunk_indexes_.push_back(ChunkIndexRecord(chunk_offset, index_offset, offsets, stored.size()));
  chunk_.clear();
  index_.clear();
  file_.Flush();
}

std::string McapFile::Statistics() const {
  std::string counts;
  std::uint64_t all = 0;
  for (std::size_t channel = 0; channel < messages_.size(); ++channel) {
    Put(static_cast<std::uint16_t>(channel), &counts);
    Put(messages_[channel], &counts);
    all += messages_[channel];
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

void McapFile::Close() {
  FinishChunk();
  std::string data_end;
  Put(checksum_, &data_end);
  Append(McapRecord(kMcapDataEnd, data_end));

  const std::uint64_t summary_offset = file_.size();
  std::string summary;
  for (const std::string& channel : channels_) summary += channel;
  summary += Statistics();
  for (const std::string& index : chunk_indexes_) summary += index;
  std::string footer;
  Put(summary_offset, &footer);
  Put(std::uint64_t{0}, &footer);  // no offsets within the summary
  Put(std::uint32_t{0}, &footer);  // place of the checksum
  summary += McapRecord(kMcapFooter, footer);
  summary.resize(summary.size() - sizeof(std::uint32_t));
  Put(Checksum(summary), &summary);
  Append(summary);
  Append(kMcapMagic);
  file_.Finish();
}

}  // namespace kestrel
