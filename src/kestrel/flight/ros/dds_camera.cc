// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/ros/dds_camera.h"

#include <algorithm>
#include <chrono>
#include <functional>
#include <thread>
#include <utility>
#include <variant>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "kestrel/core/base/error.h"
#include "kestrel/flight/ros/ros_results.h"
#include "kestrel/io/bags/camera_info.h"
#include "kestrel/io/bags/frame_tree.h"
#include "kestrel/io/bags/image_message.h"
#include "kestrel/io/bags/pose_message.h"
#include "kestrel/io/bags/serialization.h"

namespace kestrel {
namespace {

constexpr Duration kTick = std::chrono::milliseconds(20);
constexpr Duration kSettle = std::chrono::seconds(1);  // time in which all topics of one system
                                                       // appear
constexpr Duration kStall = std::chrono::seconds(2);
constexpr Duration kLive = std::chrono::seconds(10);  // a stamp that differs more from now is not
                                                      // live
constexpr std::size_t kMaxWaiting = 64;
constexpr Ros2Qos kPosesQos{false, false, 200};
constexpr Ros2Qos kStaticQos{true, true, 100};  // as all nodes that publish static transforms use

constexpr char kStaticTransforms[] = "/tf_static";

Ros2Qos QosFor(const BagTopic& topic) {
  if (topic.name == kStaticTransforms) return kStaticQos;
  const bool is_image =
      topic.type == ImageMessage::kType || topic.type == CompressedImageMessage::kType;
  return is_image || topic.type == CameraInfoMessage::kType ? kSensorDataQos : kPosesQos;
}

}  // namespace

DdsCamera::DdsCamera(std::shared_ptr<Ros2Node> node, DdsCameraOptions options,
                     const std::function<void(const std::string&)>& tell)
    : node_(std::move(node)), options_(std::move(options)), name_("dds:" + options_.image) {
  const std::vector<BagTopic> found = FindTopics();
  std::vector<std::string> names = options_.topics;
  names.push_back(options_.image);
  chosen_ = ChooseTopics(found, names, name_);
  std::vector<std::size_t> heard{chosen_.image};
  if (chosen_.camera_info) heard.push_back(*chosen_.camera_info);
  if (chosen_.pose) heard.push_back(*chosen_.pose);
  heard.insert(heard.end(), chosen_.transforms.begin(), chosen_.transforms.end());
  for (const std::size_t index : heard) {
    topics_.push_back(found[index]);
    node_->Subscribe(found[index].name, found[index].type, QosFor(found[index]));
  }
  for (const Time end = Now() + DurationFromSeconds(options_.wait_s); !HasAll() && Now() < end;) {
    TakeMessages(kTick);
  }
  RequireAll();
  if (camera_info_) {
    calibration_ = CalibrationOf(*camera_info_, IsRectified(options_.image), name_);
    calibration_->body_from_camera = mount();
    if (!options_.camera) options_.camera = calibration_->intrinsics;
  }
  // The size of the images that came so far has not been checked.
  std::erase_if(waiting_, [](const Event& event) { return std::holds_alternative<Frame>(event); });
  has_poses_ = newest_pose_.has_value();
  if (std::chrono::abs(-to_stamps() + RosTimeAhead()) > kLive) {
    tell(fmt::format("{}: the stamps are not of now: they count from the first one on", name_));
  }
}

// Finds the image's topic, and the other topics a moment later.
std::vector<BagTopic> DdsCamera::FindTopics() const {
  const Time end = Now() + DurationFromSeconds(options_.wait_s);
  std::optional<Time> found;
  for (;;) {
    std::vector<BagTopic> topics = node_->Topics();
    const bool has_image = std::any_of(topics.begin(), topics.end(), [this](const BagTopic& topic) {
      return topic.name == options_.image;
    });
    const Time now = Now();
    if (has_image && !found) found = now;
    if ((found && now - *found >= kSettle)) return topics;
    if (now >= end && !found) {
      std::vector<std::string> names;
      names.reserve(topics.size());
      for (const BagTopic& topic : topics) names.push_back(topic.name);
      throw InputError(fmt::format("{}: nobody publishes that in this domain, expected one of: {}",
                                   name_,
                                   names.empty() ? "(nobody publishes anything that can be read)"
                                                 : fmt::format("{}", fmt::join(names, ", "))));
    }
    std::this_thread::sleep_for(kTick);
  }
}

bool DdsCamera::HasAll() const {
  const bool asks_for_poses = chosen_.pose || !chosen_.transforms.empty();
  const bool needs_info = !options_.camera && chosen_.camera_info;
  return newest_image_ && (camera_info_ || !needs_info) &&
         (!asks_for_poses || (newest_pose_ && mount()));
}

void DdsCamera::RequireAll() const {
  if (!newest_image_) {
    throw InputError(error_.empty() ? name_ + ": no image came, expected some" : error_);
  }
  if (camera_info_ || options_.camera) return;
  if (chosen_.camera_info) {
    throw InputError(name_ + ": no camera_info came, expected the calibration; or --camera FILE");
  }
  throw InputError(name_ +
                   ": no topic of sensor_msgs/CameraInfo goes with it, expected one beside "
                   "it or named by --topic; or --camera FILE");
}

std::optional<RigidTransform> DdsCamera::mount() const {
  for (const std::string& body : {body_frame_, options_.body_frame}) {
    if (body.empty()) continue;
    if (auto fixed = transforms_.Fixed(body, camera_frame_)) return fixed;
  }
  return std::nullopt;
}

void DdsCamera::Fail(const std::string& reason) {
  const std::lock_guard lock(mutex_);
  error_ = reason;
}

void DdsCamera::TakeMessages(Duration timeout) {
  node_->Take(timeout, [this](std::size_t index, std::string_view bytes) {
    try {
      TakeMessage(topics_[index], bytes);
    } catch (const InputError& error) {
      Fail(error.what());
    }
  });
}

void DdsCamera::TakeMessage(const BagTopic& topic, std::string_view bytes) {
  if (topic.type == ImageMessage::kType) {
    TakeImage<ImageMessage>(topic, bytes);
  } else if (topic.type == CompressedImageMessage::kType) {
    TakeImage<CompressedImageMessage>(topic, bytes);
  } else if (topic.type == CameraInfoMessage::kType) {
    if (!camera_info_) {
      camera_info_ = ParseMessage<CameraInfoMessage>(bytes, topic.wire_format, topic.name);
    }
  } else if (topic.type == TfMessage::kType) {
    TakeTransforms(topic, bytes);
  } else {
    TakePose(topic, bytes);
  }
}

// The first stamp sets the shift for all stamps: the time between images and poses is kept.
Time DdsCamera::TimeOf(Time stamp) {
  if (!from_stamps_) {
    from_stamps_ = -RosTimeAhead();
    const Duration age = Now() - (stamp + *from_stamps_);
    if (std::chrono::abs(age) > kLive) from_stamps_ = Now() - stamp;
  }
  return stamp + *from_stamps_;
}

template <class Message>
void DdsCamera::TakeImage(const BagTopic& topic, std::string_view bytes) {
  {
    const std::lock_guard lock(mutex_);
    ++counters_.missed;  // counted as missed until the message proves good
  }
  const auto message = ParseMessage<Message>(bytes, topic.wire_format, topic.name);
  if (ToNanoseconds(message.header.stamp) <= 0) {
    throw InputError(topic.name + ": an image has no stamp (zero), expected the time of its light");
  }
  if (newest_image_ && message.header.stamp <= *newest_image_) {
    throw InputError(topic.name +
                     ": an image is not later than the one before and left out; "
                     "where the clock went back, start again");
  }
  Frame frame;
  frame.name = fmt::format("{}/{}", topic.name.substr(1), ToNanoseconds(message.header.stamp));
  frame.image = DecodeImage(message, options_.format, topic.name);
  if (options_.camera) {
    CheckImageSize(*options_.camera, frame.image.cols, frame.image.rows, topic.name);
  }
  camera_frame_ = FrameName(message.header.frame_id);
  newest_image_ = message.header.stamp;
  frame.time = TimeOf(message.header.stamp);
  Add(std::move(frame));
  last_image_ = Now();
  const std::lock_guard lock(mutex_);
  --counters_.missed;
  ++counters_.captured;
  error_.clear();
}

void DdsCamera::TakePose(const BagTopic& topic, std::string_view bytes) {
  const StampedPose pose = ParsePose(topic.type, bytes, topic.wire_format, topic.name);
  const auto world_from_body = TransformOf(pose.pose);
  if (!world_from_body || ToNanoseconds(pose.stamp) <= 0) {
    throw InputError(topic.name +
                     ": a pose is left out that has no stamp, is not finite, or is "
                     "turned by no unit quaternion");
  }
  body_frame_ = FrameName(pose.body);
  AddPose({pose.stamp, *world_from_body,
           pose.twist ? MotionOf(*pose.twist, *world_from_body) : std::nullopt},
          FrameName(pose.world));
}

void DdsCamera::TakeTransforms(const BagTopic& topic, std::string_view bytes) {
  const bool is_static = topic.name == kStaticTransforms;
  for (const TransformStampedMessage& transform :
       ParseMessage<TfMessage>(bytes, topic.wire_format, topic.name).transforms) {
    transforms_.Add(transform, is_static);
    if (chosen_.pose || is_static || ToNanoseconds(transform.header.stamp) <= 0) continue;
    const auto pose = transforms_.PoseBy(transform, options_.body_frame, /*world=*/"");
    if (pose) AddPose(pose->sample, pose->world);
  }
}

void DdsCamera::AddPose(PoseSample pose, const std::string& world) {
  if (newest_pose_ && pose.time <= *newest_pose_) return;
  newest_pose_ = pose.time;
  world_frame_ = world;
  pose.time = TimeOf(pose.time);
  Add(pose);
}

// While nobody calls Next, the newest events replace the oldest.
void DdsCamera::Add(Event event) {
  if (waiting_.size() == kMaxWaiting) waiting_.pop_front();
  waiting_.push_back(std::move(event));
}

std::optional<Event> DdsCamera::Next(Duration timeout) {
  if (waiting_.empty()) TakeMessages(timeout);
  if (waiting_.empty()) {
    if (Now() - last_image_ > kStall) Fail(name_ + ": no images come");
    return std::nullopt;
  }
  Event event = std::move(waiting_.front());
  waiting_.pop_front();
  return event;
}

std::string DdsCamera::error() const {
  const std::lock_guard lock(mutex_);
  return error_;
}

CaptureCounters DdsCamera::counters() const {
  const std::lock_guard lock(mutex_);
  return counters_;
}

}  // namespace kestrel
