// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/ros/ros_results.h"

#include <algorithm>
#include <chrono>
#include <thread>
#include <utility>

#include <fmt/format.h>

#include "kestrel/io/ros_messages/frame_tree.h"
#include "kestrel/io/ros_messages/serialization.h"

namespace kestrel {
namespace {

LandingResultsOptions ResultsOf(const DdsOptions& options, const RosFrames& frames,
                                const LandingPipelineOptions& landing) {
  return {.camera_frame = frames.camera,
          .world_frame = frames.world,
          .pattern_frame = options.pattern_frame,
          .target_frame = options.target_frame,
          .publish_tf = options.publish_tf,
          .apriltag_topics = options.apriltag_topics,
          .horizon = DurationFromSeconds(options.prediction_s),
          .step = DurationFromSeconds(options.prediction_step_s),
          .shape = ShapeOfTarget(landing.target, landing.detector),
          .noise = landing.tracker.Noise()};
}

TransformStampedMessage StampedTransform(Time stamp, const std::string& parent,
                                         const std::string& child,
                                         const RigidTransform& parent_from_child) {
  return {{0, stamp, parent}, child, TransformMessageOf(parent_from_child)};
}

}  // namespace

Duration RosTimeAhead() {
  const auto ros =
      std::chrono::duration_cast<Duration>(std::chrono::system_clock::now().time_since_epoch());
  return ros - Now().time_since_epoch();
}

RosResults::Camera::Camera(std::shared_ptr<ResultConnection> to,
                           const CameraCalibration& calibration, LandingResultsOptions results)
    : frame(results.camera_frame),
      lens(calibration.intrinsics),
      body_from_camera(calibration.body_from_camera),
      has_gimbal(calibration.gimbal.has_value()),
      connection(std::move(to)),
      landing(std::move(results), connection.get()) {}

RosResults::RosResults(std::shared_ptr<ResultConnection> connection, const DdsOptions& options,
                       const RosFrames& frames, const CameraCalibration& calibration,
                       const LandingPipelineOptions& landing, ObjectModel model)
    : name_(options.node),
      publish_tf_(options.publish_tf),
      frames_(frames),
      landing_(ResultsOf(options, frames, landing)),
      connection_(std::move(connection)),
      hunt_({frames.camera, frames.world, std::move(model)}, connection_.get()),
      follow_({frames.camera, frames.world, options.target_frame}, connection_.get()) {
  cameras_.emplace_back(connection_, calibration, landing_);
  PublishMounts();
}

void RosResults::AddCamera(std::shared_ptr<ResultConnection> connection,
                           const CameraCalibration& calibration) {
  LandingResultsOptions results = landing_;
  results.camera_frame = frames_.further[cameras_.size() - 1];
  results.pattern_frame = fmt::format("{}_{}", calibration.name, landing_.pattern_frame);
  results.apriltag_topics = false;
  cameras_.emplace_back(std::move(connection), calibration, std::move(results));
  PublishMounts();
}

// All in one message: only the last one is kept for later subscribers.
void RosResults::PublishMounts() {
  if (!frames_.body || !publish_tf_) return;
  TfMessage mounts;
  for (const Camera& camera : cameras_) {
    if (!camera.body_from_camera || camera.has_gimbal) continue;
    mounts.transforms.push_back(
        StampedTransform(Time(), *frames_.body, camera.frame, *camera.body_from_camera));
  }
  if (mounts.transforms.empty()) return;
  connection_->Publish(ResultTopic::kStaticTransforms, SerializeMessage(mounts, WireFormat::kCdr));
}

// The body in the world, and the camera on the body where a gimbal turns it. Cameras whose images
// are taken at once have one stamp, which tf takes once.
template <class Observation>
void RosResults::PublishTransforms(const Camera& camera, const Observation& observation) {
  const auto& world_from_camera = observation.world_from_camera;
  const auto& camera_from_body = observation.camera_from_body;
  if (!publish_tf_ || !frames_.body || !world_from_camera || !camera_from_body) return;
  const auto publish = [&](const std::string& parent, const std::string& child,
                           const RigidTransform& parent_from_child) {
    const TfMessage message{{StampedTransform(observation.time, parent, child, parent_from_child)}};
    connection_->Publish(ResultTopic::kTransforms, SerializeMessage(message, WireFormat::kCdr));
  };
  if (frames_.world && body_time_ != observation.time) {
    publish(*frames_.world, *frames_.body, *world_from_camera * *camera_from_body);
    body_time_ = observation.time;
  }
  if (camera.has_gimbal) publish(*frames_.body, camera.frame, camera_from_body->Inverse());
}

void RosResults::WaitForSubscribers(Duration timeout) const {
  constexpr Duration kPause = std::chrono::milliseconds(20);
  const auto is_heard = [this] {
    return std::any_of(kLandingTopics.begin(), kLandingTopics.end(),
                       [this](ResultTopic topic) { return connection_->HasSubscribers(topic); });
  };
  for (const Time end = Now() + timeout; !is_heard() && Now() < end;) {
    std::this_thread::sleep_for(kPause);
  }
}

void RosResults::Publish(const Frame& frame, const LandingObservation& observation) {
  const std::lock_guard lock(mutex_);
  LandingObservation stamped = observation;
  stamped.time += frames_.to_stamps;
  if (stamped.target) stamped.target->time += frames_.to_stamps;
  Camera& camera = cameras_[frame.camera];
  PublishTransforms(camera, stamped);
  camera.landing.PublishDetection(camera.lens, stamped);
  Count(observation.report.detection.has_value(), frame.time, observation.detect_time);
  camera.landing.PublishMarkers(stamped);
  cameras_.front().landing.PublishTrack(stamped);
  camera.landing.PublishImage(frame.image, camera.lens, stamped);
}

void RosResults::Publish(const Frame& frame, const HuntObservation& observation) {
  const std::lock_guard lock(mutex_);
  HuntObservation stamped = observation;
  stamped.time += frames_.to_stamps;
  PublishTransforms(cameras_.front(), stamped);
  hunt_.PublishDetections(stamped);
  Count(!observation.report.detections.empty(), frame.time, observation.detect_time);
  hunt_.PublishMarkers(stamped);
  hunt_.PublishImage(frame.image, stamped);
}

void RosResults::Publish(const Frame& frame, const FollowObservation& observation) {
  const std::lock_guard lock(mutex_);
  FollowObservation stamped = observation;
  stamped.time += frames_.to_stamps;
  if (stamped.target) stamped.target->time += frames_.to_stamps;
  PublishTransforms(cameras_.front(), stamped);
  const auto& region = observation.region;
  Count(region && region->state == RegionState::kFollowing, frame.time, observation.detect_time);
  follow_.PublishTrack(stamped);
  follow_.PublishImage(frame.image, stamped);
}

void RosResults::Publish(const TeamReport& team) {
  const std::lock_guard lock(mutex_);
  TeamReport stamped = team;
  stamped.time += frames_.to_stamps;
  hunt_.PublishTeam(stamped);
}

void RosResults::Publish(const FlightReport& report) {
  const std::lock_guard lock(mutex_);
  const ResultCounts counts{found_, latency_.Summary(), beyond_detect_.Summary(),
                            detect_.Summary()};
  const DiagnosticStatusMessage status =
      DiagnosticsOf(name_ + ": flight", rate_.Next(report.events.frames), report, counts);
  connection_->Publish(
      ResultTopic::kDiagnostics,
      SerializeMessage(ArrayOf(status, Now() + frames_.to_stamps), WireFormat::kCdr));
}

void RosResults::Count(bool found, Time time, Duration detect_time) {
  const Duration latency = Now() - time;
  found_ += found ? 1 : 0;
  latency_.Add(latency);
  beyond_detect_.Add(latency - detect_time);
  detect_.Add(detect_time);
}

}  // namespace kestrel
