// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include <Eigen/Core>

#include "kestrel/core/base/time.h"
#include "kestrel/vision/objects/object_detection.h"
#include "kestrel/vision/objects/object_model.h"

namespace kestrel {

// A detection with its place in the world.
struct ObjectMeasurement {
  // After the time of the frame (s), before it if negative: a rolling shutter sees each row at a
  // time of its own.
  double delay_s = 0;
  Eigen::Vector3d position = Eigen::Vector3d::Zero();    // m
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  // m^2, positive definite
  // By how much the position is wrong for each second by which the clock offset is (m/s): how fast
  // the place sweeps over the world that the camera sees where it saw the object. Zero: not known.
  Eigen::Vector3d clock_shift = Eigen::Vector3d::Zero();
  ObjectShape shape = ObjectShape::kDisc;
  Hsv color;
  ColorProbabilities color_probabilities{};
  std::optional<DigitLikelihoods> digits;
};

// Where a detection is expected in the world (m), and the covariance of that (m^2).
struct ExpectedPosition {
  Eigen::Vector3d position;
  Eigen::Matrix3d covariance;
};

// What the map knows of an object. Likelihoods are kept, not a choice: the next detection may
// change it.
struct MappedObject {
  static constexpr int kStateSize = 9;
  using State = Eigen::Matrix<double, kStateSize, 1>;
  using Covariance = Eigen::Matrix<double, kStateSize, kStateSize>;

  std::int64_t id = 0;  // within its map
  ObjectShape shape = ObjectShape::kDisc;
  Time first_seen;
  Time last_seen;
  Time time;  // of the state
  // Position (m), velocity (m/s) and acceleration (m/s^2) in the world; what stands, or rather
  // stands than moves by what is known, has no motion.
  State state = State::Zero();
  Covariance covariance = Covariance::Zero();
  bool may_move = false;     // by its class
  double move_log_odds = 0;  // that it moves; of what may
  bool moves = false;        // beyond doubt; false again when it rather stands
  int detections = 0;
  double log_odds = 0;  // that it is there
  Hsv color;            // of the last detection
  ColorProbabilities color_log_likelihoods{};
  DigitLikelihoods digit_log_likelihoods{};

  auto position() const { return state.head<3>(); }
  auto velocity() const { return state.segment<3>(3); }
  // Standard deviation of the position per axis: root of the mean of the three variances.
  double sigma_m() const;
  std::size_t color_index() const;  // the most likely
  // The likeliest digit of a cuboid; nothing where none was read.
  std::optional<LikelyDigit> digit() const;
};

// Objects that move drive: their speed and acceleration upwards is this share of that sideways.
inline constexpr double kClimb = 0.02;

// How objects move, and what error their detections share: see ObjectMapOptions.
struct ObjectMotion {
  double drift_noise;
  double acceleration_sigma_mps2;
  double acceleration_time_s;
  double velocity_time_s;
  double start_speed_sigma_mps;
  double wander_sigma_m;
  double wander_time_s;
  double clock_sigma_s;
  double sure_log_odds;
};

// What becomes of a state: x = transition x, with the covariance 'noise' added.
struct MotionStep {
  MappedObject::Covariance transition;
  MappedObject::Covariance noise;
};

// Of an object that drives, or stands, over 'dt' > 0 seconds.
MotionStep DrivingStep(double dt, const ObjectMotion& motion);
MotionStep StandingStep(double dt, const ObjectMotion& motion);

// The object at a later time (an earlier one changes nothing): where it stands, or by its velocity.
void PredictObject(Time time, const ObjectMotion& motion, MappedObject* object);

// Makes 'kept' what both say together, when they are the same object at the same time: states
// weighted by the inverse of their covariances, likelihoods multiplied, detections added. Of one
// that moves and one that does not, the state is that of the surer one, or else of the later one.
void UnifyObjects(const MappedObject& other, MappedObject* kept);

// Index of the class that the object most likely is; nothing when the model has none of its shape
// and colour.
std::optional<std::size_t> ClassOf(const MappedObject& object, const ObjectModel& model);

// What the object is worth: its digit, or its class's score.
double ScoreOf(const MappedObject& object, const ObjectModel& model);

}  // namespace kestrel
