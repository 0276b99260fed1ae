// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/ros/dds_camera.h"

#include <algorithm>
#include <chrono>
#include <functional>
#include <string_view>
#include <thread>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "kestrel/core/base/error.h"
#include "kestrel/flight/ros/ros_results.h"
#include "kestrel/io/ros_messages/messages.h"

namespace kestrel {
namespace {

constexpr Duration kTick = std::chrono::milliseconds(20);
constexpr Duration kSettle = std::chrono::seconds(1);  // time in which all topics of one system
                                                       // appear
constexpr Duration kStall = std::chrono::seconds(2);
constexpr Ros2Qos kPosesQos{false, false, 200};
constexpr Ros2Qos kStaticQos{true, true, 100};  // as all nodes that publish static transforms use

Ros2Qos QosFor(const RosTopic& topic) {
  if (topic.name == kStaticTfTopic) return kStaticQos;
  return IsImageType(topic.type) || topic.type == CameraInfoMessage::kType ? kSensorDataQos
                                                                           : kPosesQos;
}

}  // namespace

DdsCamera::DdsCamera(std::shared_ptr<Ros2Node> node, DdsCameraOptions options,
                     const std::function<void(const std::string&)>& notify)
    : node_(std::move(node)), options_(std::move(options)), name_("dds:" + options_.image) {
  const std::vector<RosTopic> found = FindTopics();
  std::vector<std::string> names = options_.topics;
  names.push_back(options_.image);
  const TopicChoice chosen = ChooseTopics(found, names, name_);
  source_.emplace(TopicSourceOptions{.format = options_.format,
                                     .poses_by_tf = options_.takes_poses && !chosen.pose,
                                     .body_frame = options_.body_frame,
                                     .from_stamps = options_.from_stamps});
  Subscribe(found, chosen);
  for (const Time end = Now() + DurationFromSeconds(options_.wait_s);
       !HasAll(chosen) && Now() < end;) {
    TakeMessages(kTick);
  }
  RequireAll(chosen);
  calibration_ = source_->Calibration();
  source_->Begin(options_.camera ? *options_.camera : calibration_->intrinsics);
  has_poses_ = source_->has_poses();
  if (std::chrono::abs(-to_stamps() + RosTimeAhead()) > kLiveStamps) {
    notify(fmt::format(
        "{}: the stamps are not of the present time: times are counted from the first one", name_));
  }
}

void DdsCamera::Subscribe(const std::vector<RosTopic>& found, const TopicChoice& chosen) {
  std::vector<std::size_t> heard{chosen.image};
  if (chosen.camera_info) heard.push_back(*chosen.camera_info);
  if (chosen.pose && options_.takes_poses) heard.push_back(*chosen.pose);
  heard.insert(heard.end(), chosen.transforms.begin(), chosen.transforms.end());
  for (const std::size_t index : heard) {
    topics_.push_back(found[index]);
    node_->Subscribe(found[index].name, found[index].type, QosFor(found[index]), options_.inbox);
  }
}

// Finds the image's topic, and the other topics a moment later.
std::vector<RosTopic> DdsCamera::FindTopics() const {
  const Time end = Now() + DurationFromSeconds(options_.wait_s);
  std::optional<Time> found;
  for (;;) {
    std::vector<RosTopic> topics = node_->Topics();
    const bool has_image = std::any_of(topics.begin(), topics.end(), [this](const RosTopic& topic) {
      return topic.name == options_.image;
    });
    const Time now = Now();
    if (has_image && !found) found = now;
    if ((found && now - *found >= kSettle)) return topics;
    if (now >= end && !found) {
      std::vector<std::string> names;
      names.reserve(topics.size());
      for (const RosTopic& topic : topics) names.push_back(topic.name);
      throw InputError(fmt::format("{}: no publisher in this domain, expected one of: {}", name_,
                                   names.empty() ? "(there is no topic that can be read)"
                                                 : fmt::format("{}", fmt::join(names, ", "))));
    }
    std::this_thread::sleep_for(kTick);
  }
}

bool DdsCamera::HasAll(const TopicChoice& chosen) const {
  const bool needs_info = !options_.camera && chosen.camera_info;
  return source_->has_images() && (source_->has_camera_info() || !needs_info) && HasPlace(chosen);
}

// True when the camera has its place in the world, or nothing will give it one.
bool DdsCamera::HasPlace(const TopicChoice& chosen) const {
  const bool will_have = chosen.pose || !chosen.transforms.empty();
  return !will_have || (mount() && (source_->has_poses() || !options_.takes_poses));
}

void DdsCamera::RequireAll(const TopicChoice& chosen) const {
  if (!source_->has_images()) {
    throw InputError(error().empty() ? name_ + ": no images received" : error());
  }
  if (source_->has_camera_info() || options_.camera) return;
  if (chosen.camera_info) {
    throw InputError(name_ +
                     ": no camera_info received, expected the calibration; or --camera FILE");
  }
  throw InputError(name_ +
                   ": no topic of sensor_msgs/CameraInfo goes with it, expected one beside "
                   "it or named by --topic; or --camera FILE");
}

void DdsCamera::TakeMessages(Duration timeout) {
  const auto take = [this](std::size_t index, std::string_view bytes) {
    try {
      source_->Take(topics_[index], bytes);
    } catch (const InputError& error) {
      source_->Fail(error.what());
    }
  };
  node_->Take(timeout, take, options_.inbox);
}

std::optional<Event> DdsCamera::Next(Duration timeout) {
  std::optional<Event> event = source_->Next(Duration::zero());
  if (event) return event;
  TakeMessages(timeout);
  event = source_->Next(Duration::zero());
  if (!event && Now() - source_->last_image() > kStall) source_->Fail(name_ + ": no images come");
  return event;
}

}  // namespace kestrel
