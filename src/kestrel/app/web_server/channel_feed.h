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

// A channel of messages that a viewer such as Foxglove can subscribe to.
struct LiveChannel {
  std::string topic;            // as "/camera/image"
  std::string encoding;         // message encoding, as "protobuf"
  std::string schema_name;      // as "foxglove.CompressedImage"
  std::string schema_encoding;  // as "protobuf"
  std::string schema;           // bytes of the schema
  // Large messages of which only the newest matters: a slow viewer loses these first.
  bool is_image = false;
};

struct ChannelMessage {
  std::size_t channel = 0;  // index in ChannelFeed::channels()
  Time time;
  std::shared_ptr<const std::string> content;
};

// Passes messages from a program that flies to the console's thread, which sends them to viewers.
// The program never waits: when the queue is full the oldest message is dropped.
class ChannelFeed {
 public:
  // 'channels': at most 64, each with a different topic.
  explicit ChannelFeed(std::vector<LiveChannel> channels);

  const std::vector<LiveChannel>& channels() const { return channels_; }

  // The program's side. Any thread may call these.

  // True when a viewer has subscribed to any channel. Otherwise frames need not be processed.
  bool IsWatched() const { return wanted_.load(std::memory_order_relaxed) != 0; }
  // True when a viewer has subscribed to this channel. Otherwise its messages need not be made.
  bool IsWanted(std::size_t channel) const {
    return (wanted_.load(std::memory_order_relaxed) >> channel & 1) != 0;
  }
  void Add(ChannelMessage message) { messages_.Push(std::move(message)); }

  // The console's side. Called by its thread only.

  // 'channels': one bit per channel, the lowest bit for the first channel.
  void SetWanted(std::uint64_t channels) { wanted_.store(channels, std::memory_order_relaxed); }
  std::optional<ChannelMessage> Take() { return messages_.TryPop(); }

 private:
  std::vector<LiveChannel> channels_;
  std::atomic<std::uint64_t> wanted_{0};
  BoundedQueue<ChannelMessage> messages_;
};

}  // namespace kestrel
