// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/ros/topic_source.h"

#include <chrono>
#include <utility>
#include <variant>

#include <fmt/format.h>

#include "kestrel/core/base/error.h"
#include "kestrel/flight/ros/ros_results.h"
#include "kestrel/io/ros_messages/camera_info.h"
#include "kestrel/io/ros_messages/frame_tree.h"
#include "kestrel/io/ros_messages/image_message.h"
#include "kestrel/io/ros_messages/pose_message.h"
#include "kestrel/io/ros_messages/serialization.h"
#include "kestrel/io/ros_messages/topic_choice.h"

namespace kestrel {
namespace {

constexpr std::size_t kMaxWaiting = 200;  // fewer than LiveEvents takes at once
constexpr Duration kJumpBack = std::chrono::seconds(1);

bool IsImage(const Event& event) { return std::holds_alternative<Frame>(event); }

void CheckJump(const std::optional<Time>& newest, Time stamp, const std::string& topic) {
  if (!newest || stamp >= *newest - kJumpBack) return;
  throw InputError(topic + ": the stamps jump back: start again");
}

}  // namespace

void TopicSource::Take(const RosTopic& topic, std::string_view bytes) {
  if (topic.type == ImageMessage::kType) {
    TakeImage<ImageMessage>(topic, bytes);
  } else if (topic.type == CompressedImageMessage::kType) {
    TakeImage<CompressedImageMessage>(topic, bytes);
  } else if (topic.type == CameraInfoMessage::kType) {
    camera_info_ = ParseMessage<CameraInfoMessage>(bytes, topic.wire_format, topic.name);
    camera_info_topic_ = topic.name;
  } else if (topic.type == TfMessage::kType) {
    TakeTransforms(topic, bytes);
  } else {
    TakePose(topic, bytes);
  }
}

std::optional<CameraCalibration> TopicSource::Calibration() const {
  if (!camera_info_) return std::nullopt;
  CameraCalibration calibration =
      CalibrationOf(*camera_info_, IsRectified(image_topic_), camera_info_topic_);
  calibration.body_from_camera = Mount();
  return calibration;
}

std::optional<RigidTransform> TopicSource::Mount() const {
  for (const std::string& body : {body_frame_, options_.body_frame}) {
    if (body.empty()) continue;
    if (auto fixed = transforms_.Fixed(body, camera_frame_)) return fixed;
  }
  return std::nullopt;
}

void TopicSource::Begin(const CameraIntrinsics& camera) {
  camera_ = camera;
  const std::lock_guard lock(mutex_);
  std::erase_if(waiting_, [&](const Event& event) {
    const auto* frame = std::get_if<Frame>(&event);
    return frame != nullptr && frame->image.size() != cv::Size(camera.width_px, camera.height_px);
  });
}

// The first stamp sets the shift for all stamps: the time between images and poses is kept.
Time TopicSource::TimeOf(Time stamp) {
  if (!from_stamps_) {
    from_stamps_ = options_.from_stamps.value_or(-RosTimeAhead());
    const Duration age = Now() - (stamp + *from_stamps_);
    if (std::chrono::abs(age) > kLiveStamps) from_stamps_ = Now() - stamp;
  }
  return stamp + *from_stamps_;
}

template <class Message>
void TopicSource::TakeImage(const RosTopic& topic, std::string_view bytes) {
  {
    const std::lock_guard lock(mutex_);
    ++counters_.missed;  // until the message proves good
    ++counters_.refused;
  }
  const auto message = ParseMessage<Message>(bytes, topic.wire_format, topic.name);
  CheckOrder(message.header.stamp, topic.name);
  Frame frame;
  frame.name = fmt::format("{}/{}", topic.name.substr(1), ToNanoseconds(message.header.stamp));
  frame.image = DecodeImage(message, options_.format, topic.name);
  if (camera_) CheckImageSize(*camera_, frame.image.cols, frame.image.rows, topic.name);
  image_topic_ = topic.name;
  camera_frame_ = FrameName(message.header.frame_id);
  newest_image_ = message.header.stamp;
  frame.time = TimeOf(message.header.stamp);
  last_image_ = Now();
  Add(std::move(frame));
  const std::lock_guard lock(mutex_);
  --counters_.missed;
  --counters_.refused;
  ++counters_.captured;
  error_.clear();
}

void TopicSource::CheckOrder(Time stamp, const std::string& topic) const {
  if (ToNanoseconds(stamp) <= 0) {
    throw InputError(topic + ": the images have no stamps (zero), expected when they were taken");
  }
  CheckJump(newest_image_, stamp, topic);
  if (newest_image_ && stamp <= *newest_image_) {
    throw InputError(topic + ": an image is not later than the one before and left out");
  }
}

void TopicSource::TakePose(const RosTopic& topic, std::string_view bytes) {
  if (!IsPoseType(topic.type)) {
    throw InputError(fmt::format(
        "{}: is of type {}, expected PoseStamped, PoseWithCovarianceStamped, TransformStamped or "
        "Odometry",
        topic.name, topic.type));
  }
  const StampedPose pose = ParsePose(topic.type, bytes, topic.wire_format, topic.name);
  if (!pose.pose || ToNanoseconds(pose.stamp) <= 0) {
    throw InputError(topic.name +
                     ": a pose is left out that has no stamp, is not finite, or is "
                     "turned by no unit quaternion");
  }
  body_frame_ = FrameName(pose.body);
  AddPose({pose.stamp, *pose.pose, pose.twist ? MotionOf(*pose.twist, *pose.pose) : std::nullopt},
          FrameName(pose.world), topic.name);
}

void TopicSource::TakeTransforms(const RosTopic& topic, std::string_view bytes) {
  const bool is_static = topic.name == kStaticTfTopic;
  for (const TransformStampedMessage& transform :
       ParseMessage<TfMessage>(bytes, topic.wire_format, topic.name).transforms) {
    transforms_.Add(transform, is_static);
    if (!options_.poses_by_tf || is_static || ToNanoseconds(transform.header.stamp) <= 0) continue;
    const auto pose = transforms_.PoseBy(transform, options_.body_frame);
    if (pose) AddPose(pose->sample, pose->world, topic.name);
  }
}

void TopicSource::AddPose(PoseSample pose, const std::string& world, const std::string& topic) {
  CheckJump(newest_pose_, pose.time, topic);
  if (newest_pose_ && pose.time <= *newest_pose_) return;
  newest_pose_ = pose.time;
  world_frame_ = world;
  pose.time = TimeOf(pose.time);
  Add(pose);
}

// While nobody takes them, the newest events replace the oldest; before the beginning only the
// newest image counts.
void TopicSource::Add(Event event) {
  {
    const std::lock_guard lock(mutex_);
    if (!camera_ && IsImage(event)) {
      const std::size_t replaced = std::erase_if(waiting_, IsImage);
      counters_.captured -= replaced;
      counters_.missed += replaced;
      counters_.refused += replaced;
    }
    if (waiting_.size() == kMaxWaiting) waiting_.pop_front();
    waiting_.push_back(std::move(event));
  }
  came_.notify_one();
}

std::optional<Event> TopicSource::Next(Duration timeout) {
  std::unique_lock lock(mutex_);
  came_.wait_for(lock, timeout, [this] { return !waiting_.empty(); });
  if (waiting_.empty()) return std::nullopt;
  Event event = std::move(waiting_.front());
  waiting_.pop_front();
  return event;
}

std::string TopicSource::error() const {
  const std::lock_guard lock(mutex_);
  return error_;
}

void TopicSource::Fail(const std::string& reason) {
  const std::lock_guard lock(mutex_);
  error_ = reason;
}

CaptureCounters TopicSource::counters() const {
  const std::lock_guard lock(mutex_);
  return counters_;
}

}  // namespace kestrel
