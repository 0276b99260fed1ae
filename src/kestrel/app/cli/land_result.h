// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "kestrel/app/evaluation/landing_results.h"
#include "kestrel/core/base/time.h"
#include "kestrel/vision/pipeline/landing_pipeline.h"

namespace kestrel {

// What `kestrel land` wrote of a recording, frame by frame, with the track beside it where there is
// one. What a table does not hold (why the pattern was not found, what became of a detection in the
// track, how the target turned) is not known.
class LandResult {
 public:
  // 'table': landing_detections.csv; landing_track.csv may be beside it. Throws InputError for what
  // is at fault in them.
  explicit LandResult(const std::string& table);

  // The next frame, which is of this time and seen from there. Throws InputError when the table has
  // not a row of it.
  LandingObservation Next(Time time, const std::optional<RigidTransform>& world_from_camera);
  // Throws InputError when there are rows of further frames.
  void RequireEnd() const;

  const std::string& text() const { return text_; }

 private:
  struct Row {
    DetectionRow detection;
    CrossMethod method = CrossMethod::kQuadrants;
    double quality = 0;
    double misfit_px = 0;
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
