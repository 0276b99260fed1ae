// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "kestrel/app/evaluation/landing_results.h"
#include "kestrel/core/base/time.h"
#include "kestrel/vision/pipeline/landing_pipeline.h"

namespace kestrel {

// The output of `kestrel land` for a recording, frame by frame, with the track from the file beside
// it if there is one. Facts that are not in the tables (why the pattern was not found, whether the
// track took a detection, how the target turned) are unknown.
class LandResult {
 public:
  // 'table': path of landing_detections.csv; landing_track.csv may be beside it. Throws InputError
  // when they are not valid.
  explicit LandResult(const std::string& table);

  // Returns the next frame whose image could be read. Its time and its pose are given. Throws
  // InputError when the table has no row for it.
  LandingObservation Next(Time time, const std::optional<RigidTransform>& world_from_camera);
  // Throws InputError when the table has rows of further frames.
  void RequireEnd() const;

  const std::string& text() const { return text_; }
  // The summary of the run: "pattern found in 12".
  std::string Found() const;

 private:
  struct Row {
    DetectionRow detection;
    DetectionMethod method = DetectionMethod::kRing;
    double quality = 0;
    double misfit_px = 0;
    std::optional<std::int32_t> id;
    LandingStage reached = LandingStage::kFound;
    Duration detect_time{};
  };
  void AddTrack(LandingObservation* observation);

  std::string file_;
  std::string text_;
  std::vector<Row> rows_;
  std::vector<TrackRow> track_;
  std::size_t next_ = 0, next_track_ = 0;
};

}  // namespace kestrel
