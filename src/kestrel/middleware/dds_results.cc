// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/middleware/dds_results.h"

#include <algorithm>
#include <chrono>
#include <string_view>
#include <thread>
#include <utility>

#include <fmt/format.h>

#include "kestrel/bags/frame_tree.h"
#include "kestrel/bags/serialization.h"

namespace kestrel {
namespace {

LandingResultsOptions ResultsOf(const DdsOptions& options, const DdsFrames& frames,
                                const LandingPipelineOptions& landing) {
  return {.format = WireFormat::kCdr,
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

Ros2Qos QosOf(ResultTopic topic) {
  if (topic == ResultTopic::kAnnotatedImage) return kSensorDataQos;
  return topic == ResultTopic::kTransforms ? kTransformsQos : kDefaultQos;
}

std::string TransformBytes(Time stamp, const std::string& parent, const std::string& child,
                           const RigidTransform& parent_from_child) {
  TfMessage message;
  TransformStampedMessage& transform = message.transforms.emplace_back();
  transform.header = {0, stamp, parent};
  transform.child_frame_id = child;
  transform.transform = PoseMessageOf(parent_from_child);
  return SerializeMessage(message, WireFormat::kCdr);
}

KeyValueMessage Value(const char* key, std::uint64_t value) { return {key, fmt::to_string(value)}; }

}  // namespace

Duration RosTimeAhead() {
  const auto ros =
      std::chrono::duration_cast<Duration>(std::chrono::system_clock::now().time_since_epoch());
  return ros - Now().time_since_epoch();
}

DdsResults::Connection::Connection(std::shared_ptr<Ros2Node> of, const std::string& name)
    : node(std::move(of)) {
  for (std::size_t i = 0; i < static_cast<std::size_t>(ResultTopic::kMap); ++i) {
    const std::string topic(kResultTopics[i].name);
    const std::string own = topic.starts_with('/') ? topic : fmt::format("/{}/{}", name, topic);
    publishers.push_back(
        node->Advertise(own, kResultTopics[i].type, QosOf(static_cast<ResultTopic>(i))));
  }
}

bool DdsResults::Connection::HasSubscribers(ResultTopic topic) const {
  return node->HasSubscribers(publishers[static_cast<std::size_t>(topic)]);
}

void DdsResults::Connection::Publish(ResultTopic topic, const std::string& bytes) {
  // What DDS does not take is lost, as on a network.
  static_cast<void>(node->Publish(publishers[static_cast<std::size_t>(topic)], bytes));
}

DdsResults::DdsResults(std::shared_ptr<Ros2Node> node, const DdsOptions& options,
                       const DdsFrames& frames, const CameraCalibration& calibration,
                       const LandingPipelineOptions& landing, ObjectModel model)
    : options_(options),
      frames_(frames),
      body_from_camera_(calibration.body_from_camera),
      camera_(calibration.intrinsics),
      connection_(std::move(node), options.node),
      landing_(ResultsOf(options, frames, landing), &connection_),
      hunt_({WireFormat::kCdr, frames.camera, frames.world, std::move(model)}, &connection_),
      reported_(Now()) {
  if (frames_.body && options_.publish_tf) PublishMount();
}

void DdsResults::PublishMount() const {
  if (!body_from_camera_) return;
  const std::size_t mount =
      connection_.node->Advertise("/tf_static", TfMessage::kType, kLatchedQos);
  static_cast<void>(connection_.node->Publish(
      mount, TransformBytes(Time(), *frames_.body, frames_.camera, *body_from_camera_)));
}

void DdsResults::AdvertiseTeam() {
  const auto advertise = [this](const char* topic, std::string_view type) {
    return connection_.node->Advertise(fmt::format("/{}/{}", options_.node, topic), type,
                                       kLatchedQos);
  };
  team_ = {advertise("team_map", Detection3DArrayMessage::kType),
           advertise("team_markers", MarkerArrayMessage::kType)};
}

void DdsResults::PublishBody(const std::optional<RigidTransform>& world_from_camera, Time stamp) {
  if (!options_.publish_tf || !frames_.body || !frames_.world) return;
  if (!world_from_camera || !body_from_camera_) return;
  connection_.Publish(ResultTopic::kTransforms,
                      TransformBytes(stamp, *frames_.world, *frames_.body,
                                     *world_from_camera * body_from_camera_->Inverse()));
}

void DdsResults::WaitForSubscribers(Duration timeout) const {
  constexpr Duration kPause = std::chrono::milliseconds(20);
  const auto is_heard = [this] {
    for (std::size_t i = 0; i < connection_.publishers.size(); ++i) {
      if (connection_.HasSubscribers(static_cast<ResultTopic>(i))) return true;
    }
    return false;
  };
  for (const Time end = Now() + timeout; !is_heard() && Now() < end;) {
    std::this_thread::sleep_for(kPause);
  }
}

void DdsResults::Publish(const Frame& frame, const LandingObservation& observation) {
  LandingObservation stamped = observation;
  stamped.time += frames_.to_stamps;
  if (stamped.target) stamped.target->time += frames_.to_stamps;
  PublishBody(stamped.world_from_camera, stamped.time);
  landing_.PublishDetection(stamped);
  landing_.PublishTrack(stamped);
  landing_.PublishImage(frame.image, camera_, stamped);
}

void DdsResults::Publish(const Frame& frame, const HuntObservation& observation) {
  HuntObservation stamped = observation;
  stamped.time += frames_.to_stamps;
  PublishBody(stamped.world_from_camera, stamped.time);
  hunt_.PublishDetections(stamped);
  hunt_.PublishMarkers(stamped);
  hunt_.PublishImage(frame.image, stamped, /*map=*/nullptr);
}

void DdsResults::Publish(const TeamReport& team) {
  if (!team_ || !frames_.world) return;
  TeamReport stamped = team;
  stamped.time += frames_.to_stamps;
  const auto publish = [this](std::size_t topic, const auto& message) {
    static_cast<void>(
        connection_.node->Publish(topic, SerializeMessage(message, WireFormat::kCdr)));
  };
  publish(team_->map, TeamDetectionsOf(stamped, model_, *frames_.world));
  publish(team_->markers, TeamMarkersOf(stamped, model_, *frames_.world));
}

void DdsResults::Publish(const FlightReport& report) {
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
  connection_.Publish(ResultTopic::kDiagnostics, SerializeMessage(message, WireFormat::kCdr));
}

}  // namespace kestrel
