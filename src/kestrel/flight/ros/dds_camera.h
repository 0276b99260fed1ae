// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "kestrel/comms/dds/ros2_node.h"
#include "kestrel/core/base/time.h"
#include "kestrel/core/camera/calibration.h"
#include "kestrel/flight/ros/topic_source.h"
#include "kestrel/flight/session/live_source.h"
#include "kestrel/io/recording/frame.h"
#include "kestrel/io/ros_messages/topic.h"
#include "kestrel/io/ros_messages/topic_choice.h"

namespace kestrel {

struct DdsCameraOptions {
  std::string image;                // topic: "/camera/image_raw"
  std::vector<std::string> topics;  // chosen topics (--topic), where several of a type exist
  PixelFormat format = PixelFormat::kGray;
  std::string body_frame;                       // frame of the UAV, where the poses do not name it
  std::optional<CameraIntrinsics> camera = {};  // calibration given by the user; nothing: from
                                                // camera_info
  double wait_s = 10;                           // longest wait for images, camera_info and mount

  // Of a further camera of a session:
  std::size_t inbox = 0;                     // of the node, for this camera's topics
  bool takes_poses = true;                   // false: another camera gives them out
  std::optional<Duration> from_stamps = {};  // as in TopicSourceOptions
};

// Live images and poses from a system of ROS 2. The topics are found and read like those of a bag:
// the image by name, raw or compressed; camera_info beside it; poses by type, or by tf; the mount
// by tf. TopicSource describes how they are read.
class DdsCamera : public LiveSource {
 public:
  // Waits for all topics. Throws InputError, with the topic and what exists instead, when there are
  // no images or no camera_info, or when these are wrong. 'notify' receives messages for the user.
  DdsCamera(std::shared_ptr<Ros2Node> node, DdsCameraOptions options,
            const std::function<void(const std::string&)>& notify);

  // From camera_info and tf; nothing when the user gave another one and there is no camera_info.
  const std::optional<CameraCalibration>& calibration() const { return calibration_; }
  std::optional<RigidTransform> mount() const { return source_->Mount(); }
  bool has_poses() const { return has_poses_; }
  const std::string& camera_frame() const { return source_->camera_frame(); }
  const std::string& world_frame() const { return source_->world_frame(); }  // empty: no poses
  const std::string& body_frame() const { return source_->body_frame(); }
  const std::string& camera_info_topic() const { return source_->camera_info_topic(); }
  Duration to_stamps() const { return -source_->from_stamps(); }

  // Leaves out broken messages and images out of order: error() has the reason until a good one
  // comes.
  std::optional<Event> Next(Duration timeout) override;
  std::string error() const override { return source_->error(); }
  CaptureCounters counters() const override { return source_->counters(); }

 private:
  std::vector<RosTopic> FindTopics() const;
  void Subscribe(const std::vector<RosTopic>& found, const TopicChoice& chosen);
  void TakeMessages(Duration timeout);
  bool HasAll(const TopicChoice& chosen) const;
  bool HasPlace(const TopicChoice& chosen) const;
  void RequireAll(const TopicChoice& chosen) const;

  std::shared_ptr<Ros2Node> node_;
  DdsCameraOptions options_;
  std::string name_;                   // "dds:/camera/image_raw"
  std::vector<RosTopic> topics_;       // the subscribed topics, in the order of their indices
  std::optional<TopicSource> source_;  // once the topics are known
  std::optional<CameraCalibration> calibration_;
  bool has_poses_ = false;
};

}  // namespace kestrel
