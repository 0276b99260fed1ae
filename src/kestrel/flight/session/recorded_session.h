// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "kestrel/flight/session/observation_sinks.h"
#include "kestrel/flight/session/task.h"
#include "kestrel/io/bags/open_recording.h"

namespace kestrel {

// A session over a recording: passes all poses and frames in order of time to a vision and each
// result to the sinks, by the caller's thread, as fast as they go. What a sink throws ends it.
class RecordedSession {
 public:
  // 'opened' outlives this. 'altitude_m': height of the camera above what is looked for, where the
  // source has no poses. Throws InputError when it, the calibration or the options of the task are
  // not valid.
  RecordedSession(const OpenedSource& opened, const Task& task, std::optional<double> altitude_m);
  // The same with a vision of one's own.
  RecordedSession(const OpenedSource& opened, std::unique_ptr<Vision> vision)
      : opened_(opened), vision_(std::move(vision)) {}

  const Vision& vision() const { return *vision_; }
  // Add sinks before Run.
  ObservationSinks& sinks() { return sinks_; }
  // Writes the tables of the results, too; after all other sinks are added.
  void AddTables(const OutputOptions& output) {
    if (auto tables = vision_->MakeTables(output)) sinks_.Add(std::move(tables));
  }

  // Runs to the end of the source, and finishes the sinks. 'go_on' is called before each frame,
  // with the number of frames that are done; false stops the session. Returns whether the end was
  // reached. Throws InputError when the source, the vision or a sink does, or when a frame does not
  // have the calibration's size; the sinks are then not finished. Once only.
  bool Run(const std::function<bool(std::size_t done)>& go_on);

  // Number of frames so far, and of those among them whose image cannot be read.
  std::size_t frames() const { return times_ms_.size() + broken_; }
  std::size_t broken() const { return broken_; }
  // Returns some lines: the number of frames, what was found, and the times of the detection.
  std::string Summary() const;

 private:
  bool RunToEnd(const std::function<bool(std::size_t done)>& go_on);

  const OpenedSource& opened_;
  std::unique_ptr<Vision> vision_;
  ObservationSinks sinks_{SinkErrors::kThrow};
  std::vector<double> times_ms_;  // time of the detection, for each frame
  std::size_t broken_ = 0;
  std::string first_fault_;
};

}  // namespace kestrel
