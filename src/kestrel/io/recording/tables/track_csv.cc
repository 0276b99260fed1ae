// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/io/recording/tables/track_csv.h"

#include <fmt/format.h>

namespace kestrel {
namespace {

std::string Cells(const Eigen::Vector3d& vector) {
  return fmt::format("{:.6f},{:.6f},{:.6f}", vector.x(), vector.y(), vector.z());
}

std::string TargetCells(const std::optional<TargetEstimate>& target) {
  if (!target) return ",,,,,,,,,";
  const TurnState& motion = target->motion;
  return fmt::format("{},{},{:.6f},{:.6f},{:.6f},{:.6f}", Cells(motion.position()),
                     Cells(motion.velocity()), target->heading(), motion.turn_rate(),
                     target->position_sigma_m(), target->velocity_sigma_mps());
}

}  // namespace

std::string TrackCsvHeader() {
  return "timestamp_ns,state,p_x_m,p_y_m,p_z_m,v_x_mps,v_y_mps,v_z_mps,heading_rad,turn_rate_radps,"
         "sigma_p_m,sigma_v_mps\n";
}

std::string TrackCsvRow(const LandingObservation& observation) {
  return fmt::format("{},{},{}\n", ToNanoseconds(observation.time),
                     ToString(observation.track_state), TargetCells(observation.target));
}

std::string PredictionCsvHeader() { return "timestamp_ns,horizon_s,p_x_m,p_y_m,p_z_m\n"; }

std::string PredictionCsvRow(Time time, const TargetEstimate& prediction) {
  return fmt::format("{},{:g},{}\n", ToNanoseconds(time), ToSeconds(prediction.time - time),
                     Cells(prediction.motion.position()));
}

}  // namespace kestrel
