// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "kestrel/core/base/error.h"
#include "kestrel/core/base/time.h"
#include "kestrel/core/camera/calibration.h"
#include "kestrel/flight/ros/live_transforms.h"
#include "kestrel/flight/session/live_source.h"
#include "kestrel/io/bags/bag_reader.h"
#include "kestrel/io/bags/messages.h"
#include "kestrel/io/recording/frame.h"

namespace kestrel {

inline constexpr char kStaticTfTopic[] = "/tf_static";
// A stamp that differs more from now is not live.
inline constexpr Duration kLiveStamps = std::chrono::seconds(10);

inline bool IsImageType(std::string_view type) {
  return type == ImageMessage::kType || type == CompressedImageMessage::kType;
}

struct TopicSourceOptions {
  PixelFormat format = PixelFormat::kGray;
  bool needs_colors = false;     // refuses gray images
  bool poses_by_tf = false;      // tf has the poses, too; else it has the mount only
  std::string body_frame = {};   // frame of the UAV, where the poses do not name it
  std::string world_frame = {};  // of poses by tf; empty: the root of the body's frames
  // Times of the events are the stamps, as a map that is saved has them. False: times by Now(), as
  // a session with an autopilot needs them.
  bool keeps_stamps = false;
};

// The clock of the stamps went back by more than a second, as when a bag is played again.
class ClockWentBack : public InputError {
 public:
  using InputError::InputError;
};

// Live images and poses from serialized messages of ROS 1 or ROS 2: raw or compressed images,
// camera_info, poses by type or by tf, and the mount by tf. Stamps are the ROS time of this
// computer. Where they are far from it (a played bag, a simulation), the first stamp maps to the
// time of its arrival. Any thread may call Next, error, Fail and counters, one thread the others.
class TopicSource : public LiveSource {
 public:
  explicit TopicSource(TopicSourceOptions options) : options_(std::move(options)) {}

  // Takes a message of one of the topics. Throws InputError, and leaves it out, when it is broken
  // or out of order, or its type is none of these.
  void Take(const BagTopic& topic, std::string_view bytes);

  // Returns the newest camera_info, with the mount by tf if it is known; nothing before the first
  // one. Throws InputError when the camera is not calibrated.
  std::optional<CameraCalibration> Calibration() const;
  // Returns body_from_camera by static transforms, if there are such.
  std::optional<RigidTransform> Mount() const;

  // From now on images must be of this camera's size. Of those before only the newest is given out.
  void Begin(const CameraIntrinsics& camera);
  // While paused, images are left out, and do not count as missed.
  void Pause(bool is_paused);
  // Forgets images and poses that came, and the camera; camera_info and transforms stay.
  void Restart(const std::string& body_frame, const std::string& world_frame);

  bool has_images() const { return newest_image_.has_value(); }
  bool has_camera_info() const { return camera_info_.has_value(); }
  bool has_poses() const { return newest_pose_.has_value(); }
  const std::string& camera_frame() const { return camera_frame_; }
  const std::string& world_frame() const { return world_frame_; }  // empty: no poses came
  // Frame of the UAV, as the poses or else the options name it.
  const std::string& body_frame() const {
    return body_frame_.empty() ? options_.body_frame : body_frame_;
  }
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
  void TakeImage(const BagTopic& topic, std::string_view bytes);
  void CheckOrder(const HeaderMessage& header, const std::string& topic);
  void TakePose(const BagTopic& topic, std::string_view bytes);
  void TakeTransforms(const BagTopic& topic, std::string_view bytes);
  void AddPose(PoseSample pose, const std::string& world, const std::string& topic);
  Time TimeOf(Time stamp);
  void Add(Event event);

  TopicSourceOptions options_;
  LiveTransforms transforms_;
  std::optional<CameraInfoMessage> camera_info_;
  std::string camera_info_topic_;
  std::optional<CameraIntrinsics> camera_;  // once it has begun
  bool is_paused_ = false;
  std::string image_topic_;
  std::string camera_frame_;
  std::string world_frame_;
  std::string body_frame_;  // as the poses say
  std::optional<Duration> from_stamps_;
  std::optional<Time> newest_image_;  // stamps
  std::optional<Time> newest_pose_;
  std::optional<std::uint32_t> sequence_;  // of the newest image
  Time last_image_;

  mutable std::mutex mutex_;  // guards what follows
  std::condition_variable came_;
  std::deque<Event> waiting_;
  CaptureCounters counters_;
  std::string error_;
};

}  // namespace kestrel
