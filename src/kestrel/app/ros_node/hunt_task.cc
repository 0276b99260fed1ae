// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/ros_node/hunt_task.h"

#include <filesystem>

#include <fmt/format.h>

#include "kestrel/core/base/error.h"
#include "kestrel/io/recording/object_map_files.h"

namespace kestrel {

HuntTask::HuntTask(const CameraCalibration& calibration, const HuntedObjects& objects,
                   const NodeOptions& options, const NodeFrames& frames, NodeConnection* connection)
    : options_(options),
      has_world_(frames.world.has_value()),
      clock_offset_(calibration.clock_offset.value_or(Duration::zero())),
      pipeline_(calibration, objects.model, objects.grid, options.kestrel.hunt),
      results_({WireFormat::kRos1, frames.camera, frames.world, objects.model}, connection) {
  pipeline_.SetAltitude(options.altitude());
}

// The last row of a rolling shutter is later than the frame's time.
Duration HuntTask::pose_lead() const {
  return clock_offset_ + DurationFromSeconds(pipeline_.options().readout_s / 2);
}

NodeTask::Found HuntTask::PublishDetections(const Frame& frame) {
  observation_ = &pipeline_.Process(frame.image, frame.time);
  results_.PublishDetections(*observation_);
  is_map_published_ = false;
  return {!observation_->report.detections.empty(), observation_->detect_time};
}

void HuntTask::PublishRest(const Frame& frame) {
  results_.PublishMarkers(*observation_);
  results_.PublishImage(frame.image, *observation_, pipeline_.map().Confirmed());
}

void HuntTask::Update(const NodeOptions& options) {
  pipeline_.ChangeOptions(options.kestrel.hunt);
  pipeline_.SetAltitude(options.altitude());
  options_ = options;
}

void HuntTask::PublishMap() {
  if (observation_ == nullptr || is_map_published_) return;
  results_.PublishMap(pipeline_.map().Confirmed(), observation_->time);
  is_map_published_ = true;
}

std::string HuntTask::SaveMap() {
  if (!has_world_) throw InputError("there is no map without poses: _poses:=topic or _poses:=tf");
  if (options_.kestrel.hunt.still) throw InputError("there is no map with hunt/still");
  if (options_.output.empty()) {
    throw InputError("no folder to save the map in: set the parameter output, then call update");
  }
  const std::string folder = std::filesystem::absolute(options_.output).string();
  WriteObjectMap(pipeline_, options_.origin_degrees(),
                 OutputFolder(folder, options_.force, "the parameter force (and update)"));
  return fmt::format("{} objects in {}/object_map.csv{}", pipeline_.map().Confirmed().size(),
                     folder, options_.origin.empty() ? "" : " and object_map.geojson");
}

}  // namespace kestrel
