// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/foxglove/observation_file.h"

#include <filesystem>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "kestrel/base/error.h"
#include "kestrel/foxglove/observation_messages.h"

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

// Not where it is a device.
void RemoveFile(const std::string& path) {
  std::error_code ignored;
  if (std::filesystem::is_regular_file(path, ignored)) std::filesystem::remove(path, ignored);
}

RigidTransform PoseOf(const TargetEstimate& target) {
  const Eigen::AngleAxisd turn(target.heading(), Eigen::Vector3d::UnitZ());
  return {Eigen::Quaterniond(turn), target.motion.position()};
}

}  // namespace

ObservationFile::ObservationFile(const std::string& path, bool replace,
                                 const CameraIntrinsics& camera,
                                 std::variant<LandingView, HuntView> view)
    : path_(path), file_(path, replace), images_(&file_, camera), view_(std::move(view)) {}

ObservationFile::~ObservationFile() {
  try {
    if (has_messages_) Close();
  } catch (const InputError&) {  // what is in the file can be read all the same
  }
  if (!has_messages_) RemoveFile(path_);
}

void ObservationFile::Close() {
  if (std::exchange(is_closed_, true)) return;
  file_.Close();
}

void ObservationFile::Write(const Frame& frame, const LandingObservation& observation,
                            std::optional<Duration> latency) {
  const LandingView& view = std::get<LandingView>(view_);
  const Time time = frame.time;
  has_messages_ = true;
  images_.Write(frame);
  file_.Write("/camera/annotations", time,
              FoxgloveAnnotations(time, LandingShapes(view, observation)));
  if (const auto& pose = observation.world_from_camera) WriteCameraPose(time, *pose);
  if (const auto& found = observation.report.detection) {
    file_.Write("/tf", time,
                foxglove::FrameTransforms{{FoxgloveTransform(
                    time, kFoxgloveCamera, kFoxglovePattern, found->camera_from_pattern)}});
  }
  if (observation.target) {
    file_.Write("/landing/target", time, PoseInWorld(time, PoseOf(*observation.target)));
  }
  file_.Write("/scene", time, FoxgloveScene(view, observation));
  WriteResult(frame, latency, FoxgloveResult(observation));
  const TrackState state = observation.track_state;
  if (std::exchange(track_state_, state) == state) return;
  WriteLog(time, state == TrackState::kLost ? EventLevel::kWarning : EventLevel::kInfo,
           fmt::format("track: {}", ToString(state)));
}

void ObservationFile::Write(const Frame& frame, const HuntObservation& observation,
                            std::optional<Duration> latency) {
  const HuntView& view = std::get<HuntView>(view_);
  const Time time = frame.time;
  has_messages_ = true;
  images_.Write(frame);
  file_.Write("/camera/annotations", time,
              FoxgloveAnnotations(time, HuntShapes(view, observation)));
  if (const auto& pose = observation.world_from_camera) WriteCameraPose(time, *pose);
  file_.Write("/scene", time, FoxgloveScene(view, observation));
  WriteResult(frame, latency, FoxgloveResult(view, observation));
}

void ObservationFile::WriteLog(Time time, EventLevel level, const std::string& text) {
  has_messages_ = true;
  file_.Write("/log", time, foxglove::Log{time, LevelOf(level), text, "kestrel"});
}

void ObservationFile::WriteCameraPose(Time time, const RigidTransform& world_from_camera) {
  file_.Write("/camera/pose", time, PoseInWorld(time, world_from_camera));
  file_.Write("/tf", time,
              foxglove::FrameTransforms{
                  {FoxgloveTransform(time, kFoxgloveWorld, kFoxgloveCamera, world_from_camera)}});
}

void ObservationFile::WriteResult(const Frame& frame, std::optional<Duration> latency,
                                  foxglove::FrameResult result) {
  result.frame = frame.name;
  if (latency) result.latency_ms = 1e3 * ToSeconds(*latency);
  file_.Write("/result", frame.time, result);
}

}  // namespace kestrel
