// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <fstream>
#include <optional>
#include <string>
#include <vector>

#include "kestrel/core/base/bounded_queue.h"
#include "kestrel/core/camera/calibration.h"
#include "kestrel/flight/onboard/flight_vision.h"
#include "kestrel/io/recording/output_folder.h"
#include "kestrel/vision/objects/color/color_grid.h"
#include "kestrel/vision/objects/object_model.h"
#include "kestrel/vision/pipeline/hunt_pipeline.h"

namespace kestrel {

// The map during a hunt.
struct SharedMap {
  std::vector<MappedObject> objects;
  Time captured;                            // capture time of the newest frame
  std::optional<Eigen::Vector3d> position;  // of the camera at that time, in the world, if it is
                                            // known
};

// The pipeline of coloured objects in flight. It writes object_detections.csv and, at the end, the
// map. It has no landing target.
class HuntVision : public FlightVision {
 public:
  // As LandingVision.
  HuntVision(const CameraCalibration& calibration, const ObjectModel& model, const ColorGrid& grid,
             const HuntPipelineOptions& options, const OutputFolder* output);

  void AddPose(const PoseSample& pose) override { pipeline_.AddPose(pose); }
  void SetAltitude(std::optional<double> altitude_m) override { pipeline_.SetAltitude(altitude_m); }
  Duration pose_lead() const override;
  TrackSnapshot Process(const Frame& frame, ObservationSink* sink) override;
  bool WriteResults() override;
  std::string Found() const override;

  // From now on a copy of the map is made for another thread every 'period'. Call it before the
  // first frame.
  void ShareMap(Duration period) { share_period_ = period; }
  // Returns the newest copy, if it was not taken yet. Called by any thread.
  std::optional<SharedMap> TakeMap() { return shared_.TryPop(); }

  // The functions below are called after the last frame, or between two frames.

  // As of HuntPipeline.
  void ChangeOptions(const HuntPipelineOptions& options) { pipeline_.ChangeOptions(options); }
  // Writes the map of all that was seen, as WriteObjectMap does.
  void WriteMap(const OutputFolder& output) const;
  std::vector<MappedObject> Objects() const { return pipeline_.map().Confirmed(); }

 private:
  void PublishMap(const Frame& frame, const HuntObservation& observation);

  HuntPipeline pipeline_;
  Duration clock_offset_;
  TrackSnapshot snapshot_;
  std::size_t objects_ = 0;
  BoundedQueue<std::string> rows_;
  std::optional<std::ofstream> file_;
  BoundedQueue<SharedMap> shared_{1};
  std::optional<Duration> share_period_;  // nothing: it is not shared
  Time next_share_ = Time::min();
};

}  // namespace kestrel
