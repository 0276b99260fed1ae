// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "kestrel/core/base/limits.h"
#include "kestrel/core/base/time.h"
#include "kestrel/vision/tracking/turn_motion.h"

namespace kestrel {

inline constexpr double kFullTurn = 2 * std::numbers::pi;  // rad

// A measured position of the target at the time of an image's exposure.
struct TargetMeasurement {
  Time time;
  Eigen::Vector3d position_in_world;
  Eigen::Matrix3d covariance;  // covariance of this position's own error, m^2
  // Covariance of the error that all measurements share, like the navigation's bias, m^2. It is not
  // filtered, but included in the covariance of every estimate.
  Eigen::Matrix3d shared_covariance = Eigen::Matrix3d::Zero();
  // Yaw of the target (rad) and its variance (rad^2), and the turn (rad) after which the target
  // looks the same. Where the target is seen to turn, the track knows the curve.
  std::optional<double> yaw = std::nullopt;
  double yaw_variance = 0;
  double yaw_period = kFullTurn;
};

// Result of adding a measurement.
enum class MeasurementFate {
  kStarted,      // there was no track, or it was lost; a new one begins here
  kAccepted,     // in the track, at its time
  kInvalid,      // not finite, or not a valid covariance
  kTooOld,       // older than all measurements remembered
  kFarFromTrack  // where the target cannot be; several in a row that agree start a new track
};
const char* ToString(MeasurementFate fate);  // "started", "accepted", "invalid", ...

enum class TrackState {
  kSearching,   // not seen yet, or not often enough
  kTracking,    // seen just now
  kPredicting,  // not seen for a short time
  kLost,        // not seen for so long that its position is unknown
};
const char* ToString(TrackState state);  // "searching", "tracking", "predicting", "lost"

// The target at one time, in the world.
struct TargetEstimate {
  Time time;
  TurnState motion;
  // Turn (rad) after which the target looks the same, modulo which motion.yaw() is the heading of
  // its x axis in the world; 0: no yaw was measured.
  double yaw_period = 0;

  // True when motion.yaw() is the target's heading in the world, without such a turn.
  bool has_yaw() const { return yaw_period == kFullTurn; }

  double heading() const;  // direction of the velocity, rad from x (east) to y
  double speed() const;    // horizontal, m/s
  // Standard deviations per axis: root of the mean of the three variances.
  double position_sigma_m() const;
  double velocity_sigma_mps() const;
};

struct TargetTrackerOptions {
  double acceleration_noise = 0.1;
  double climb_noise = 0.1;
  double turn_noise = 0.1;
  double turn_time_s = 5;
  double sway_sigma_m = 0.01;
  double start_turn_sigma_radps = 0.3;
  double max_speed_mps = 15;
  double lost_after_s = 3;
  int history = 64;  // measurements that are remembered, so that late ones can be inserted

  static void Visit(auto& self, auto&& visit) {
    visit("acceleration_noise", self.acceleration_noise, MoreThan(0),
          "[m/s^2/sqrt(Hz)] horizontal acceleration that the turn does not explain");
    visit("climb_noise", self.climb_noise, MoreThan(0), "[m/s^2/sqrt(Hz)] vertical acceleration");
    visit("turn_noise", self.turn_noise, Range{0, 1e3, true, false},
          "[rad/s^3/sqrt(Hz)] variation of the turn rate's change; 0, together with "
          "start_turn_sigma_radps: no turns");
    visit("turn_time_s", self.turn_time_s, MoreThan(0),
          "time constant with which a change of the turn rate decays");
    visit("sway_sigma_m", self.sway_sigma_m, Range{0, 1, true, false},
          "swaying of the board on the vehicle, standard deviation; 0: none");
    visit("start_turn_sigma_radps", self.start_turn_sigma_radps, Range{0, 1e3, true, false},
          "turn rate of a new track, standard deviation");
    visit("max_speed_mps", self.max_speed_mps, MoreThan(0), "speed of the fastest target");
    visit("lost_after_s", self.lost_after_s, Range{0.2, 60},
          "time without a measurement after which the track is lost");
    visit.Gone({"sway_frequency_hz", "sway_damping", "start_speed_sigma_mps", "gate",
                "restart_count", "confirm_count", "predict_after_s", "lost_sigma_m", "history"});
  }

  TurnNoise Noise() const;  // noise of the motion
};

// Tracks one ground vehicle from measured positions and, where known, the yaw of its load (title
// and sections 1 and 5 of the paper). Measurements may be late and out of order: each is inserted
// at its time, and those after it are filtered again. Bounded memory and time. Allocates at
// construction only, never throws afterwards, and never returns values that are not finite.
class TargetTracker {
 public:
  // Throws InputError when the options are invalid.
  explicit TargetTracker(const TargetTrackerOptions& options);

  MeasurementFate Add(const TargetMeasurement& measurement);

  TrackState StateAt(Time time) const;

  // Returns the target at 'time' from the measurements up to then: filtered, or predicted for times
  // after the newest. Nothing before the oldest measurement remembered and when the target is lost.
  std::optional<TargetEstimate> Predict(Time time) const;

 private:
  struct Entry {
    TargetMeasurement measurement;
    TurnState filtered;     // state with all measurements up to this one
    double yaw_period = 0;  // turn (rad) modulo which its yaw is known; 0: not measured yet
  };

  MeasurementFate Start(const TargetMeasurement& measurement);
  MeasurementFate Restart();
  MeasurementFate Reject(const TargetMeasurement& measurement, MeasurementFate fate);
  void Insert(std::size_t index, const TargetMeasurement& measurement);
  bool FilterFrom(std::size_t index);
  std::size_t CountUntil(Time time) const;
  static void UpdateYaw(Entry* entry);
  TurnState PredictFrom(const Entry& entry, Time time) const;

  TargetTrackerOptions options_;
  TurnNoise noise_;
  std::vector<Entry> entries_;               // in order of time; at most the reserved capacity
  int accepted_ = 0;                         // measurements of this track, up to confirm_count
  std::vector<TargetMeasurement> outliers_;  // rejected in a row, each agrees with the one before
};

}  // namespace kestrel
