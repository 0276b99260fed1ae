// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <condition_variable>
#include <deque>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "kestrel/core/base/time.h"
#include "kestrel/core/camera/calibration.h"
#include "kestrel/flight/ros/live_transforms.h"
#include "kestrel/flight/session/live_source.h"
#include "kestrel/io/recording/frame.h"
#include "kestrel/io/ros_messages/messages.h"
#include "kestrel/io/ros_messages/topic.h"

namespace kestrel {

inline constexpr char kStaticTfTopic[] = "/tf_static";
// A stamp that differs more from now is not live.
inline constexpr Duration kLiveStamps = std::chrono::seconds(10);

inline bool IsImageType(std::string_view type) {
  return type == ImageMessage::kType || type == CompressedImageMessage::kType;
}

struct TopicSourceOptions {
  PixelFormat format = PixelFormat::kGray;
  bool poses_by_tf = false;     // tf has the poses, too; else it has the mount only
  std::string body_frame = {};  // frame of the UAV, where the poses do not name it
  // Added to a stamp to get the time by Now(), where another camera has found that already.
  std::optional<Duration> from_stamps = {};
};

// Live images and poses from serialized messages of ROS: raw or compressed images, camera_info,
// poses by type or by tf (of the body in the root of its frames), and the mount by tf. Stamps are
// the ROS time of this computer, or on the given clock. Where they are far from it (a played bag, a
// simulation), the first stamp maps to the time of its arrival. Any thread may call Next, error,
// Fail and counters, one thread the others.
class TopicSource : public LiveSource {
 public:
  explicit TopicSource(TopicSourceOptions options) : options_(std::move(options)) {}

  // Takes a message of one of the topics. Throws InputError, and leaves it out, when it is broken
  // or out of order, its type is none of these, or the clock of the stamps went back by more than a
  // second, as when a bag is played again.
  void Take(const RosTopic& topic, std::string_view bytes);

  // Returns the newest camera_info, with the mount by tf if it is known; nothing before the first
  // one. Throws InputError when the camera is not calibrated.
  std::optional<CameraCalibration> Calibration() const;
  // Returns body_from_camera by static transforms, if there are such.
  std::optional<RigidTransform> Mount() const;

  // From now on images must be of this camera's size. Of those before only the newest is given out.
  void Begin(const CameraIntrinsics& camera);

  bool has_images() const { return newest_image_.has_value(); }
  bool has_camera_info() const { return camera_info_.has_value(); }
  bool has_poses() const { return newest_pose_.has_value(); }
  const std::string& camera_frame() const { return camera_frame_; }
  const std::string& world_frame() const { return world_frame_; }  // empty: no poses came
  const std::string& body_frame() const {  // as the poses name it, else that of the options
    return body_frame_.empty() ? options_.body_frame : body_frame_;
  }
  const std::string& camera_info_topic() const { return camera_info_topic_; }
  // Added to a stamp to get the time by Now(). Zero before the first stamp.
  Duration from_stamps() const { return from_stamps_.value_or(Duration::zero()); }
  // Arrival of the newest good image, by Now().
  Time last_image() const { return last_image_; }

  std::optional<Event> Next(Duration timeout) override;
  // The reason that Fail was given, until a good image comes.
  std::string error() const override;
  void Fail(const std::string& reason);
  CaptureCounters counters() const override;

 private:
  template <class Message>
  void TakeImage(const RosTopic& topic, std::string_view bytes);
  void CheckOrder(Time stamp, const std::string& topic) const;
  void TakePose(const RosTopic& topic, std::string_view bytes);
  void TakeTransforms(const RosTopic& topic, std::string_view bytes);
  void AddPose(PoseSample pose, const std::string& world, const std::string& topic);
  Time TimeOf(Time stamp);
  void Add(Event event);

  TopicSourceOptions options_;
  LiveTransforms transforms_;
  std::optional<CameraInfoMessage> camera_info_;
  std::string camera_info_topic_;
  std::optional<CameraIntrinsics> camera_;  // once it has begun
  std::string image_topic_;
  std::string camera_frame_;
  std::string world_frame_;
  std::string body_frame_;  // as named by the poses
  std::optional<Duration> from_stamps_;
  std::optional<Time> newest_image_;  // stamps
  std::optional<Time> newest_pose_;
  Time last_image_;

  mutable std::mutex mutex_;  // guards what follows
  std::condition_variable came_;
  std::deque<Event> waiting_;
  CaptureCounters counters_;
  std::string error_;
};

}  // namespace kestrel
