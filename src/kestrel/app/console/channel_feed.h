// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "kestrel/core/base/bounded_queue.h"
#include "kestrel/core/base/time.h"

namespace kestrel {

// A kind of messages that a viewer, as Foxglove, can subscribe to.
struct LiveChannel {
  std::string topic;            // as "/camera/image"
  std::string encoding;         // of messages, as "protobuf"
  std::string schema_name;      // as "foxglove.CompressedImage"
  std::string schema_encoding;  // as "protobuf"
  std::string schema;           // its bytes
  // Large messages, of which only the newest is worth something: a slow viewer loses these first.
  bool is_image = false;
};

struct ChannelMessage {
  std::size_t channel = 0;  // index in ChannelFeed::channels()
  Time time;
  std::shared_ptr<const std::string> content;
};

// The hand-over of messages between a program that flies and the console's thread, which gives them
// to viewers. The program never waits: of too many messages the oldest is lost.
class ChannelFeed {
 public:
  // 'channels': at most 64, with topics of their own.
  explicit ChannelFeed(std::vector<LiveChannel> channels);

  const std::vector<LiveChannel>& channels() const { return channels_; }

  // The program's side, by any thread.

  // Whether anybody has subscribed to anything: else frames need not be looked at.
  bool IsWatched() const { return wanted_.load(std::memory_order_relaxed) != 0; }
  // Whether anybody has subscribed to that channel: else its messages need not be made.
  bool IsWanted(std::size_t channel) const {
    return (wanted_.load(std::memory_order_relaxed) >> channel & 1) != 0;
  }
  void Add(ChannelMessage message) { messages_.Push(std::move(message)); }

  // The console's side, by its thread.

  // A bit for each channel, the lowest for the first.
  void SetWanted(std::uint64_t channels) { wanted_.store(channels, std::memory_order_relaxed); }
  std::optional<ChannelMessage> Take() { return messages_.TryPop(); }

 private:
  std::vector<LiveChannel> channels_;
  std::atomic<std::uint64_t> wanted_{0};
  BoundedQueue<ChannelMessage> messages_;
};

}  // namespace kestrel
