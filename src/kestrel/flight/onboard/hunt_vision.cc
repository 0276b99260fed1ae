// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/onboard/hunt_vision.h"

#include <utility>

#include <fmt/format.h>

#include "kestrel/core/base/error.h"
#include "kestrel/io/recording/tables/object_csv.h"
#include "kestrel/io/recording/tables/object_map_files.h"

namespace kestrel {
namespace {

constexpr char kObjects[] = "object_detections.csv";
constexpr std::size_t kFrames = 256;  // whose rows may wait for the disk

}  // namespace

HuntVision::HuntVision(const CameraCalibration& calibration, const ObjectModel& model,
                       const ColorGrid& grid, const HuntPipelineOptions& options,
                       const OutputFolder* output)
    : pipeline_(calibration, model, grid, options),
      clock_offset_(calibration.clock_offset.value_or(Duration::zero())),
      rows_(kFrames) {
  if (output == nullptr) return;
  file_ = output->OpenText(kObjects);
  WriteAtOnce(ObjectCsvHeader(), kObjects, &*file_);
}

// The last row of a rolling shutter is exposed later than the frame's time.
Duration HuntVision::pose_lead() const {
  return clock_offset_ + DurationFromSeconds(pipeline_.options().readout_s / 2);
}

TrackSnapshot HuntVision::Process(const Frame& frame, ObservationSink* sink) {
  const HuntObservation& observation = pipeline_.Process(frame.image, frame.time);
  snapshot_.captured = frame.time + clock_offset_;
  snapshot_.detect_time = observation.detect_time;
  ++snapshot_.frames;
  if (!observation.report.detections.empty()) ++snapshot_.detections;
  objects_ += observation.report.detections.size();
  if (file_) rows_.Push(ObjectCsvRows(frame.name, observation, pipeline_.detector().model()));
  if (sink != nullptr && sink->IsWanted()) {
    sink->Take(Observation{frame, observation, Now() - frame.time});
  }
  PublishMap(frame, observation);
  return snapshot_;
}

// Makes a copy from time to time: the map changes with the next frame.
void HuntVision::PublishMap(const Frame& frame, const HuntObservation& observation) {
  if (!share_period_) return;
  const Time now = Now();
  if (now < next_share_) return;
  next_share_ = now + *share_period_;
  SharedMap map{Objects(), frame.time, {}};
  if (observation.world_from_camera) map.position = observation.world_from_camera->translation;
  shared_.Push(std::move(map));
}

bool HuntVision::WriteResults() {
  try {
    while (const auto rows = rows_.TryPop()) WriteAtOnce(*rows, kObjects, &*file_);
    return true;
  } catch (const InputError&) {
    return false;
  }
}

std::string HuntVision::Found() const {
  return fmt::format("{} detections, {} objects in the map", objects_,
                     pipeline_.map().Confirmed().size());
}

void HuntVision::WriteMap(const OutputFolder& output) const {
  WriteObjectMap(pipeline_, /*origin=*/{}, output);
}

}  // namespace kestrel
