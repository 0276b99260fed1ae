// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "kestrel/app/console/messages/console_feed.h"
#include "kestrel/app/console/telemetry_channel.h"
#include "kestrel/core/codec/jpeg_codec.h"

namespace kestrel {

// A frame as it is sent to browsers.
struct ChannelImage {
  std::shared_ptr<const ConsoleFrame> frame;
  std::size_t view = 0;  // 0: the camera's image, else index in the description's views, from 1
  SharedMessage message;
};

// The state of one browser's images. At most one image is on its way to it.
class ImageFlow {
 public:
  bool wants_next() const { return is_wanted_ && !in_flight_ && !(held() && HasView()); }
  std::size_t view() const { return view_; }
  // Sequence number of the newest frame that was sent in this view; 0: none.
  std::uint64_t seen() const { return HasView() ? frame_->sequence : 0; }
  // The only frame that is wanted; null: the newest one.
  std::shared_ptr<const ConsoleFrame> held() const { return is_held_ ? frame_ : nullptr; }
  std::uint64_t count() const { return count_; }
  // Time from capture until it was drawn, of the newest acknowledged image; nothing before the
  // first.
  std::optional<Duration> draw_time() const { return draw_time_; }

  // 'is_held': only the frame that was sent last is wanted; when none was sent, the next one.
  void SetWish(bool is_wanted, std::size_t view, bool is_held);
  void Sent(const ChannelImage& image);
  // An acknowledgement of any image other than the one on its way has no effect.
  void Acknowledged(std::uint64_t sequence, Time now);

 private:
  bool HasView() const { return frame_ && frame_view_ == view_; }

  std::shared_ptr<const ConsoleFrame> frame_;  // the frame that was sent last,
  std::optional<std::size_t> frame_view_;      // and its view; nothing: the page has no picture
  std::size_t view_ = 0;                       // the wanted view
  bool is_wanted_ = false;
  bool is_held_ = false;
  std::optional<std::uint64_t> in_flight_;
  std::uint64_t count_ = 0;
  std::optional<Duration> draw_time_;
};

// The live image and its views. Each is encoded once for all browsers, and only when one requests
// it. A message is the length of the text (32 bits, lowest byte first), the text (FrameJson) and
// the JPEG. Used by the console's thread.
class ImageChannel {
 public:
  // 'feed' outlives the channel.
  ImageChannel(ConsoleFeed* feed, int jpeg_quality, double max_rate_hz);

  // Finds a view by its name, which is empty for the camera's image; nothing when there is none.
  std::optional<std::size_t> FindView(std::string_view name) const;

  // Returns the image that the browser wants and does not have. Returns nothing when there is none,
  // or when the time for the next image of this view has not come.
  std::optional<ChannelImage> NextFor(const ImageFlow& flow, Time now);

  // Number of encoded images.
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
  std::vector<Stream> streams_;  // one for each view
  // The newest frame that was encoded. It is a copy, as the camera soon reuses the frame's memory.
  std::shared_ptr<const ConsoleFrame> kept_;
  std::optional<Time> held_at_;  // time at which a held frame was encoded
  std::uint64_t encoded_ = 0;
};

}  // namespace kestrel
