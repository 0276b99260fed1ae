// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <fstream>
#include <optional>
#include <string>

#include "kestrel/core/base/bounded_queue.h"
#include "kestrel/core/camera/calibration.h"
#include "kestrel/flight/onboard/exposure_drive.h"
#include "kestrel/flight/onboard/flight_vision.h"
#include "kestrel/flight/onboard/frame_period.h"
#include "kestrel/io/recording/output_folder.h"
#include "kestrel/vision/pipeline/landing_pipeline.h"

namespace kestrel {

// The landing pipeline in flight; writes landing_detections.csv and landing_track.csv.
class LandingVision : public FlightVision {
 public:
  // 'output': folder of the tables; null: none are written. 'has_track': the target can be tracked.
  // 'exposure': keeps the pattern's white right. Throws InputError when calibration or options are
  // not valid, or the files cannot be written.
  LandingVision(const CameraCalibration& calibration, const LandingPipelineOptions& options,
                const OutputFolder* output, bool has_track,
                const std::optional<ExposureDrive>& exposure = std::nullopt);

  void AddPose(const PoseSample& pose) override { pipeline_.AddPose(pose); }
  void SetAltitude(std::optional<double> altitude_m) override { pipeline_.SetAltitude(altitude_m); }
  Duration pose_lead() const override { return clock_offset_; }
  TrackSnapshot Process(const Frame& frame, ObservationSink* sink) override;
  std::string Warning() const override;
  bool WriteResults() override;
  std::string Found() const override;

  // As of LandingPipeline.
  void ChangeOptions(const LandingPipelineOptions& options) { pipeline_.ChangeOptions(options); }

 private:
  struct Result {
    std::string frame_name;
    LandingObservation observation;
  };

  void LimitSearch(const Frame& frame);
  std::optional<TargetReport> Sighting(const LandingObservation& observation) const;
  void ControlExposure(const cv::Mat& image, const LandingObservation& observation);

  LandingPipeline pipeline_;
  FramePeriod period_;
  std::optional<RigidTransform> camera_from_body_;
  Duration clock_offset_;
  TrackSnapshot snapshot_;
  BoundedQueue<Result> results_;
  std::optional<std::ofstream> detections_, track_;
  bool has_track_begun_ = false;
  std::optional<ExposureDrive> exposure_;
};

}  // namespace kestrel
