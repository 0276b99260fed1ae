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
  std::vector<std::string> topics;  // where the types of the others leave a choice (--topic)
  PixelFormat format = PixelFormat::kGray;
  std::string body_frame;                       // of the UAV, where the poses do not say
  std::optional<CameraIntrinsics> camera = {};  // what the user told; nothing: by camera_info
  double wait_s = 10;                           // for images, camera_info and mount
};

// Images and poses of a system of ROS 2 while they happen. The topics are found and read as those
// of a bag: the image's by name, raw or compressed; camera_info beside it; poses by type, or by tf;
// the mount by tf. Stamps are ROS' time of this computer or, where they are far from that (a bag
// that is played, a simulation), a time that began with the first of them.
class DdsCamera : public LiveSource {
 public:
  // Waits for all that is to come. Throws InputError, with the topic and what is there instead, for
  // want of images or camera_info, and where they are at fault. 'tell': what the user should know.
  DdsCamera(std::shared_ptr<Ros2Node> node, DdsCameraOptions options,
            const std::function<void(const std::string&)>& tell);

  // By camera_info and tf; nothing where the user told another and there is no camera_info.
  const std::optional<CameraCalibration>& calibration() const { return calibration_; }
  std::optional<RigidTransform> mount() const;
  bool has_poses() const { return has_poses_; }
  const std::string& camera_frame() const { return camera_frame_; }
  const std::string& world_frame() const { return world_frame_; }  // empty: there are no poses
  Duration to_stamps() const { return -from_stamps_.value_or(Duration::zero()); }

  // Messages that are broken, and images out of order, are left out: error() says why, until there
  // is a good one.
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
  std::vector<BagTopic> topics_;  // those that are heard, in the order of their indices
  BagTopics chosen_;
  bool has_poses_ = false;
  LiveTransforms transforms_;
  std::optional<CameraInfoMessage> camera_info_;
  std::optional<CameraCalibration> calibration_;
  std::string camera_frame_;
  std::string world_frame_;
  std::string body_frame_;  // where the poses say it
  std::optional<Duration> from_stamps_;
  std::optional<Time> newest_image_;
  std::optional<Time> newest_pose_;
  std::deque<Event> waiting_;
  Time last_image_;  // when one came, by Now()

  mutable std::mutex mutex_;  // of what follows
  CaptureCounters counters_;
  std::string error_;
};

}  // namespace kestrel
