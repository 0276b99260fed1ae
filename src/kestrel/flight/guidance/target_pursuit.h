// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include <Eigen/Core>

#include "kestrel/core/base/time.h"
#include "kestrel/core/poses/set_point.h"
#include "kestrel/flight/guidance/flight_model.h"
#include "kestrel/flight/guidance/guidance_options.h"
#include "kestrel/flight/guidance/stand_off.h"
#include "kestrel/vision/tracking/target_tracker.h"

namespace kestrel {

// Speed at which to close in on something 'distance_m' away, and its derivative by the distance:
// proportional to the distance near by, and further away by the square root, so that the UAV can
// brake.
struct Closing {
  double speed;
  double rate;
};
Closing ClosingSpeed(double distance_m, double gain, double braking);

// Returns the acceleration of a target in its curve 'ahead_s' from now, m/s^2.
Eigen::Vector3d AccelerationAhead(const TurnState& motion, double ahead_s);

// Horizontal set-points to a place, to above a moving target, or to a place beside it. The wanted
// velocity is the target's smoothed velocity plus a velocity towards it. Both, and the
// accelerations that they need (the target's in its curve, that of closing in), are those of the
// moment at which the set-point takes effect. The UAV's model gives the command for them. The
// remaining offset is integrated, in a frame that turns with the target.
class TargetPursuit {
 public:
  explicit TargetPursuit(const GuidanceOptions& options);

  struct Motion {
    Eigen::Vector2d position;
    Eigen::Vector2d velocity;
    double height_m = 0;  // above the target
  };
  // Velocity and acceleration have no vertical parts.
  SetPoint To(const Eigen::Vector2d& place, const Motion& uav, FlightModel* model,
              double max_speed_mps) const;
  SetPoint Above(const TargetEstimate& target, const Motion& uav, FlightModel* model);
  SetPoint Beside(const TargetEstimate& target, const StandOff& place, const Motion& uav,
                  FlightModel* model);

  // Forgets the target.
  void Reset();

 private:
  struct Velocity {
    Time time;
    Eigen::Vector3d in_world;
    Eigen::Vector3d change;  // beyond that by the turn, m/s^2
  };

  // 'place': beside the target; null: above it.
  SetPoint Follow(const TargetEstimate& target, const StandOff* place, const Motion& uav,
                  FlightModel* model);
  double Gain(const FlightModel& model) const;
  Eigen::Vector3d Smoothed(const TargetEstimate& target, double height_m);
  void Integrate(const TargetEstimate& target, const Eigen::Vector2d& offset);
  void Close(const Eigen::Vector2d& offset, const Eigen::Vector2d& slip,
             const Eigen::Vector2d& velocity, double gain, SetPoint* command) const;

  GuidanceOptions options_;
  double gain_;                       // speed per metre, 1/s
  double braking_;                    // m/s^2
  std::optional<Velocity> smoothed_;  // smoothed velocity of the target
  std::optional<Time> integrated_;    // time up to which the offset is integrated
  Eigen::Vector2d integral_{0, 0};    // m/s
};

}  // namespace kestrel
