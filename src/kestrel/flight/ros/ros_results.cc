// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/ros/ros_results.h"

#include <algorithm>
#include <chrono>
#include <thread>
#include <utility>

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

}  // namespace

Duration RosTimeAhead() {
  const auto ros =
      std::chrono::duration_cast<Duration>(std::chrono::system_clock::now().time_since_epoch());
  return ros - Now().time_since_epoch();
}

RosResults::RosResults(std::shared_ptr<ResultConnection> connection, const DdsOptions& options,
                       const RosFrames& frames, const CameraCalibration& calibration,
                       const LandingPipelineOptions& landing, ObjectModel model)
    : name_(options.node),
      publish_tf_(options.publish_tf),
      frames_(frames),
      body_from_camera_(calibration.body_from_camera),
      has_gimbal_(calibration.gimbal.has_value()),
      camera_(calibration.intrinsics),
      connection_(std::move(connection)),
      landing_(ResultsOf(options, frames, landing), connection_.get()),
      hunt_({frames.camera, frames.world, std::move(model)}, connection_.get()),
      follow_({frames.camera, frames.world, options.target_frame}, connection_.get()) {
  if (frames_.body && publish_tf_) PublishMount();
}

std::string RosResults::TransformBytes(Time stamp, const std::string& parent,
                                       const std::string& child,
                                       const RigidTransform& parent_from_child) const {
  TfMessage message;
  TransformStampedMessage& transform = message.transforms.emplace_back();
  transform.header = {0, stamp, parent};
  transform.child_frame_id = child;
  transform.transform = TransformMessageOf(parent_from_child);
  return SerializeMessage(message, WireFormat::kCdr);
}

void RosResults::PublishMount() {
  if (!body_from_camera_ || has_gimbal_) return;
  connection_->Publish(ResultTopic::kStaticTransforms,
                       TransformBytes(Time(), *frames_.body, frames_.camera, *body_from_camera_));
}

// The body in the world, and the camera on the body where a gimbal turns it.
template <class Observation>
void RosResults::PublishTransforms(const Observation& observation) {
  const auto& world_from_camera = observation.world_from_camera;
  const auto& camera_from_body = observation.camera_from_body;
  if (!publish_tf_ || !frames_.body || !world_from_camera || !camera_from_body) return;
  const auto publish = [&](const std::string& parent, const std::string& child,
                           const RigidTransform& parent_from_child) {
    connection_->Publish(ResultTopic::kTransforms,
                         TransformBytes(observation.time, parent, child, parent_from_child));
  };
  if (frames_.world) publish(*frames_.world, *frames_.body, *world_from_camera * *camera_from_body);
  if (has_gimbal_) publish(*frames_.body, frames_.camera, camera_from_body->Inverse());
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
  if (frame.camera > 0) return landing_.PublishTrack(stamped);
  PublishTransforms(stamped);
  landing_.PublishDetection(camera_, stamped);
  Count(observation.report.detection.has_value(), frame.time, observation.detect_time);
  landing_.PublishMarkers(stamped);
  landing_.PublishTrack(stamped);
  landing_.PublishImage(frame.image, camera_, stamped);
}

void RosResults::Publish(const Frame& frame, const HuntObservation& observation) {
  const std::lock_guard lock(mutex_);
  HuntObservation stamped = observation;
  stamped.time += frames_.to_stamps;
  PublishTransforms(stamped);
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
  PublishTransforms(stamped);
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
