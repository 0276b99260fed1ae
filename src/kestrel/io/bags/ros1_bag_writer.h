// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "kestrel/io/bags/bag_writer.h"
#include "kestrel/io/bags/growing_file.h"

namespace kestrel {

// Writes a ROS 1 bag, format 2.0, with its index.
class Ros1BagWriter : public BagWriter {
 public:
  Ros1BagWriter(const std::string& path, Compression compression, bool replace);

  WireFormat format() const override { return WireFormat::kRos1; }
  std::size_t AddTopic(const std::string& name, std::string_view type, bool is_latched) override;
  void Write(std::size_t topic, Time time, std::string_view data) override;
  void Close() override;

 private:
  struct IndexEntry {
    std::uint64_t time;  // in the form of a field
    std::uint32_t offset;
  };
  struct ChunkInfo {
    std::uint64_t offset;
    std::uint64_t start;
    std::uint64_t end;
    std::vector<std::pair<std::uint32_t, std::uint32_t>> counts;  // connection, messages
  };
  std::string BagHeader(std::uint64_t index_offset) const;
  void FinishChunk();

  GrowingFile file_;
  Compression compression_;
  std::vector<std::string> connections_;  // the records of the connections
  std::vector<bool> is_announced_;        // in some chunk; by connection
  std::vector<ChunkInfo> chunks_;
  std::string chunk_;
  std::map<std::uint32_t, std::vector<IndexEntry>> index_;  // current chunk, by connection
};

}  // namespace kestrel
