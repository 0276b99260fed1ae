// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "kestrel/core/base/time.h"
#include "kestrel/io/bags/decompression.h"
#include "kestrel/io/bags/growing_file.h"

namespace kestrel {

// A topic of an MCAP file; the names of the fields are those of mcap.dev/spec.
struct McapChannel {
  std::string topic;
  std::string message_encoding;  // "cdr", "protobuf"
  std::string schema_name;
  std::string schema_encoding;  // "ros2msg", "protobuf"
  std::string schema;           // bytes
  std::vector<std::pair<std::string, std::string>> metadata = {};
};

struct McapFileOptions {
  std::string profile = {};  // convention of the content: "ros2", or "" for none
  Compression compression = Compression::kNone;
  bool replace = false;  // replace an existing file
  UnfinishedName name = UnfinishedName::kPart;
};

// Writes an MCAP file: chunks of about a megabyte and at most one second, each written at once with
// its indexes, and the summary. All functions throw InputError when it cannot be written.
class McapFile {
 public:
  McapFile(const std::string& path, const McapFileOptions& options);

  // Returns the index of the channel.
  std::size_t AddChannel(const McapChannel& channel);

  // Adds a message of a channel that was recorded at 'time'.
  void Write(std::size_t channel, Time time, std::string_view data);

  // Writes the messages that wait for their chunk to be full.
  void FinishChunk();

  // Completes the file; nothing can be written after it. Without Close the file has no summary, or
  // is discarded with UnfinishedName::kPart.
  void Close();

 private:
  using MessageIndex = std::vector<std::pair<std::int64_t, std::uint64_t>>;  // time, offset
  void Append(std::string_view bytes);
  void StretchTimes(std::int64_t time_ns);
  std::string ChunkRecord(std::string_view stored) const;
  std::string ChunkIndexRecord(std::uint64_t chunk_offset, std::uint64_t index_offset,
                               const std::string& offsets, std::size_t stored_size) const;
  std::string Statistics() const;

  GrowingFile file_;
  std::uint32_t checksum_ = 0;  // checksum of the whole file so far
  Compression compression_;
  std::vector<std::string> channels_;    // the records of schema and channel
  std::vector<std::uint64_t> messages_;  // by channel
  bool has_messages_ = false;
  std::vector<bool> is_announced_;  // in some chunk; by channel
  std::vector<std::string> chunk_indexes_;
  std::int64_t first_time_ = 0;  // time of the first message
  std::int64_t last_time_ = 0;

  std::string chunk_;
  std::map<std::uint16_t, MessageIndex> index_;  // index of the current chunk, by channel
  std::int64_t chunk_first_time_ = 0;
  std::int64_t chunk_last_time_ = 0;
};

}  // namespace kestrel
