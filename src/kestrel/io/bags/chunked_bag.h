// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "kestrel/io/bags/bag_reader.h"
#include "kestrel/io/bags/byte_source.h"
#include "kestrel/io/bags/decompression.h"

namespace kestrel {

// The common part of ROS 1 bags and MCAP files: a file with chunks, which are lists of records,
// some of which are messages. The derived class finds the topics and the chunks, and reads the
// records. A chunk that is damaged, by its checksum or its compression, is left out; when nothing
// is left of the selected topics, that is an error.
class ChunkedBag : public BagReader {
 public:
  const std::vector<RosTopic>& topics() const override { return topics_; }
  void Select(const std::vector<std::size_t>& topics) override;
  bool Next(BagMessage* message) override;
  std::string remark() const override { return remark_; }
  std::string damage() const override;

 protected:
  struct Chunk {
    std::uint64_t offset = 0;  // offset of its bytes in the file
    std::uint64_t stored_size = 0;
    Compression compression = Compression::kNone;
    std::optional<std::uint64_t> size;  // decompressed; unknown if the chunk was not finished
    std::uint32_t checksum = 0;         // checksum of the records; 0 if there is none
    // In a damaged bag: end of the records that can be trusted.
    std::optional<std::uint64_t> records_end;
    // Topics (indices) of its messages, if has_topics.
    bool has_topics = false;
    std::vector<std::size_t> topics;
  };

  explicit ChunkedBag(const std::string& path) : path_(path), file_(path) {}

  // Finds the first record from 'offset' on that has a message of a wanted topic. Afterwards
  // 'offset' is behind that record. Returns false at the end, also where the records were cut off.
  virtual bool NextMessage(ByteSource* records, std::uint64_t* offset, BagMessage* message) = 0;

  bool IsWanted(std::size_t topic) const { return is_wanted_[topic]; }

  // Returns the records of a chunk, decompressed if necessary; valid until the next call. Throws
  // InputError when they cannot be decompressed, even if the checksum is right.
  ByteSource* OpenChunk(const Chunk& chunk);

  // Returns the index of the topic with this name and type; adds it when it is new.
  std::size_t TopicOf(const RosTopic& topic);

  void CountMessage(std::size_t topic);

  // Returns "flight.bag: byte 4711", for messages.
  std::string Place(std::uint64_t offset) const;

  // Records that the file was cut off or not closed, and that its last whole record ends at
  // 'offset'.
  void SetCutRemark(std::uint64_t offset);

  void SetRemark(const std::string& remark) { remark_ = remark; }

  const std::string& path() const { return path_; }
  FileBytes& file() { return file_; }
  std::vector<Chunk>& chunks() { return chunks_; }
  std::vector<RosTopic>& mutable_topics() { return topics_; }

 private:
  bool HasWanted(const Chunk& chunk) const;
  void DecompressChunk(const Chunk& chunk);
  void CheckRecords(const Chunk& chunk, ByteSource* records) const;
  void OpenUnlessDamaged(const Chunk& chunk);

  std::string path_;
  FileBytes file_;
  std::vector<RosTopic> topics_;
  std::vector<Chunk> chunks_;  // in the order of the file
  std::string remark_;

  std::map<std::uint64_t, std::string> damages_;  // errors in chunks, by offset

  std::vector<bool> is_wanted_;  // by topic
  bool has_found_ = false;       // a message of these topics was found
  std::string lost_;             // the last damage that was met
  std::size_t next_chunk_ = 0;
  std::string decompressed_;             // the records that are being read, or
  std::unique_ptr<ByteSource> records_;  // their source; null between chunks
  std::uint64_t offset_ = 0;             // offset of the next record
};

}  // namespace kestrel
