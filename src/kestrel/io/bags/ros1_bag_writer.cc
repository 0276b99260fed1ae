// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/io/bags/ros1_bag_writer.h"

#include <algorithm>
#include <concepts>
#include <utility>

#include <fmt/format.h>

#include "kestrel/core/base/bytes.h"
#include "kestrel/io/bags/compression.h"
#include "kestrel/io/bags/ros1_bag.h"
#include "kestrel/io/ros_messages/message_definitions.h"

namespace kestrel {
namespace {

constexpr std::size_t kRos1ChunkSize = 768 << 10;  // the same as in rosbag
constexpr std::uint32_t kIndexVersion = 1;
// Kinds of records, in the field "op" of their header.
constexpr std::uint8_t kMessageRecord = 2;
constexpr std::uint8_t kBagHeaderRecord = 3;
constexpr std::uint8_t kIndexRecord = 4;
constexpr std::uint8_t kChunkRecord = 5;
constexpr std::uint8_t kChunkInfoRecord = 6;
constexpr std::uint8_t kConnectionRecord = 7;

// The fields "name=value" of a header.
class FieldWriter {
 public:
  FieldWriter() = default;
  explicit FieldWriter(std::uint8_t kind) { Add("op", kind); }

  FieldWriter& Add(std::string_view name, std::string_view value) {
    PutText(fmt::format("{}={}", name, value), &bytes_);
    return *this;
  }
  template <std::integral Number>
  FieldWriter& Add(std::string_view name, Number number) {
    std::string value;
    Put(number, &value);
    return Add(name, value);
  }
  const std::string& bytes() const { return bytes_; }

 private:
  std::string bytes_;
};

std::string RecordOf(const FieldWriter& header, std::string_view data) {
  std::string record;
  PutText(header.bytes(), &record);
  PutText(data, &record);
  return record;
}

// Converts to a time of ROS 1: the lower 32 bits are seconds, the upper ones nanoseconds.
std::uint64_t FieldOfTime(Time time) {
  constexpr std::int64_t kSecond_ns = 1'000'000'000;
  const auto ns = static_cast<std::uint64_t>(ToNanoseconds(time));
  return ns / kSecond_ns | (ns % kSecond_ns) << 32;
}

// Compares two fields by time: the nanoseconds are in the upper bits.
bool IsEarlier(std::uint64_t a, std::uint64_t b) {
  return std::pair(a & 0xffffffff, a >> 32) < std::pair(b & 0xffffffff, b >> 32);
}

}  // namespace

Ros1BagWriter::Ros1BagWriter(const std::string& path, Compression compression, bool replace)
    : file_(path, replace), compression_(compression) {
  file_.Append(kRos1BagMagic);
  file_.Append(BagHeader(/*index_offset=*/0));
}

// The record always has the same size, because it is written again at the end.
std::string Ros1BagWriter::BagHeader(std::uint64_t index_offset) const {
  constexpr std::size_t kSize = 4096;
  FieldWriter header(kBagHeaderRecord);
  header.Add("index_pos", index_offset)
      .Add("conn_count", static_cast<std::uint32_t>(connections_.size()))
      .Add("chunk_count", static_cast<std::uint32_t>(chunks_.size()));
  const std::size_t lengths = 2 * sizeof(std::uint32_t);
  return RecordOf(header, std::string(kSize - lengths - header.bytes().size(), ' '));
}

std::size_t Ros1BagWriter::AddTopic(const std::string& name, std::string_view type,
                                    bool is_latched) {
  FieldWriter header(kConnectionRecord);
  header.Add("conn", static_cast<std::uint32_t>(connections_.size())).Add("topic", name);
  FieldWriter data;
  data.Add("topic", name)
      .Add("type", type)
      .Add("md5sum", MessageChecksum(type))
      .Add("message_definition", MessageDefinition(type, WireFormat::kRos1));
  if (is_latched) data.Add("latching", "1");
  connections_.push_back(RecordOf(header, data.bytes()));
  is_announced_.push_back(false);
  return connections_.size() - 1;
}

void Ros1BagWriter::Write(std::size_t topic, Time time, std::string_view data) {
  if (!is_announced_[topic]) chunk_ += connections_[topic];
  is_announced_[topic] = true;
  const auto connection = static_cast<std::uint32_t>(topic);
  index_[connection].push_back({FieldOfTime(time), static_cast<std::uint32_t>(chunk_.size())});
  FieldWriter header(kMessageRecord);
  header.Add("conn", connection).Add("time", FieldOfTime(time));
  chunk_ += RecordOf(header, data);
  if (chunk_.size() >= kRos1ChunkSize) FinishChunk();
}

void Ros1BagWriter::FinishChunk() {
  if (chunk_.empty()) return;
  const std::uint64_t first = index_.begin()->second.front().time;
  ChunkInfo info{file_.size(), first, first, {}};
  FieldWriter header(kChunkRecord);
  header.Add("compression", ToString(compression_))
      .Add("size", static_cast<std::uint32_t>(chunk_.size()));
  file_.Append(RecordOf(header, Compress(compression_, chunk_)));
  for (const auto& [connection, entries] : index_) {
    FieldWriter index_header(kIndexRecord);
    index_header.Add("ver", kIndexVersion)
        .Add("conn", connection)
        .Add("count", static_cast<std::uint32_t>(entries.size()));
    std::string data;
    for (const IndexEntry& entry : entries) {
      Put(entry.time, &data);
      Put(entry.offset, &data);
      info.start = std::min(info.start, entry.time, IsEarlier);
      info.end = std::max(info.end, entry.time, IsEarlier);
    }
    file_.Append(RecordOf(index_header, data));
    info.counts.emplace_back(connection, static_cast<std::uint32_t>(entries.size()));
  }
  chunks_.push_back(std::move(info));
  chunk_.clear();
  index_.clear();
}

void Ros1BagWriter::Close() {
  FinishChunk();
  const std::uint64_t index_offset = file_.size();
  for (const std::string& connection : connections_) file_.Append(connection);
  for (const ChunkInfo& info : chunks_) {
    FieldWriter header(kChunkInfoRecord);
    header.Add("ver", kIndexVersion)
        .Add("chunk_pos", info.offset)
        .Add("start_time", info.start)
        .Add("end_time", info.end)
        .Add("count", static_cast<std::uint32_t>(info.counts.size()));
    std::string data;
    for (const auto& [connection, count] : info.counts) {
      Put(connection, &data);
      Put(count, &data);
    }
    file_.Append(RecordOf(header, data));
  }
  file_.Overwrite(kRos1BagMagic.size(), BagHeader(index_offset));
  file_.Finish();
}

}  // namespace kestrel
