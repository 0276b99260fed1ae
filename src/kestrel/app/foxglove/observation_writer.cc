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

FoxgloveTopic<foxglove::ImageAnnotations> AnnotationsOf(const CameraWriter& images) {
  return {images.topics().annotations};
}

}  // namespace

ObservationWriter::ObservationWriter(FoxgloveSink* sink, const CameraIntrinsics& camera,
                                     TaskView view)
    : sink_(sink) {
  cameras_.emplace_back(sink, camera, CameraTopics(), std::move(view));
}

void ObservationWriter::AddCamera(const std::string& name, const CameraIntrinsics& camera,
                                  TaskView view) {
  cameras_.emplace_back(sink_, camera, CameraTopics(name), std::move(view));
}

void ObservationWriter::Write(const Frame& frame, const LandingObservation& observation,
                              std::optional<Duration> latency) {
  Camera& camera = cameras_[frame.camera];
  const LandingView& view = std::get<LandingView>(camera.view);
  const Time time = observation.time;
  camera.images.Write(frame, time);
  sink_->Offer(AnnotationsOf(camera.images), time,
               [&] { return FoxgloveAnnotations(time, LandingShapes(view, observation)); });
  if (const auto& pose = observation.world_from_camera) WriteCameraPose(camera, time, *pose);
  // A frame has one parent: the pattern's is the first camera.
  const auto& found = observation.report.detection;
  if (found && frame.camera == 0) {
    sink_->Write(kTransformsTopic, time,
                 foxglove::FrameTransforms{{FoxgloveTransform(
                     time, kFoxgloveCamera, kFoxglovePattern, found->camera_from_target)}});
  }
  if (observation.target) {
    sink_->Write(kTargetTopic, time, PoseInWorld(time, PoseOf(*observation.target)));
  }
  sink_->Offer(kSceneTopic, time, [&] { return FoxgloveScene(view, observation); });
  WriteResult(frame, time, latency, FoxgloveResult(observation));
  const TrackState state = observation.track_state;
  if (std::exchange(track_state_, state) == state) return;
  Write(SessionEvent{time, state == TrackState::kLost ? EventLevel::kWarning : EventLevel::kInfo,
                     fmt::format("track: {}", ToString(state))});
}

void ObservationWriter::Write(const Frame& frame, const HuntObservation& observation,
                              std::optional<Duration> latency) {
  Camera& camera = cameras_[frame.camera];
  const HuntView& view = std::get<HuntView>(camera.view);
  const Time time = frame.time;
  camera.images.Write(frame, time);
  sink_->Offer(AnnotationsOf(camera.images), time,
               [&] { return FoxgloveAnnotations(time, HuntShapes(view, observation)); });
  if (const auto& pose = observation.world_from_camera) WriteCameraPose(camera, time, *pose);
  sink_->Offer(kSceneTopic, time, [&] { return FoxgloveScene(view, observation); });
  WriteResult(frame, time, latency, FoxgloveResult(view, observation));
}

void ObservationWriter::Write(const Frame& frame, const FollowObservation& observation,
                              std::optional<Duration> latency) {
  Camera& camera = cameras_[frame.camera];
  const Time time = frame.time;
  camera.images.Write(frame, time);
  sink_->Offer(AnnotationsOf(camera.images), time,
               [&] { return FoxgloveAnnotations(time, FollowShapes(observation)); });
  if (const auto& pose = observation.world_from_camera) WriteCameraPose(camera, time, *pose);
  if (observation.target) {
    sink_->Write(kTargetTopic, time, PoseInWorld(time, PoseOf(*observation.target)));
  }
  sink_->Offer(kSceneTopic, time,
               [&] { return FoxgloveScene(std::get<FollowView>(camera.view), observation); });
  WriteResult(frame, time, latency, FoxgloveResult(observation));
}

void ObservationWriter::Write(const Observation& observation) {
  std::visit([&](const auto& seen) { Write(observation.frame, seen, observation.latency); },
             observation.seen);
}

void ObservationWriter::Write(const SessionEvent& event) {
  sink_->Write(kLogTopic, event.time,
               foxglove::Log{event.time, LevelOf(event.level), event.text, "kestrel"});
}

void ObservationWriter::WriteCameraPose(const Camera& camera, Time time,
                                        const RigidTransform& world_from_camera) {
  const CameraTopics& topics = camera.images.topics();
  sink_->Write(FoxgloveTopic<foxglove::PoseInFrame>{topics.pose}, time,
               PoseInWorld(time, world_from_camera));
  sink_->Write(kTransformsTopic, time,
               foxglove::FrameTransforms{{FoxgloveTransform(
                   time, kFoxgloveWorld, topics.frame.c_str(), world_from_camera)}});
}

void ObservationWriter::WriteResult(const Frame& frame, Time time, std::optional<Duration> latency,
                                    foxglove::FrameResult result) {
  result.frame = frame.name;
  if (latency) result.latency_ms = 1e3 * ToSeconds(*latency);
  sink_->Write(kResultTopic, time, result);
}

}  // namespace kestrel
