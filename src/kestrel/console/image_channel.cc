// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/console/image_channel.h"

#include <memory>
#include <string>

#include "kestrel/console/console_json.h"

namespace kestrel {

ImageChannel::ImageChannel(ConsoleFeed* feed, int jpeg_quality, double max_rate_hz)
    : feed_(feed), encoder_(jpeg_quality), min_interval_(DurationFromSeconds(1 / max_rate_hz)) {}

std::optional<ImageChannel::Image> ImageChannel::NewestAfter(std::uint64_t seen, Time now) {
  const ConsoleFrame& frame = feed_->NewestFrame();
  const bool is_due = !encoded_at_ || now - *encoded_at_ >= min_interval_;
  if (frame.sequence > newest_.sequence && is_due) Encode(frame, now);
  if (newest_.sequence <= seen) return std::nullopt;
  return newest_;
}

void ImageChannel::Encode(const ConsoleFrame& frame, Time now) {
  const std::optional<Duration> age =
      feed_->description().is_live ? std::optional<Duration>(now - frame.captured) : std::nullopt;
  const std::string text = FrameJson(frame, age);
  auto message = std::make_shared<std::string>();
  for (int shift = 0; shift < 32; shift += 8) {
    message->push_back(static_cast<char>(text.size() >> shift & 0xFF));
  }
  *message += text;
  if (!encoder_.Append(frame.image, message.get())) return;
  newest_ = {frame.sequence, frame.captured, std::move(message)};
  encoded_at_ = now;
  ++encoded_;
}

}  // namespace kestrel
