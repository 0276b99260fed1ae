// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/foxglove/observation_writer.h"

#include <utility>

#include <fmt/format.h>

#include "kestrel/app/foxglove/foxglove_topics.h"
#include "kestrel/app/foxglove/observation_messages.h"

namespace kestrel {
namespace {

foxglove::LogLevel LevelOf(EventLevel level) {
  switch (level) {
    case EventLevel::kInfo:
      return foxglove::LogLevel::kInfo;
    case EventLevel::kWarning:
      return foxglove::LogLevel::kWarning;
    case EventLevel::kError:
      break;
  }
  return foxglove::LogLevel::kError;
}

foxglove::PoseInFrame PoseInWorld(Time time, const RigidTransform& pose) {
  return {time, kFoxgloveWorld, FoxglovePose(pose)};
}

RigidTransform PoseOf(const TargetEstimate& target) {
  const Eigen::AngleAxisd turn(target.heading(), Eigen::Vector3d::UnitZ());
  return {Eigen::Quaterniond(turn), target.motion.position()};
}

}  // namespace

ObservationWriter::ObservationWriter(FoxgloveSink* sink, const CameraIntrinsics& camera,
                                     TaskView view)
    : sink_(sink), images_(sink, camera), view_(std::move(view)) {}

void ObservationWriter::Write(const Frame& frame, const LandingObservation& observation,
                              std::optional<Duration> latency) {
  const LandingView& view = std::get<LandingView>(view_);
  const Time time = frame.time;
  images_.Write(frame);
  sink_->Offer(kAnnotationsTopic, time,
               [&] { return FoxgloveAnnotations(time, LandingShapes(view, observation)); });
  if (const auto& pose = observation.world_from_camera) WriteCameraPose(time, *pose);
  if (const auto& found = observation.report.detection) {
    sink_->Write(kTransformsTopic, time,
                 foxglove::FrameTransforms{{FoxgloveTransform(
                     time, kFoxgloveCamera, kFoxglovePattern, found->camera_from_target)}});
  }
  if (observation.target) {
    sink_->Write(kTargetTopic, time, PoseInWorld(time, PoseOf(*observation.target)));
  }
  sink_->Offer(kSceneTopic, time, [&] { return FoxgloveScene(view, observation); });
  WriteResult(frame, latency, FoxgloveResult(observation));
  const TrackState state = observation.track_state;
  if (std::exchange(track_state_, state) == state) return;
  Write(SessionEvent{time, state == TrackState::kLost ? EventLevel::kWarning : EventLevel::kInfo,
                     fmt::format("track: {}", ToString(state))});
}

void ObservationWriter::Write(const Frame& frame, const HuntObservation& observation,
                              std::optional<Duration> latency) {
  const HuntView& view = std::get<HuntView>(view_);
  const Time time = frame.time;
  images_.Write(frame);
  sink_->Offer(kAnnotationsTopic, time,
               [&] { return FoxgloveAnnotations(time, HuntShapes(view, observation)); });
  if (const auto& pose = observation.world_from_camera) WriteCameraPose(time, *pose);
  sink_->Offer(kSceneTopic, time, [&] { return FoxgloveScene(view, observation); });
  WriteResult(frame, latency, FoxgloveResult(view, observation));
}

void ObservationWriter::Write(const Observation& observation) {
  std::visit([&](const auto& seen) { Write(observation.frame, seen, observation.latency); },
             observation.seen);
}

void ObservationWriter::Write(const SessionEvent& event) {
  sink_->Write(kLogTopic, event.time,
               foxglove::Log{event.time, LevelOf(event.level), event.text, "kestrel"});
}

void ObservationWriter::WriteCameraPose(Time time, const RigidTransform& world_from_camera) {
  sink_->Write(kCameraPoseTopic, time, PoseInWorld(time, world_from_camera));
  sink_->Write(kTransformsTopic, time,
               foxglove::FrameTransforms{
                   {FoxgloveTransform(time, kFoxgloveWorld, kFoxgloveCamera, world_from_camera)}});
}

void ObservationWriter::WriteResult(const Frame& frame, std::optional<Duration> latency,
                                    foxglove::FrameResult result) {
  result.frame = frame.name;
  if (latency) result.latency_ms = 1e3 * ToSeconds(*latency);
  sink_->Write(kResultTopic, frame.time, result);
}

}  // namespace kestrel
