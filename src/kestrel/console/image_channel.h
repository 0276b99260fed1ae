// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>

#include "kestrel/console/console_feed.h"
#include "kestrel/console/jpeg_encoder.h"
#include "kestrel/console/telemetry_channel.h"

namespace kestrel {

// The live image, made into a message once for all browsers, and only when one asks for it: the
// length of the text (32 bits, lowest byte first), the text (FrameJson), the JPEG. By the console's
// thread.
class ImageChannel {
 public:
  struct Image {
    std::uint64_t sequence = 0;
    Time captured;
    SharedMessage message;
  };

  // 'feed' outlives the channel.
  ImageChannel(ConsoleFeed* feed, int jpeg_quality, double max_rate_hz);

  // The newest image, for a browser that has seen 'seen'; nothing when there is none after that, or
  // before it is time for one.
  std::optional<Image> NewestAfter(std::uint64_t seen, Time now);

  // How many were made into messages.
  std::uint64_t encoded() const { return encoded_; }

 private:
  void Encode(const ConsoleFrame& frame, Time now);

  ConsoleFeed* feed_;
  JpegEncoder encoder_;
  Duration min_interval_;
  std::optional<Time> encoded_at_;
  Image newest_;
  std::uint64_t encoded_ = 0;
};

// What a browser has of the images: one is on its way at most.
class ImageFlow {
 public:
  bool wants_next() const { return is_wanted_ && !is_in_flight_; }
  std::uint64_t seen() const { return sent_.sequence; }
  std::uint64_t count() const { return count_; }
  // From capture until it was drawn, of the newest that was; nothing before the first.
  std::optional<Duration> draw_time() const { return draw_time_; }

  void SetWanted(bool is_wanted) { is_wanted_ = is_wanted; }
  void Sent(const ImageChannel::Image& image) {
    sent_ = image;
    sent_.message.reset();
    is_in_flight_ = true;
    ++count_;
  }
  // An acknowledgement of anything but the image on its way does nothing.
  void Acknowledged(std::uint64_t sequence, Time now) {
    if (!is_in_flight_ || sequence != sent_.sequence) return;
    is_in_flight_ = false;
    draw_time_ = now - sent_.captured;
  }

 private:
  ImageChannel::Image sent_;
  bool is_wanted_ = false;
  bool is_in_flight_ = false;
  std::uint64_t count_ = 0;
  std::optional<Duration> draw_time_;
};

}  // namespace kestrel
