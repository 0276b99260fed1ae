// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/ros/ros_results.h"

#include <algorithm>
#include <chrono>
#include <thread>
#include <utility>

#include <fmt/format.h>

#include "kestrel/io/bags/frame_tree.h"
#include "kestrel/io/bags/serialization.h"

namespace kestrel {
namespace {

LandingResultsOptions ResultsOf(WireFormat format, const DdsOptions& options,
                                const RosFrames& frames, const LandingPipelineOptions& landing) {
  return {.format = format,
          .camera_frame = frames.camera,
          .world_frame = frames.world,
          .pattern_frame = options.pattern_frame,
          .target_frame = options.target_frame,
          .publish_tf = options.publish_tf,
          .horizon = DurationFromSeconds(options.prediction_s),
          .step = DurationFromSeconds(options.prediction_step_s),
          .pattern = landing.detector.pattern,
          .noise = landing.tracker.Noise()};
}

KeyValueMessage Value(const char* key, std::uint64_t value) { return {key, fmt::to_string(value)}; }

}  // namespace

Duration RosTimeAhead() {
  const auto ros =
      std::chrono::duration_cast<Duration>(std::chrono::system_clock::now().time_since_epoch());
  return ros - Now().time_since_epoch();
}

RosResults::RosResults(std::unique_ptr<ResultConnection> connection, WireFormat format,
                       const DdsOptions& options, const RosFrames& frames,
                       const CameraCalibration& calibration, const LandingPipelineOptions& landing,
                       ObjectModel model)
    : format_(format),
      options_(options),
      frames_(frames),
      body_from_camera_(calibration.body_from_camera),
      camera_(calibration.intrinsics),
      connection_(std::move(connection)),
      landing_(ResultsOf(format, options, frames, landing), connection_.get()),
      hunt_({format, frames.camera, frames.world, std::move(model)}, connection_.get()),
      reported_(Now()) {
  if (frames_.body && options_.publish_tf) PublishMount();
}

std::string RosResults::TransformBytes(Time stamp, const std::string& parent,
                                       const std::string& child,
                                       const RigidTransform& parent_from_child) const {
  TfMessage message;
  TransformStampedMessage& transform = message.transforms.emplace_back();
  transform.header = {0, stamp, parent};
  transform.child_frame_id = child;
  transform.transform = PoseMessageOf(parent_from_child);
  return SerializeMessage(message, format_);
}

void RosResults::PublishMount() {
  if (!body_from_camera_) return;
  connection_->Publish(ResultTopic::kStaticTransforms,
                       TransformBytes(Time(), *frames_.body, frames_.camera, *body_from_camera_));
}

void RosResults::PublishBody(const std::optional<RigidTransform>& world_from_camera, Time stamp) {
  if (!options_.publish_tf || !frames_.body || !frames_.world) return;
  if (!world_from_camera || !body_from_camera_) return;
  connection_->Publish(ResultTopic::kTransforms,
                       TransformBytes(stamp, *frames_.world, *frames_.body,
                                      *world_from_camera * body_from_camera_->Inverse()));
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
  LandingObservation stamped = observation;
  stamped.time += frames_.to_stamps;
  if (stamped.target) stamped.target->time += frames_.to_stamps;
  PublishBody(stamped.world_from_camera, stamped.time);
  landing_.PublishDetection(stamped);
  landing_.PublishTrack(stamped);
  landing_.PublishImage(frame.image, camera_, stamped);
}

void RosResults::Publish(const Frame& frame, const HuntObservation& observation) {
  HuntObservation stamped = observation;
  stamped.time += frames_.to_stamps;
  PublishBody(stamped.world_from_camera, stamped.time);
  hunt_.PublishDetections(stamped);
  hunt_.PublishMarkers(stamped);
  hunt_.PublishImage(frame.image, stamped, /*map=*/nullptr);
}

void RosResults::Publish(const TeamReport& team) {
  TeamReport stamped = team;
  stamped.time += frames_.to_stamps;
  hunt_.PublishTeam(stamped);
}

void RosResults::Publish(const FlightReport& report) {
  const Time now = Now();
  const std::uint64_t frames = report.events.frames;
  const double rate_hz =
      static_cast<double>(frames - reported_frames_) / std::max(ToSeconds(now - reported_), 1e-3);
  reported_ = now;
  reported_frames_ = frames;
  DiagnosticStatusMessage status;
  status.name = options_.node + ": flight";
  const bool is_running = report.trouble.empty() && rate_hz > 0;
  status.level = is_running ? DiagnosticStatusMessage::kOk : DiagnosticStatusMessage::kWarn;
  status.message = !report.trouble.empty() ? report.trouble : is_running ? "running" : "no images";
  status.values = {{"image rate", fmt::format("{:.1f} Hz", rate_hz)},
                   Value("images captured", report.capture.captured),
                   Value("images missed before", report.capture.missed),
                   Value("images processed", frames),
                   Value("images dropped for newer ones", report.events.dropped_frames),
                   Value("images without the pose after them", report.events.unposed_frames)};
  DiagnosticArrayMessage message;
  message.header.stamp = now + frames_.to_stamps;
  message.status.push_back(std::move(status));
  connection_->Publish(ResultTopic::kDiagnostics, SerializeMessage(message, format_));
}

}  // namespace kestrel
