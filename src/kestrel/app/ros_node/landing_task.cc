// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/ros_node/landing_task.h"

#include "kestrel/core/base/error.h"

namespace kestrel {
namespace {

LandingResultsOptions ResultsOf(const NodeOptions& options, const NodeFrames& frames) {
  return {.format = WireFormat::kRos1,
          .camera_frame = frames.camera,
          .world_frame = frames.world,
          .pattern_frame = options.pattern_frame,
          .target_frame = options.target_frame,
          .publish_tf = options.publish_tf,
          .horizon = DurationFromSeconds(options.prediction_s),
          .step = DurationFromSeconds(options.prediction_step_s),
          .pattern = options.kestrel.landing.detector.pattern,
          .noise = options.kestrel.landing.tracker.Noise()};
}

}  // namespace

LandingTask::LandingTask(const CameraCalibration& calibration, const NodeOptions& options,
                         const NodeFrames& frames, NodeConnection* connection)
    : frames_(frames),
      connection_(connection),
      clock_offset_(calibration.clock_offset.value_or(Duration::zero())),
      pipeline_(calibration, options.kestrel.landing),
      results_(ResultsOf(options, frames), connection) {
  pipeline_.SetAltitude(options.altitude());
}

NodeTask::Found LandingTask::PublishDetections(const Frame& frame) {
  observation_ = pipeline_.Process(frame.image, frame.time);
  results_.PublishDetection(observation_);
  return {observation_.report.detection.has_value(), observation_.detect_time};
}

void LandingTask::PublishRest(const Frame& frame) {
  results_.PublishTrack(observation_);
  results_.PublishImage(frame.image, pipeline_.detector().camera(), observation_);
}

void LandingTask::Update(const NodeOptions& options) {
  pipeline_.ChangeOptions(options.kestrel.landing);
  pipeline_.SetAltitude(options.altitude());
  results_ = LandingResults(ResultsOf(options, frames_), connection_);
}

std::string LandingTask::SaveMap() {
  throw InputError("the landing pattern has no map, coloured objects do: _task:=hunt");
}

}  // namespace kestrel
