// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "kestrel/core/base/time.h"

namespace kestrel {

// A row of the output of `kestrel land` (the columns: docs/recording.md).
struct DetectionRow {
  struct Pattern {
    Eigen::Vector2d center_px;
    Eigen::Vector3d center_in_camera;
    Eigen::Vector3d sigma_in_camera;  // standard deviations, m
    std::optional<Eigen::Vector3d> center_in_world;
    std::optional<double> yaw_in_world;
    bool has_id = false;  // the pad's id was read
  };
  Time time;
  std::optional<Pattern> pattern;  // nothing when it was not detected
};

struct TrackRow {
  Time time;
  std::string state;  // searching, tracking, predicting, lost
  Eigen::Vector3d position_in_world;
  Eigen::Vector3d velocity_in_world;
  double position_sigma_m;  // per axis
  double velocity_sigma_mps;
};

struct PredictionRow {
  Time time;           // time at which it was made
  Duration horizon{};  // it predicts the position so much later
  Eigen::Vector3d position_in_world;
};

// Parse the texts of landing_detections.csv, landing_track.csv (rows without a position are left
// out) and landing_prediction.csv. Throw InputError with file and line for what is not valid or not
// in order of time.
std::vector<DetectionRow> ParseDetectionRows(std::string_view text, const std::string& file);
std::vector<TrackRow> ParseTrackRows(std::string_view text, const std::string& file);
std::vector<PredictionRow> ParsePredictionRows(std::string_view text, const std::string& file);

}  // namespace kestrel
