// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "kestrel/app/console/console_feed.h"
#include "kestrel/app/console/telemetry_channel.h"
#include "kestrel/core/codec/jpeg_codec.h"

namespace kestrel {

// A frame as a browser gets it.
struct ChannelImage {
  std::shared_ptr<const ConsoleFrame> frame;
  std::size_t view = 0;  // 0: the camera's image, else of the description's views, from 1
  SharedMessage message;
};

// What a browser has of the images: one is on its way at most.
class ImageFlow {
 public:
  bool wants_next() const { return is_wanted_ && !in_flight_ && !(held() && HasView()); }
  std::size_t view() const { return view_; }
  // The newest frame that was sent in this view; 0: none.
  std::uint64_t seen() const { return HasView() ? frame_->sequence : 0; }
  // No other frame than this one is wanted; null: the newest.
  std::shared_ptr<const ConsoleFrame> held() const { return is_held_ ? frame_ : nullptr; }
  std::uint64_t count() const { return count_; }
  // From capture until it was drawn, of the newest that was; nothing before the first.
  std::optional<Duration> draw_time() const { return draw_time_; }

  // 'is_held': no other frame than the one that was sent last; when none was, than the next.
  void SetWish(bool is_wanted, std::size_t view, bool is_held);
  void Sent(const ChannelImage& image);
  // An acknowledgement of anything but the image on its way does nothing.
  void Acknowledged(std::uint64_t sequence, Time now);

 private:
  bool HasView() const { return frame_ && frame_view_ == view_; }

  std::shared_ptr<const ConsoleFrame> frame_;  // that was sent last,
  std::optional<std::size_t> frame_view_;      // in this view; nothing: it has none any more
  std::size_t view_ = 0;                       // that is wanted
  bool is_wanted_ = false;
  bool is_held_ = false;
  std::optional<std::uint64_t> in_flight_;
  std::uint64_t count_ = 0;
  std::optional<Duration> draw_time_;
};

// The live image and the views of it, each made into a message once for all browsers, and only when
// one asks for it: the length of the text (32 bits, lowest byte first), the text (FrameJson), the
// JPEG. By the console's thread.
class ImageChannel {
 public:
  // 'feed' outlives the channel.
  ImageChannel(ConsoleFeed* feed, int jpeg_quality, double max_rate_hz);

  // By its name, empty for the camera's image; nothing when there is none of that name.
  std::optional<std::size_t> FindView(std::string_view name) const;

  // What the browser wants and does not have; nothing when there is none, or before it is time for
  // one of this view.
  std::optional<ChannelImage> NextFor(const ImageFlow& flow, Time now);

  // How many were made into messages.
  std::uint64_t encoded() const { return encoded_; }

 private:
  struct Stream {
    ChannelImage newest;
    std::optional<Time> encoded_at;
  };

  std::optional<ChannelImage> Newest(const ImageFlow& flow, Time now);
  std::optional<ChannelImage> Held(const ImageFlow& flow, Time now);
  const std::shared_ptr<const ConsoleFrame>& Kept(const ConsoleFrame& frame);
  SharedMessage Encode(const ConsoleFrame& frame, std::size_t view, Time now);
  bool IsDue(const std::optional<Time>& last, Time now) const {
    return !last || now - *last >= min_interval_;
  }

  ConsoleFeed* feed_;
  JpegEncoder encoder_;
  Duration min_interval_;
  std::vector<Stream> streams_;  // of each view
  // The newest frame that was encoded; a copy, as the camera's memory is soon wanted again.
  std::shared_ptr<const ConsoleFrame> kept_;
  std::optional<Time> held_at_;  // when a held frame was encoded
  std::uint64_t encoded_ = 0;
};

}  // namespace kestrel
