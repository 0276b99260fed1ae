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

// What ROS 1 bags and MCAP files have in common: a file with chunks, which are lists of records,
// some of which are messages. Who derives from it finds the topics and the chunks, and knows the
// records. A chunk that is damaged, by its checksum or its compression, is left out; where nothing
// is left of what was selected, that is an error.
class ChunkedBag : public BagReader {
 public:
  const std::vector<BagTopic>& topics() const override { return topics_; }
  void Select(const std::vector<std::size_t>& topics) override;
  bool Next(BagMessage* message) override;
  std::string remark() const override { return remark_; }
  std::string damage() const override;

 protected:
  struct Chunk {
    std::uint64_t offset = 0;  // of its bytes in the file
    std::uint64_t stored_size = 0;
    Compression compression = Compression::kNone;
    std::optional<std::uint64_t> size;  // decompressed; not known of one that was not finished
    std::uint32_t checksum = 0;         // of the records; 0 where there is none
    // Up to where the records can be trusted, of a bag that was damaged.
    std::optional<std::uint64_t> records_end;
    // The topics (indices) of which it has messages, where that is known.
    bool has_topics = false;
    std::vector<std::size_t> topics;
  };

  explicit ChunkedBag(const std::string& path) : path_(path), file_(path) {}

  // The message that the first of the records from 'offset' on is which has one of a topic that
  // 'is_wanted' says; 'offset' is then behind it. False at the end, which is where the records were
  // cut off, too.
  virtual bool NextMessage(ByteSource* records, std::uint64_t* offset, BagMessage* message) = 0;

  bool IsWanted(std::size_t topic) const { return is_wanted_[topic]; }

  // The records of a chunk, decompressed when they have to be; valid until the next call. Throws
  // InputError when they cannot be, whatever the checksum says.
  ByteSource* OpenChunk(const Chunk& chunk);

  // Index of the topic with this name and type, which is added when it is new.
  std::size_t TopicOf(const BagTopic& topic);

  void CountMessage(std::size_t topic);

  // "flight.bag: byte 4711": for messages.
  std::string Place(std::uint64_t offset) const;

  // Says that the file was cut off, or not closed, with the last whole record ending at 'offset'.
  void SetCutRemark(std::uint64_t offset);

  void SetRemark(const std::string& remark) { remark_ = remark; }

  const std::string& path() const { return path_; }
  FileBytes& file() { return file_; }
  std::vector<Chunk>& chunks() { return chunks_; }
  std::vector<BagTopic>& mutable_topics() { return topics_; }

 private:
  bool HasWanted(const Chunk& chunk) const;
  void DecompressChunk(const Chunk& chunk);
  void CheckRecords(const Chunk& chunk, ByteSource* records) const;
  void OpenUnlessDamaged(const Chunk& chunk);

  std::string path_;
  FileBytes file_;
  std::vector<BagTopic> topics_;
  std::vector<Chunk> chunks_;  // in the order of the file
  std::string remark_;

  std::map<std::uint64_t, std::string> damages_;  // what is wrong with chunks, by their offset

  std::vector<bool> is_wanted_;  // by topic
  bool has_found_ = false;       // some message of these
  std::string lost_;             // the last damage that was met
  std::size_t next_chunk_ = 0;
  std::string decompressed_;             // the records that are read, or
  std::unique_ptr<ByteSource> records_;  // where they are; null between chunks
  std::uint64_t offset_ = 0;             // of the next record
};

}  // namespace kestrel
