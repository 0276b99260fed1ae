// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "kestrel/comms/dds/ros2_node.h"
#include "kestrel/core/base/time.h"
#include "kestrel/core/camera/calibration.h"
#include "kestrel/flight/ros/live_transforms.h"
#include "kestrel/flight/session/live_source.h"
#include "kestrel/io/bags/bag_reader.h"
#include "kestrel/io/bags/bag_topics.h"
#include "kestrel/io/bags/messages.h"
#include "kestrel/io/recording/frame.h"

namespace kestrel {

struct DdsCameraOptions {
  std::string image;                // topic: "/camera/image_raw"
  std::vector<std::string> topics;  // chosen topics (--topic), where several of a type exist
  PixelFormat format = PixelFormat::kGray;
  std::string body_frame;                       // frame of the UAV, where the poses do not name it
  std::optional<CameraIntrinsics> camera = {};  // calibration given by the user; nothing: from
                                                // camera_info
  double wait_s = 10;                           // longest wait for images, camera_info and mount
};

// Live images and poses from a system of ROS 2. The topics are found and read like those of a bag:
// the image by name, raw or compressed; camera_info beside it; poses by type, or by tf; the mount
// by tf. Stamps are the ROS time of this computer. Where they are far from it (a played bag, a
// simulation), the first stamp maps to the time of its arrival.
class DdsCamera : public LiveSource {
 public:
  // Waits for all topics. Throws InputError, with the topic and what exists instead, when there are
  // no images or no camera_info, or when these are wrong. 'tell' receives messages for the user.
  DdsCamera(std::shared_ptr<Ros2Node> node, DdsCameraOptions options,
            const std::function<void(const std::string&)>& tell);

  // From camera_info and tf; nothing when the user gave another one and there is no camera_info.
  const std::optional<CameraCalibration>& calibration() const { return calibration_; }
  std::optional<RigidTransform> mount() const;
  bool has_poses() const { return has_poses_; }
  const std::string& camera_frame() const { return camera_frame_; }
  const std::string& world_frame() const { return world_frame_; }  // empty: there are no poses
  Duration to_stamps() const { return -from_stamps_.value_or(Duration::zero()); }

  // Leaves out broken messages and images out of order: error() says why, until a good one comes.
  std::optional<Event> Next(Duration timeout) override;
  std::string error() const override;
  CaptureCounters counters() const override;

 private:
  std::vector<BagTopic> FindTopics() const;
  void Subscribe(std::size_t topic);
  void TakeMessages(Duration timeout);
  void TakeMessage(const BagTopic& topic, std::string_view bytes);
  template <class Message>
  void TakeImage(const BagTopic& topic, std::string_view bytes);
  void TakePose(const BagTopic& topic, std::string_view bytes);
  void TakeTransforms(const BagTopic& topic, std::string_view bytes);
  void AddPose(PoseSample pose, const std::string& world);
  Time TimeOf(Time stamp);
  void Add(Event event);
  bool HasAll() const;
  void RequireAll() const;
  void Fail(const std::string& reason);

  std::shared_ptr<Ros2Node> node_;
  DdsCameraOptions options_;
  std::string name_;              // "dds:/camera/image_raw"
  std::vector<BagTopic> topics_;  // the subscribed topics, in the order of their indices
  BagTopics chosen_;
  bool has_poses_ = false;
  LiveTransforms transforms_;
  std::optional<CameraInfoMessage> camera_info_;
  std::optional<CameraCalibration> calibration_;
  std::string camera_frame_;
  std::string world_frame_;
  std::string body_frame_;  // as the poses say
  std::optional<Duration> from_stamps_;
  std::optional<Time> newest_image_;
  std::optional<Time> newest_pose_;
  std::deque<Event> waiting_;
  Time last_image_;  // arrival of the newest image, by Now()

  mutable std::mutex mutex_;  // guards what follows
  CaptureCounters counters_;
  std::string error_;
};

}  // namespace kestrel
