// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "kestrel/bags/bag_writer.h"
#include "kestrel/bags/growing_file.h"

namespace kestrel {

// Writes an MCAP file with the profile of ROS 2: chunks, their indexes and the summary.
class McapWriter : public BagWriter {
 public:
  McapWriter(const std::string& path, Compression compression, bool replace);

  WireFormat format() const override { return WireFormat::kCdr; }
  std::size_t AddTopic(const std::string& name, std::string_view type, bool is_latched) override;
  void Write(std::size_t topic, Time time, std::string_view data) override;
  void Close() override;

 private:
  using MessageIndex = std::vector<std::pair<std::int64_t, std::uint64_t>>;  // time, offset
  void FinishChunk();
  std::string Statistics() const;

  GrowingFile file_;
  Compression compression_;
  std::vector<std::string> channels_;    // the records of schema and channel, by topic
  std::vector<std::uint64_t> messages_;  // by topic
  std::vector<bool> is_announced_;       // in some chunk
  std::vector<std::string> chunk_indexes_;
  std::int64_t first_time_ = 0;  // of all messages
  std::int64_t last_time_ = 0;

  std::string chunk_;
  std::map<std::uint16_t, MessageIndex> index_;  // of the chunk, by channel
  std::int64_t chunk_first_time_ = 0;
  std::int64_t chunk_last_time_ = 0;
};

}  // namespace kestrel
