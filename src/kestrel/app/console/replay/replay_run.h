// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <sstream>
#include <string>
#include <utility>
#include <variant>

#include "kestrel/app/console/replay/replay_frame.h"
#include "kestrel/app/views/task_view.h"
#include "kestrel/core/base/time.h"
#include "kestrel/flight/onboard/session.h"
#include "kestrel/io/bags/open_recording.h"
#include "kestrel/vision/pipeline/camera_poses.h"

namespace kestrel {

// Keeps the frames of a session over a recording for the page.
class ReplayFrames : public ObservationSink {
 public:
  // Adds what is known only after the last frame.
  using Complete = std::function<void(ReplayResult* result)>;

  // 'table': of an earlier run; empty: 'vision', which outlives this, makes it.
  ReplayFrames(TaskView view, const Vision& vision, const std::string& table, Complete complete)
      : view_(std::move(view)), table_(table), complete_(std::move(complete)) {
    if (table.empty()) tables_ = vision.MakeTables({.stream = &table_});
  }

  void Take(const Observation& observation) override {
    if (tables_) tables_->Take(observation);
    result_.frames.push_back(ReplayFrameOf(view_, observation));
  }
  void Take(const BrokenFrame& broken) override {
    if (tables_) tables_->Take(broken);
    result_.frames.push_back({ViewFrameOf(view_, broken)});
  }

  std::size_t done() const { return result_.frames.size(); }

  // Call it once, after the last frame. Returns all frames with their marks. Throws InputError when
  // the truth belongs to another recording.
  ReplayResult TakeResult() {
    result_.table = table_.str();
    complete_(&result_);
    return std::move(result_);
  }

 private:
  TaskView view_;
  std::ostringstream table_;
  std::unique_ptr<ObservationSink> tables_;  // null: of an earlier run
  Complete complete_;
  ReplayResult result_;
};

// A run over a recording whose frames are kept.
struct ReplayRun {
  ReplayRun(std::unique_ptr<Session> run, TaskView view, const std::string& table,
            ReplayFrames::Complete complete)
      : session(std::move(run)),
        frames(session->sinks().Add(std::make_unique<ReplayFrames>(
            std::move(view), session->vision(), table, std::move(complete)))) {}

  std::unique_ptr<Session> session;
  ReplayFrames* frames;  // one of the session's sinks
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
  void AddGimbal(const GimbalSample& sample) override { poses_.Add(sample); }
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
