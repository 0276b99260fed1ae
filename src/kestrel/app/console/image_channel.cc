// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/console/image_channel.h"

#include <utility>

#include "kestrel/app/console/messages/console_json.h"
#include "kestrel/core/base/bytes.h"

namespace kestrel {

void ImageFlow::SetWish(bool is_wanted, std::size_t view, bool is_held) {
  is_wanted_ = is_wanted;
  view_ = view;
  is_held_ = is_held;
  if (!is_wanted) frame_view_.reset();  // a page that is shown again has no picture
}

void ImageFlow::Sent(const ChannelImage& image) {
  frame_ = image.frame;
  frame_view_ = image.view;
  in_flight_ = frame_->sequence;
  ++count_;
}

void ImageFlow::Acknowledged(std::uint64_t sequence, Time now) {
  if (in_flight_ != sequence) return;
  in_flight_.reset();
  if (!is_held_) draw_time_ = now - frame_->captured;
}

ImageChannel::ImageChannel(ConsoleFeed* feed, int jpeg_quality, double max_rate_hz)
    : feed_(feed),
      encoder_(jpeg_quality),
      min_interval_(DurationFromSeconds(1 / max_rate_hz)),
      streams_(1 + feed->description().views.size()) {}

std::optional<std::size_t> ImageChannel::FindView(std::string_view name) const {
  if (name.empty()) return 0;
  const std::vector<ImageView>& views = feed_->description().views;
  for (std::size_t i = 0; i < views.size(); ++i) {
    if (views[i].name == name) return 1 + i;
  }
  return std::nullopt;
}

std::optional<ChannelImage> ImageChannel::NextFor(const ImageFlow& flow, Time now) {
  if (!flow.wants_next()) return std::nullopt;
  return flow.held() ? Held(flow, now) : Newest(flow, now);
}

std::optional<ChannelImage> ImageChannel::Newest(const ImageFlow& flow, Time now) {
  Stream& stream = streams_[flow.view()];
  const ConsoleFrame& frame = feed_->NewestFrame();
  const std::uint64_t last = stream.newest.frame ? stream.newest.frame->sequence : 0;
  if (frame.sequence > last && IsDue(stream.encoded_at, now)) {
    stream.encoded_at = now;
    if (SharedMessage message = Encode(frame, flow.view(), now)) {
      stream.newest = {Kept(frame), flow.view(), std::move(message)};
    }
  }
  if (!stream.newest.frame || stream.newest.frame->sequence <= flow.seen()) return std::nullopt;
  return stream.newest;
}

const std::shared_ptr<const ConsoleFrame>& ImageChannel::Kept(const ConsoleFrame& frame) {
  if (!kept_ || kept_->sequence != frame.sequence) {
    auto copy = std::make_shared<ConsoleFrame>(frame);
    copy->image = frame.image.clone();
    kept_ = std::move(copy);
  }
  return kept_;
}

std::optional<ChannelImage> ImageChannel::Held(const ImageFlow& flow, Time now) {
  if (!IsDue(held_at_, now)) return std::nullopt;
  held_at_ = now;
  SharedMessage message = Encode(*flow.held(), flow.view(), now);
  if (!message) return std::nullopt;
  return ChannelImage{flow.held(), flow.view(), std::move(message)};
}

// Returns null when there is no picture of the frame.
SharedMessage ImageChannel::Encode(const ConsoleFrame& frame, std::size_t view, Time now) {
  const ConsoleFeed::Description& description = feed_->description();
  const ImageView* const drawn = view == 0 ? nullptr : &description.views[view - 1];
  const std::optional<Duration> age =
      description.is_live ? std::optional<Duration>(now - frame.captured) : std::nullopt;
  const std::string text = FrameJson(frame, drawn ? drawn->name : "", age);
  auto message = std::make_shared<std::string>();
  PutText(text, message.get());
  if (!encoder_.Append(drawn ? drawn->draw(frame.image) : frame.image, message.get())) {
    return nullptr;
  }
  ++encoded_;
  return message;
}

}  // namespace kestrel
