// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/io/bags/bag_source.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "kestrel/core/base/error.h"
#include "kestrel/io/bags/open_bag.h"
#include "kestrel/io/recording/open_source.h"
#include "kestrel/io/ros_messages/camera_info.h"
#include "kestrel/io/ros_messages/image_message.h"
#include "kestrel/io/ros_messages/serialization.h"

namespace kestrel {
namespace {

constexpr std::size_t kMaxWaiting = 8;
constexpr std::size_t kImagesForRate = 32;

}  // namespace

BagSource::BagSource(const std::string& path, BagChoice choice)
    : path_(path), choice_(std::move(choice)), bag_(OpenBag(path)) {
  if (!bag_->remark().empty()) Notify(bag_->remark());
  topics_ = ChooseTopics(bag_->topics(), choice_.topics, path_);
  ReadCameraInfo();
  const std::string camera_frame = ReadFirstImages();
  BagPoses poses = ReadPoses(bag_.get(), topics_, camera_frame, choice_.use_arrival_times, path_);
  if (!poses.remark.empty()) Notify(poses.remark);
  poses_ = std::move(poses.poses);
  body_from_camera_ = poses.body_from_camera;
  bag_->Select({topics_.image});
}

std::string BagSource::NameOf(std::size_t topic) const {
  return fmt::format("{}: {}", path_, bag_->topics()[topic].name);
}

void BagSource::Notify(const std::string& text) const {
  if (choice_.notify) choice_.notify(text);
}

void BagSource::ReadCameraInfo() {
  if (!topics_.camera_info) return;
  bag_->Select({*topics_.camera_info});
  std::string fault;
  for (BagMessage message; bag_->Next(&message);) {
    try {
      camera_info_ = ParseMessage<CameraInfoMessage>(
          message.data, bag_->topics()[message.topic].wire_format, NameOf(message.topic));
      return;
    } catch (const InputError& error) {
      if (fault.empty()) fault = error.what();
    }
  }
  if (!fault.empty()) throw InputError(fault);
}

std::optional<CameraCalibration> BagSource::calibration() const {
  if (!camera_info_) return std::nullopt;
  const bool is_rectified = IsRectified(bag_->topics()[topics_.image].name);
  CameraCalibration calibration =
      CalibrationOf(*camera_info_, is_rectified, NameOf(*topics_.camera_info));
  calibration.body_from_camera = body_from_camera_;
  return calibration;
}

std::optional<std::size_t> BagSource::frame_count() const {
  return bag_->topics()[topics_.image].messages;
}

// Estimates the frame rate. Returns the camera's frame.
std::string BagSource::ReadFirstImages() {
  bag_->Select({topics_.image});
  const RosTopic& topic = bag_->topics()[topics_.image];
  std::string camera_frame;
  std::vector<Time> times;
  std::string fault;
  BagMessage message;
  while (times.size() < kImagesForRate && bag_->Next(&message)) {
    try {
      // Messages of raw and of compressed images both begin with the header.
      const auto header =
          ParseMessage<HeaderMessage>(message.data, topic.wire_format, NameOf(message.topic));
      times.push_back(TimeOf(header, message));
      if (camera_frame.empty()) camera_frame = header.frame_id;
    } catch (const InputError& error) {  // Next leaves it out
      if (fault.empty()) fault = error.what();
    }
  }
  if (times.empty() && !fault.empty()) throw InputError(fault);
  if (times.empty()) throw InputError(NameOf(topics_.image) + ": has no images, expected some");
  const auto [first, last] = std::minmax_element(times.begin(), times.end());
  const double span_s = ToSeconds(*last - *first);
  if (span_s > 0) rate_hz_ = static_cast<double>(times.size() - 1) / span_s;
  return camera_frame;
}

Time BagSource::TimeOf(const HeaderMessage& header, const BagMessage& message) const {
  if (choice_.use_arrival_times) return message.arrival;
  if (ToNanoseconds(header.stamp) <= 0) {
    throw InputError(NameOf(message.topic) +
                     ": an image has no stamp (zero), expected the time of its light; "
                     "--arrival-times takes when it was recorded");
  }
  return header.stamp;
}

std::string BagSource::FrameName(const BagMessage& message, Time time) const {
  const std::string& topic = bag_->topics()[message.topic].name;
  return fmt::format("{}/{}", topic.substr(topic.starts_with('/')), ToNanoseconds(time));
}

// Fills 'frame'; its name and time, too, when the image cannot be decoded.
template <class Message>
void BagSource::Decode(const BagMessage& message, Frame* frame) const {
  const RosTopic& topic = bag_->topics()[message.topic];
  const auto image = ParseMessage<Message>(message.data, topic.wire_format, NameOf(message.topic));
  frame->time = TimeOf(image.header, message);
  frame->name = FrameName(message, frame->time);
  const std::string name = fmt::format("{}: {}", path_, frame->name);
  frame->image = DecodeImage(image, format(), name);
  if (keeps_color()) frame->color = DecodeImage(image, PixelFormat::kBgr, name);
}

bool BagSource::ReadMessage(ReadFrame* read) {
  BagMessage message;
  if (!bag_->Next(&message)) return false;
  // An image whose header cannot be read, or has no stamp, comes right after the one before it.
  read->frame.time = newest_ + Duration(1);
  read->frame.name = FrameName(message, read->frame.time);
  try {
    if (bag_->topics()[message.topic].type == ImageMessage::kType) {
      Decode<ImageMessage>(message, &read->frame);
    } else {
      Decode<CompressedImageMessage>(message, &read->frame);
    }
  } catch (const InputError& error) {
    read->fault = error.what();
  }
  newest_ = std::max(newest_, read->frame.time);
  return true;
}

void BagSource::ReportMissing() const {
  if (!bag_->damage().empty()) Notify(bag_->damage());
  if (repeated_ == 0) return;
  Notify(fmt::format(
      "{}: {} images with the stamp of another, or late by more than {} images, are left out",
      NameOf(topics_.image), repeated_, kMaxWaiting));
}

bool BagSource::ReadNext(Frame* frame) {
  while (!has_ended_ && waiting_.size() < kMaxWaiting) {
    ReadFrame read;
    if (!ReadMessage(&read)) {
      has_ended_ = true;
      ReportMissing();
      break;
    }
    const Time time = read.frame.time;
    const auto place = std::lower_bound(
        waiting_.begin(), waiting_.end(), time,
        [](const ReadFrame& waiting, Time wanted) { return waiting.frame.time < wanted; });
    const bool is_repeated = place != waiting_.end() && place->frame.time == time;
    if (is_repeated || (last_time_ && time <= *last_time_)) {
      ++repeated_;
      continue;
    }
    waiting_.insert(place, std::move(read));
  }
  if (waiting_.empty()) return false;
  const ReadFrame first = std::move(waiting_.front());
  waiting_.erase(waiting_.begin());
  last_time_ = first.frame.time;
  if (!first.fault.empty()) throw BrokenImage(first.fault, first.frame.name, first.frame.time);
  *frame = first.frame;
  return true;
}

std::unique_ptr<FrameSource> OpenSourceOrBag(const std::vector<std::string>& arguments,
                                             PixelFormat format, const BagChoice& choice) {
  if (arguments.size() == 1 && IsBag(arguments.front())) {
    auto bag = std::make_unique<BagSource>(arguments.front(), choice);
    bag->set_format(format);
    return bag;
  }
  for (const std::string& argument : arguments) {
    if (IsBag(argument)) {
      throw InputError(argument + ": is a bag, expected no other source beside it");
    }
  }
  if (!choice.topics.empty() || choice.use_arrival_times) {
    throw InputError("--topic and --arrival-times are for bags, which the source is not");
  }
  return OpenSource(arguments, format);
}

}  // namespace kestrel
