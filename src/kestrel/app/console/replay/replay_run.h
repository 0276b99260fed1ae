// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "kestrel/app/console/replay/replay_frame.h"
#include "kestrel/core/base/time.h"
#include "kestrel/flight/session/observation_sink.h"
#include "kestrel/flight/session/vision.h"
#include "kestrel/io/bags/open_recording.h"
#include "kestrel/vision/pipeline/camera_poses.h"

namespace kestrel {

// A run over a recording whose frames are kept for the page: its vision, and the sink of the
// vision.
class ReplayRun : public ObservationSink {
 public:
  explicit ReplayRun(std::unique_ptr<Vision> vision) : vision_(std::move(vision)) {}

  Vision* vision() { return vision_.get(); }
  std::size_t done() const { return result_.frames.size(); }

  // Call it once, after the last frame. Returns all frames with their marks. Throws InputError when
  // the truth belongs to another recording.
  ReplayResult TakeResult() {
    Complete(&result_);
    return std::move(result_);
  }

 protected:
  ReplayResult* result() { return &result_; }
  // Adds what is known only after the last frame.
  virtual void Complete(ReplayResult* result) = 0;

 private:
  std::unique_ptr<Vision> vision_;
  ReplayResult result_;
};

// The results of an earlier run, in place of a pipeline. 'Result': LandResult or HuntResult.
template <class Result>
class EarlierResults : public Vision {
 public:
  // 'table': path of the detections. 'options': of the pipeline, for the poses. Throws InputError
  // as Result does.
  template <class Options>
  EarlierResults(const std::string& table, const OpenedSource& opened, const Options& options)
      : result_(table),
        clock_offset_(opened.calibration.clock_offset.value_or(Duration::zero())),
        poses_(opened.calibration, Options::kPoseCapacity, DurationFromSeconds(options.pose_gap_s),
               Duration::zero(), Duration::zero()) {}

  void AddPose(const PoseSample& pose) override { poses_.Add(pose); }
  Duration pose_lead() const override { return clock_offset_; }
  Observation Process(const Frame& frame) override {
    const auto camera = poses_.At(frame.time);
    return {frame, result_.Next(frame.time,
                                camera ? std::optional(camera->world_from_camera) : std::nullopt)};
  }
  void Finish() override { result_.RequireEnd(); }
  std::string Found() const override { return result_.Found(); }

  const Result& result() const { return result_; }

 private:
  Result result_;
  Duration clock_offset_;
  CameraPoses poses_;
};

}  // namespace kestrel
