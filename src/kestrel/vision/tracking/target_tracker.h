// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "kestrel/core/base/time.h"
#include "kestrel/vision/tracking/turn_motion.h"

namespace kestrel {

// Where the target was when the light of an image fell on it.
struct TargetMeasurement {
  Time time;
  Eigen::Vector3d position_in_world;
  Eigen::Matrix3d covariance;  // of the position's own error, m^2
  // Of the error that all measurements share, as the bias of the navigation, m^2: it is not
  // filtered away, but in the covariance of every estimate.
  Eigen::Matrix3d shared_covariance = Eigen::Matrix3d::Zero();
  // How the target is turned about the vertical, up to quarter turns (rad), and the variance of
  // that (rad^2): where it is seen to turn, the track knows the curve.
  std::optional<double> yaw = std::nullopt;
  double yaw_variance = 0;
};

// What became of a measurement.
enum class MeasurementFate {
  kStarted,      // there was no track, or it was lost: a new one begins here
  kAccepted,     // it is in the track, at its time
  kInvalid,      // not finite, or its covariance is none
  kTooOld,       // older than all that the track remembers
  kFarFromTrack  // not where the target can be; several in a row that agree start a new track
};
const char* ToString(MeasurementFate fate);  // "started", "accepted", "invalid", ...

enum class TrackState {
  kSearching,   // nothing seen yet, or too little to trust it
  kTracking,    // seen just now
  kPredicting,  // not seen for a moment
  kLost,        // not seen for so long that nobody knows where it is
};
const char* ToString(TrackState state);  // "searching", "tracking", "predicting", "lost"

// The target at an instant, in the world.
struct TargetEstimate {
  Time time;
  TurnState motion;

  double heading() const;  // of the velocity, rad from x (east) to y
  double speed() const;    // horizontal, m/s
  // Standard deviation per axis: root of the mean of the three variances.
  double position_sigma_m() const;
  double velocity_sigma_mps() const;
};

struct TargetTrackerOptions {
  // How the target moves: see TurnNoise. The defaults suit a car of up to 40 km/h on curves.
  double acceleration_noise = 0.1;
  double climb_noise = 0.1;
  double turn_noise = 0.1;
  double turn_time_s = 5;
  // How the board sways on the vehicle's springs: see SwayMotion. A body rolls and pitches at 1 to
  // 2 Hz, by some tenths of a degree.
  double sway_sigma_m = 0.01;
  double sway_frequency_hz = 1.4;
  double sway_damping = 0.3;
  // What a new track does not know: standard deviations of speed, turn rate and, per second, its
  // change.
  double start_speed_sigma_mps = 6;
  double start_turn_sigma_radps = 0.3;
  // Squared Mahalanobis distance beyond which a measurement is not the target's: 16.3 is passed by
  // one true measurement in a thousand.
  double gate = 16.3;
  // Measurements in a row, outside of the gate and none further from the one before than the
  // fastest target gets, after which the track was wrong and a new one begins.
  int restart_count = 5;
  double max_speed_mps = 15;
  // Measurements that make a track; time without one after which it is predicted, then lost; and
  // standard deviation of the position at which it is lost.
  int confirm_count = 5;
  double predict_after_s = 0.15;
  double lost_after_s = 3;
  double lost_sigma_m = 3;
  // How many measurements are remembered, for those that come late.
  int history = 64;

  template <class Self, class Visitor>
  static void Visit(Self& self, Visitor&& visitor) {
    visitor("acceleration_noise", self.acceleration_noise, "m/s^2/sqrt(Hz)",
            "horizontal acceleration that the turn does not explain");
    visitor("climb_noise", self.climb_noise, "m/s^2/sqrt(Hz)", "vertical acceleration");
    visitor("turn_noise", self.turn_noise, "rad/s^3/sqrt(Hz)",
            "how the change of the turn rate varies; 0, and so start_turn_sigma_radps: no turns");
    visitor("turn_time_s", self.turn_time_s, "s",
            "after which a change of the turn rate ends, left alone");
    visitor("sway_sigma_m", self.sway_sigma_m, "m",
            "swaying of the board on the vehicle, standard deviation; 0: none");
    visitor("sway_frequency_hz", self.sway_frequency_hz, "Hz", "frequency of that");
    visitor("sway_damping", self.sway_damping, "1", "damping ratio of that, between 0 and 1");
    visitor("start_speed_sigma_mps", self.start_speed_sigma_mps, "m/s",
            "speed of a new track, standard deviation");
    visitor("start_turn_sigma_radps", self.start_turn_sigma_radps, "rad/s",
            "turn rate of a new track, standard deviation");
    visitor("gate", self.gate, "1", "squared Mahalanobis distance of the furthest measurement");
    visitor("restart_count", self.restart_count, "1",
            "measurements in a row outside of the gate that start a new track");
    visitor("max_speed_mps", self.max_speed_mps, "m/s", "of the fastest target");
    visitor("confirm_count", self.confirm_count, "1", "measurements that make a track");
    visitor("predict_after_s", self.predict_after_s, "s", "not seen for so long: predicting");
    visitor("lost_after_s", self.lost_after_s, "s", "not seen for so long: lost");
    visitor("lost_sigma_m", self.lost_sigma_m, "m", "known no better than this: lost");
    visitor("history", self.history, "1", "measurements remembered for late ones");
  }
  std::vector<std::string> Validate() const;

  TurnNoise Noise() const;  // of the motion
};

// Follows one ground vehicle by measured positions and, where it is known, the yaw of what it
// carries (title and sections 1 and 5 of the paper).
// Measurements may be late and out of order: each is put in at its time and those after it are
// filtered again. Bounded memory and time; allocates at construction only, never throws afterwards,
// never returns what is not finite.
class TargetTracker {
 public:
  // Throws InputError when the options are not valid.
  explicit TargetTracker(const TargetTrackerOptions& options);

  MeasurementFate Add(const TargetMeasurement& measurement);

  TrackState StateAt(Time time) const;

  // The target at 'time', from the measurements up to then: filtered, or predicted for times after
  // the newest. Nothing before the oldest measurement remembered, and where the target is lost.
  std::optional<TargetEstimate> Predict(Time time) const;

 private:
  struct Entry {
    TargetMeasurement measurement;
    TurnState filtered;  // with all measurements up to this one
  };

  MeasurementFate Start(const TargetMeasurement& measurement);
  MeasurementFate Reject(const TargetMeasurement& measurement, MeasurementFate fate);
  void Insert(std::size_t index, const TargetMeasurement& measurement);
  bool FilterFrom(std::size_t index);
  std::size_t CountUntil(Time time) const;
  TurnState PredictFrom(const Entry& entry, Time time) const;

  TargetTrackerOptions options_;
  TurnNoise noise_;
  std::vector<Entry> entries_;  // in order of time; never more than the capacity reserved
  int accepted_ = 0;            // measurements of this track, up to confirm_count
  std::optional<TargetMeasurement> outlier_;  // the newest that was rejected
  int outliers_ = 0;                          // how many in a row that agree
};

}  // namespace kestrel
