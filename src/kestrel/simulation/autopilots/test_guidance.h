// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include "kestrel/core/base/time.h"
#include "kestrel/flight/guidance/guidance_options.h"
#include "kestrel/simulation/autopilots/autopilot_model.h"
#include "kestrel/simulation/autopilots/vehicle_world.h"
#include "kestrel/vision/tracking/target_tracker.h"

namespace kestrel {

// Options of guidance as `fly` sets them for an autopilot with the parameters as they come.
inline GuidanceOptions GuidanceFor(AutopilotFirmware firmware) {
  GuidanceOptions options;
  const bool is_px4 = firmware == AutopilotFirmware::kPx4;
  options.stream_before_start = is_px4;
  options.land_in_contact = !is_px4;
  if (is_px4) options.model.control = {1.8, 0.4, 0.2};  // MPC_XY_VEL_P_ACC, _I_ACC, _D_ACC
  if (!is_px4) options.autopilot_jerk = 5;              // PSC_JERK_NE
  return options;
}

// Turn rate of the vehicle at a time, rad/s; 0 while it stands.
inline double TurnRateAt(const VehicleWorld& world, Time time) {
  constexpr double kStep_s = 0.05;
  const Duration step = DurationFromSeconds(kStep_s);
  const Eigen::Vector3d before = world.VelocityAt(time - step);
  const Eigen::Vector3d after = world.VelocityAt(time + step);
  if (before.norm() < 0.1) return 0;
  return before.cross(after).z() / before.squaredNorm() / (2 * kStep_s);
}

// The true pattern as the estimate of a good track.
inline TargetEstimate TrueTarget(const VehicleWorld& world, Time now) {
  constexpr double kStep_s = 0.1;
  constexpr double kSigma_m = 0.03;
  const Duration step = DurationFromSeconds(kStep_s);
  TargetEstimate target;
  target.time = now;
  target.motion.mean.head<3>() = world.PatternAt(now).translation;
  target.motion.mean.segment<3>(TurnState::kVelocity) = world.VelocityAt(now);
  target.motion.mean(TurnState::kTurnRate) = TurnRateAt(world, now);
  target.motion.mean(TurnState::kTurnChange) =
      (TurnRateAt(world, now + step) - TurnRateAt(world, now - step)) / (2 * kStep_s);
  target.motion.mean(TurnState::kYaw) = HeadingOf(world.PatternAt(now).rotation);
  target.yaw_period = kFullTurn;
  target.motion.covariance.diagonal().head<3>().setConstant(kSigma_m * kSigma_m);
  return target;
}

}  // namespace kestrel
