// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>

#include <Eigen/Core>

#include "kestrel/vision/pipeline/landing_pipeline.h"

namespace kestrel {

// Lines of landing_track.csv, each with its newline; without a target its cells are empty.
std::string TrackCsvHeader();
std::string TrackCsvRow(const LandingObservation& observation);

// The columns of a target from p_x_m to sigma_v_mps, and their cells; empty without one.
inline constexpr char kTargetColumns[] =
    "p_x_m,p_y_m,p_z_m,v_x_mps,v_y_mps,v_z_mps,heading_rad,turn_rate_radps,sigma_p_m,sigma_v_mps";
std::string TargetCells(const std::optional<TargetEstimate>& target);

// Three cells.
std::string VectorCells(const Eigen::Vector3d& vector);

// Lines of landing_prediction.csv: a prediction made at 'time' for 'prediction.time'.
std::string PredictionCsvHeader();
std::string PredictionCsvRow(Time time, const TargetEstimate& prediction);

}  // namespace kestrel
