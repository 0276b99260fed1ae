// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>

#include "kestrel/io/bags/chunked_bag.h"

namespace kestrel {

// First and last bytes of an MCAP file.
inline constexpr std::string_view kMcapMagic("\x89MCAP0\r\n", 8);

// Reads an MCAP file (mcap.dev/spec) with messages of ROS 2 or ROS 1: in chunks without
// compression, with lz4 or zstd, or without chunks. A file without a summary is read through once
// at the start; a file that was cut off is read up to the cut.
class McapReader : public ChunkedBag {
 public:
  // Throws InputError when the file is not an MCAP file or is broken.
  explicit McapReader(const std::string& path);

 protected:
  bool NextMessage(ByteSource* records, std::uint64_t* offset, BagMessage* message) override;

 private:
  struct Record;
  struct Schema {
    std::string name;
    std::string encoding;
  };
  bool ReadRecord(ByteSource* records, std::uint64_t offset, Record* record) const;

  bool HasEndMagic();
  bool IsIntact(std::uint64_t offset, std::uint64_t size, std::uint32_t checksum);
  void CheckData(const Record& data_end);
  bool ReadSummary();
  bool ReadSummaryRecords(std::uint64_t offset, std::uint64_t end);
  void ReadThrough();
  void ReadRecordsThrough(ByteSource* records, Chunk chunk);
  Chunk ReadChunkHead(const Record& record, bool is_cut = false);
  void AddSchema(std::string_view content, const std::string& name);
  void AddChannel(std::string_view content, const std::string& name);
  std::size_t TopicOfChannel(std::uint16_t channel, const std::string& name) const;
  void SetMessageCounts(std::string_view counts, const std::string& name);

  std::map<std::uint16_t, Schema> schemas_;
  std::map<std::uint16_t, std::size_t> topics_of_channels_;
};

}  // namespace kestrel
