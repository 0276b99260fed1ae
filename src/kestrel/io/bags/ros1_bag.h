// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <map>
#include <string>

#include "kestrel/io/bags/chunked_bag.h"

namespace kestrel {

// First bytes of a ROS 1 bag.
inline constexpr std::string_view kRos1BagMagic = "#ROSBAG V2.0\n";

// Reads a ROS 1 bag, format 2.0, with chunks without compression, with bz2 or lz4. A bag without a
// valid index is read through once at the start; one that was cut off is read up to the cut.
class Ros1Bag : public ChunkedBag {
 public:
  // Throws InputError when the file is not a ROS 1 bag, is broken or is encrypted.
  explicit Ros1Bag(const std::string& path);

 protected:
  bool NextMessage(ByteSource* records, std::uint64_t* offset, BagMessage* message) override;

 private:
  struct Record;
  enum class RecordStatus { kOk, kCut };
  RecordStatus ReadRecord(ByteSource* records, std::uint64_t offset, Record* record) const;

  bool ReadIndex(std::uint64_t index_offset);
  void ReadThrough(std::uint64_t offset);
  void ReadChunkThrough(Chunk chunk);
  void AddConnection(const Record& record, ByteSource* records);
  std::size_t TopicOfConnection(std::uint32_t connection, std::uint64_t offset) const;
  static Chunk ReadChunkHead(const Record& record);

  std::map<std::uint32_t, std::size_t> topics_of_connections_;
};

}  // namespace kestrel
