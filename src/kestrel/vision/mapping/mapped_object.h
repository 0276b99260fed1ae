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

// A detection with its position in the world.
struct ObjectMeasurement {
  // Time of the measurement relative to the frame's (s), negative if before it: a rolling shutter
  // sees each row at its own time.
  double delay_s = 0;
  Eigen::Vector3d position = Eigen::Vector3d::Zero();    // m
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  // m^2, positive definite
  // Error of the position per error of the clock offset (m/s): the speed at which the point of the
  // world at this place in the image moves. Zero: not known.
  Eigen::Vector3d clock_shift = Eigen::Vector3d::Zero();
  ObjectShape shape = ObjectShape::kDisc;
  Hsv color;
  ColorProbabilities color_probabilities{};
  std::optional<DigitLikelihoods> digits;
};

// Expected position of a detection in the world (m), and its covariance (m^2).
struct ExpectedPosition {
  Eigen::Vector3d position;
  Eigen::Matrix3d covariance;
};

// Largest sigma_m() of an object that is sought: one that drove away unseen is not sought any more.
inline constexpr double kMostSoughtSigma_m = 3;

// The map's knowledge of an object. It keeps likelihoods instead of a choice, because the next
// detection may change it.
struct MappedObject {
  static constexpr int kStateSize = 9;
  using State = Eigen::Matrix<double, kStateSize, 1>;
  using Covariance = Eigen::Matrix<double, kStateSize, kStateSize>;

  std::int64_t id = 0;  // unique within its map
  ObjectShape shape = ObjectShape::kDisc;
  Time first_seen;
  Time last_seen;
  Time time;  // time of the state
  // Position (m), velocity (m/s) and acceleration (m/s^2) in the world. An object that stands, or
  // more likely stands than moves, has no motion.
  State state = State::Zero();
  Covariance covariance = Covariance::Zero();
  bool may_move = false;     // according to its class
  double move_log_odds = 0;  // log odds that it moves, if it may
  bool moves = false;        // true once beyond doubt; false again when it more likely stands
  int detections = 0;
  double log_odds = 0;  // log odds that it exists
  Hsv color;            // mean colour of the last detection
  ColorProbabilities color_log_likelihoods{};
  DigitLikelihoods digit_log_likelihoods{};

  auto position() const { return state.head<3>(); }
  auto velocity() const { return state.segment<3>(3); }
  // Standard deviation of the position per axis: root of the mean of the three variances, m.
  double sigma_m() const;
  std::size_t color_index() const;  // index of the most likely colour
  // The likeliest digit of a cuboid; nothing when none was read.
  std::optional<LikelyDigit> digit() const;
};

// Moving objects drive: vertical speed and acceleration are this share of the horizontal ones.
inline constexpr double kClimb = 0.02;

// Motion of objects and errors that their detections share: see ObjectMapOptions.
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

// One prediction step: x = transition x, with the covariance 'noise' added.
struct MotionStep {
  MappedObject::Covariance transition;
  MappedObject::Covariance noise;
};

// Steps of 'dt' > 0 seconds for an object that drives and for one that stands.
MotionStep DrivingStep(double dt, const ObjectMotion& motion);
MotionStep StandingStep(double dt, const ObjectMotion& motion);

// Predicts an object to a later time, standing or by its velocity. An earlier time changes nothing.
void PredictObject(Time time, const ObjectMotion& motion, MappedObject* object);

// Merges 'other' into 'kept', the same object at the same time: states are weighted by the inverse
// of their covariances, likelihoods multiplied, detections added. When only one of them moves, the
// state is that of the more certain one, or else that of the later one.
void UnifyObjects(const MappedObject& other, MappedObject* kept);

// Returns the index of the most likely class of an object; nothing when the model has no class of
// its shape and colour.
std::optional<std::size_t> ClassOf(const MappedObject& object, const ObjectModel& model);

// Returns the score of an object: its digit, or its class's score.
double ScoreOf(const MappedObject& object, const ObjectModel& model);

}  // namespace kestrel
