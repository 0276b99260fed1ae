// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/io/bags/chunked_bag.h"

#include <algorithm>

#include <fmt/format.h>

#include "kestrel/core/base/error.h"
#include "kestrel/io/bags/checksum.h"

namespace kestrel {
namespace {

// A part of a chunk differs from what was written.
class DamagedChunk : public InputError {
 public:
  using InputError::InputError;
};

}  // namespace

void ChunkedBag::Select(const std::vector<std::size_t>& topics) {
  is_wanted_.assign(topics_.size(), false);
  for (const std::size_t topic : topics) is_wanted_.at(topic) = true;
  next_chunk_ = 0;
  records_.reset();
  has_found_ = false;
  lost_.clear();
}

bool ChunkedBag::Next(BagMessage* message) {
  if (is_wanted_.empty()) return false;
  for (;;) {
    if (records_ && NextMessage(records_.get(), &offset_, message)) {
      has_found_ = true;
      return true;
    }
    records_.reset();
    while (next_chunk_ < chunks_.size() && !HasWanted(chunks_[next_chunk_])) ++next_chunk_;
    if (next_chunk_ == chunks_.size()) break;
    OpenUnlessDamaged(chunks_[next_chunk_++]);
    offset_ = 0;
  }
  if (!has_found_ && !lost_.empty()) throw InputError(lost_);
  return false;
}

void ChunkedBag::OpenUnlessDamaged(const Chunk& chunk) {
  try {
    CheckRecords(chunk, OpenChunk(chunk));
  } catch (const DamagedChunk& damage) {
    records_.reset();
    lost_ = damage.what();
    damages_[chunk.offset] = damage.what();
  }
}

void ChunkedBag::CheckRecords(const Chunk& chunk, ByteSource* records) const {
  if (chunk.checksum == 0 || ChecksumOf(records, records->size()) == chunk.checksum) return;
  throw DamagedChunk(Place(chunk.offset) + ": a chunk is damaged: its checksum is wrong");
}

std::string ChunkedBag::damage() const {
  if (damages_.empty()) return "";
  return fmt::format("{}; left out: {} of {} chunks", damages_.begin()->second, damages_.size(),
                     chunks_.size());
}

bool ChunkedBag::HasWanted(const Chunk& chunk) const {
  return !chunk.has_topics || std::any_of(chunk.topics.begin(), chunk.topics.end(),
                                          [this](std::size_t topic) { return is_wanted_[topic]; });
}

ByteSource* ChunkedBag::OpenChunk(const Chunk& chunk) {
  if (chunk.compression == Compression::kNone) {
    const std::uint64_t size = chunk.records_end.value_or(chunk.stored_size);
    records_ = std::make_unique<BytesPart>(&file_, chunk.offset, size);
  } else {
    DecompressChunk(chunk);
    const std::string_view records = decompressed_;
    records_ = std::make_unique<MemoryBytes>(
        records.substr(0, chunk.records_end.value_or(records.size())));
  }
  return records_.get();
}

void ChunkedBag::DecompressChunk(const Chunk& chunk) {
  // Nothing larger is a chunk, whatever it claims; it is cut off here.
  constexpr std::uint64_t kMaxStored = 1 << 30;
  const std::uint64_t stored_size = std::min(chunk.stored_size, kMaxStored);
  const std::string_view stored = file_.View(chunk.offset, stored_size);
  const std::string place = Place(chunk.offset);
  try {
    Decompress(chunk.compression, stored, chunk.size, place, &decompressed_);
  } catch (const InputError& error) {
    throw DamagedChunk(error.what());
  }
  const bool is_whole = stored.size() == chunk.stored_size;
  if (is_whole && chunk.size && decompressed_.size() < *chunk.size) {
    throw DamagedChunk(place + ": its compressed bytes are broken");
  }
}

void ChunkedBag::CountMessage(std::size_t topic) {
  topics_[topic].messages = topics_[topic].messages.value_or(0) + 1;
}

std::size_t ChunkedBag::TopicOf(const RosTopic& topic) {
  const auto known = std::find_if(topics_.begin(), topics_.end(), [&](const RosTopic& other) {
    return other.name == topic.name && other.type == topic.type &&
           other.wire_format == topic.wire_format;
  });
  if (known != topics_.end()) return static_cast<std::size_t>(known - topics_.begin());
  topics_.push_back(topic);
  return topics_.size() - 1;
}

std::string ChunkedBag::Place(std::uint64_t offset) const {
  return fmt::format("{}: byte {}", path_, offset);
}

void ChunkedBag::SetCutRemark(std::uint64_t offset) {
  remark_ = fmt::format(
      "{}: was not closed, or is damaged (a power loss?): it is read up to there; its last whole "
      "record ends at byte {} of {}",
      path_, offset, file_.size());
}

}  // namespace kestrel
