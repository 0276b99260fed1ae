// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/tracking/target_tracker.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>

#include <Eigen/LU>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kestrel/core/base/error.h"
#include "kestrel/core/base/options.h"
#include "kestrel/core/base/random.h"

namespace kestrel {
namespace {

using Path = std::function<Eigen::Vector3d(double seconds)>;

constexpr double kSpeed = 15 / 3.6;
constexpr double kSigma_m = 0.015;
constexpr double kQuarter = std::numbers::pi / 2;

Time At(double seconds) { return Time(DurationFromSeconds(1000 + seconds)); }

Eigen::Vector3d Standing(double) { return {3, 4, 1.5}; }
Eigen::Vector3d Straight(double t) { return {kSpeed * t, 2, 1.5}; }
Eigen::Vector3d Circle(double t) {
  const double radius = 12;
  const double angle = kSpeed / radius * t;
  return {radius * std::cos(angle), radius * std::sin(angle), 1.5};
}
// Lemniscate of Bernoulli, 30 m long, at roughly constant speed.
Eigen::Vector3d FigureOfEight(double t) {
  const double half_length = 15;
  const double even = 2 * std::numbers::pi * kSpeed / (5.2441 * half_length) * t;
  const double angle = even - 0.086 * std::sin(2 * even);
  const double x = half_length * std::cos(angle) / (1 + std::pow(std::sin(angle), 2));
  return {x, x * std::sin(angle), 1.5};
}

// The straight line with a board that sways by 2 cm.
Eigen::Vector3d Swaying(double t) {
  return Straight(t) + 0.02 * std::sin(9 * t) * Eigen::Vector3d(1, -1, 0);
}

Eigen::Vector3d VelocityOf(const Path& path, double t) {
  return (path(t + 1e-4) - path(t - 1e-4)) / 2e-4;
}

class Sensor {
 public:
  explicit Sensor(Path path, double sigma_m = kSigma_m)
      : path_(std::move(path)), sigma_m_(sigma_m), random_(1) {}

  TargetMeasurement Measure(double t) {
    const Eigen::Vector3d noise(random_.Normal(), random_.Normal(), random_.Normal());
    return {.time = At(t),
            .position_in_world = path_(t) + sigma_m_ * noise,
            .covariance = sigma_m_ * sigma_m_ * Eigen::Matrix3d::Identity()};
  }
  // Includes the yaw of a board with an arbitrary mounting angle.
  TargetMeasurement MeasureWithYaw(double t) {
    constexpr double kMounted = 0.3;
    constexpr double kYawSigma = 0.01;
    TargetMeasurement measurement = Measure(t);
    const Eigen::Vector3d velocity = VelocityOf(path_, t);
    const double heading = std::atan2(velocity.y(), velocity.x());
    measurement.yaw = std::remainder(heading + kMounted + kYawSigma * random_.Normal(), kQuarter);
    measurement.yaw_variance = kYawSigma * kYawSigma;
    measurement.yaw_period = kQuarter;
    return measurement;
  }

 private:
  Path path_;
  double sigma_m_;
  Random random_;
};

// Errors after each measurement once the track has settled.
struct Errors {
  std::vector<double> position, velocity, half_second, second, nees;
  int rejected = 0;
};

Errors Follow(const Path& path, const TargetTrackerOptions& options, double sigma_m = kSigma_m) {
  constexpr double kDuration_s = 40;
  TargetTracker tracker(options);
  Sensor sensor(path, sigma_m);
  Errors errors;
  for (double t = 0; t < kDuration_s; t += 1.0 / 30) {
    errors.rejected += tracker.Add(sensor.Measure(t)) > MeasurementFate::kAccepted;
    if (t < 2) continue;
    const auto now = tracker.Predict(At(t));
    const Eigen::Vector3d error = now->motion.position() - path(t);
    errors.position.push_back(error.norm());
    errors.velocity.push_back((now->motion.velocity() - VelocityOf(path, t)).norm());
    errors.nees.push_back(
        error.dot(now->motion.covariance.topLeftCorner<3, 3>().inverse() * error));
    const auto ahead = [&](double s) {
      return (tracker.Predict(At(t + s))->motion.position() - path(t + s)).norm();
    };
    errors.half_second.push_back(ahead(0.5));
    errors.second.push_back(ahead(1));
  }
  return errors;
}

double Rms(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) sum += value * value;
  return std::sqrt(sum / static_cast<double>(values.size()));
}

double Percentile95(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() * 95 / 100];
}

TargetTrackerOptions ConstantVelocity() {
  TargetTrackerOptions options;
  options.turn_noise = 0;
  options.start_turn_sigma_radps = 0;
  options.acceleration_noise = 0.8;  // must account for the curves
  return options;
}

TEST(TargetTracker, FollowsStandingAndMovingTargets) {
  for (const auto& path : {Standing, Straight, Circle, FigureOfEight}) {
    const Errors errors = Follow(path, {});
    EXPECT_LE(errors.rejected, 3);
    EXPECT_LT(Rms(errors.position), 0.02);
    EXPECT_LT(Rms(errors.velocity), 0.2);
    EXPECT_LT(Percentile95(errors.half_second), 0.15);
    EXPECT_LT(Percentile95(errors.second), 0.4);
  }
}

TEST(TargetTracker, PredictsCurvesTwiceAsWellAsConstantVelocity) {
  for (const auto& path : {Circle, FigureOfEight}) {
    const Errors turn = Follow(path, {});
    const Errors straight = Follow(path, ConstantVelocity());
    EXPECT_LT(2 * Percentile95(turn.half_second), Percentile95(straight.half_second));
    EXPECT_LT(2 * Percentile95(turn.second), Percentile95(straight.second));
  }
}

TEST(TargetTracker, CovarianceIsNotTooSmall) {
  for (const auto& path : {Standing, Straight, Circle, FigureOfEight, Swaying}) {
    EXPECT_LT(Rms(Follow(path, {}).nees), 6);  // 3.9 for a chi-square of 3 degrees of freedom
  }
}

TEST(TargetTracker, SeparatesSwayOfBoardFromVehicleSpeed) {
  TargetTrackerOptions rigid;
  rigid.sway_sigma_m = 0;
  constexpr double kNear_m = 0.005;
  const Errors sways = Follow(Swaying, {}, kNear_m);
  const Errors stiff = Follow(Swaying, rigid, kNear_m);
  EXPECT_LT(Rms(sways.velocity), 0.7 * Rms(stiff.velocity));
  EXPECT_LT(Percentile95(sways.second), 0.7 * Percentile95(stiff.second));
}

// Errors (m) of predictions a second ahead, from half a second to 1.5 s after the track's start.
double ErrorAtTheStart(bool with_yaw) {
  TargetTracker tracker({});
  Sensor sensor(FigureOfEight);
  std::vector<double> errors;
  for (double t = 5; t < 6.5; t += 1.0 / 30) {
    tracker.Add(with_yaw ? sensor.MeasureWithYaw(t) : sensor.Measure(t));
    if (t < 5.5) continue;
    const auto ahead = tracker.Predict(At(t + 1));
    errors.push_back((ahead->motion.position() - FigureOfEight(t + 1)).norm());
  }
  return Rms(errors);
}

TEST(TargetTracker, YawRevealsCurveEarly) {
  EXPECT_LT(ErrorAtTheStart(/*with_yaw=*/true), 0.2);
  EXPECT_GT(ErrorAtTheStart(/*with_yaw=*/false), 2 * ErrorAtTheStart(/*with_yaw=*/true));
}

TEST(TargetTracker, WrongYawDoesNotTurnTrack) {
  TargetTracker tracker({});
  Sensor sensor(Circle);
  Random random(7);
  for (int i = 0; i < 300; ++i) {
    const double t = i / 30.0;
    TargetMeasurement measurement = sensor.MeasureWithYaw(t);
    if (i > 30 && random.Chance(0.2)) measurement.yaw = random.Uniform(-1, 1);
    EXPECT_LE(tracker.Add(measurement), MeasurementFate::kAccepted);
    if (t < 2) continue;
    EXPECT_LT((tracker.Predict(At(t + 1))->motion.position() - Circle(t + 1)).norm(), 0.4) << t;
  }
}

// A pad of which first only the part is seen that looks the same after quarter turns.
TEST(TargetTracker, HeadingStaysKnownOnceSeen) {
  for (const double true_yaw : {-3.0, -1.2, 0.4, 1.7, 3.1}) {
    TargetTracker tracker({});
    Sensor sensor(Standing);
    for (int i = 0; i < 60; ++i) {
      const double t = i / 30.0;
      TargetMeasurement measurement = sensor.Measure(t);
      const bool is_heading_seen = i >= 20 && i < 40;
      measurement.yaw_period = is_heading_seen ? kFullTurn : kQuarter;
      measurement.yaw = std::remainder(true_yaw, measurement.yaw_period);
      measurement.yaw_variance = 1e-4;
      EXPECT_LE(tracker.Add(measurement), MeasurementFate::kAccepted);
      const auto target = tracker.Predict(At(t));
      ASSERT_TRUE(target);
      EXPECT_EQ(target->has_yaw(), i >= 20) << i;
      if (!target->has_yaw()) continue;
      EXPECT_NEAR(std::remainder(target->motion.yaw() - true_yaw, kFullTurn), 0, 0.02)
          << true_yaw << " " << i;
    }
  }
}

TEST(TargetTracker, KeepsUncertaintySharedByAllMeasurements) {
  TargetTracker tracker({});
  Sensor sensor(Standing);
  for (int i = 0; i < 300; ++i) {
    TargetMeasurement measurement = sensor.Measure(i / 30.0);
    measurement.shared_covariance = 0.25 * Eigen::Matrix3d::Identity();
    tracker.Add(measurement);
  }
  EXPECT_NEAR(tracker.Predict(At(10))->position_sigma_m(), 0.5, 0.01);
}

TEST(TargetTracker, BridgesDropout) {
  TargetTracker tracker({});
  Sensor sensor(Circle);
  for (double t = 0; t < 5; t += 0.033) tracker.Add(sensor.Measure(t));
  EXPECT_EQ(tracker.StateAt(At(5)), TrackState::kTracking);
  EXPECT_EQ(tracker.StateAt(At(6)), TrackState::kPredicting);
  EXPECT_LT((tracker.Predict(At(6))->motion.position() - Circle(6)).norm(), 0.5);
  EXPECT_EQ(tracker.Add(sensor.Measure(6)), MeasurementFate::kAccepted);
  EXPECT_EQ(tracker.StateAt(At(6)), TrackState::kTracking);
}

TEST(TargetTracker, PassesStatesFromSearchingToLost) {
  TargetTracker tracker({});
  Sensor sensor(Straight);
  EXPECT_EQ(tracker.StateAt(At(0)), TrackState::kSearching);
  EXPECT_FALSE(tracker.Predict(At(0)));
  EXPECT_EQ(tracker.Add(sensor.Measure(0)), MeasurementFate::kStarted);
  EXPECT_EQ(tracker.StateAt(At(0)), TrackState::kSearching);
  for (const double t : {0.025, 0.05, 0.075, 0.1}) tracker.Add(sensor.Measure(t));
  EXPECT_EQ(tracker.StateAt(At(0.1)), TrackState::kTracking);
  EXPECT_EQ(tracker.StateAt(At(3.2)), TrackState::kLost);
  EXPECT_FALSE(tracker.Predict(At(3.2)));
  EXPECT_FALSE(tracker.Predict(At(-1)));
  EXPECT_EQ(tracker.Add(sensor.Measure(9)), MeasurementFate::kStarted);
}

TEST(TargetTracker, LateMeasurementsGiveSameTrack) {
  TargetTracker in_order({});
  TargetTracker late({});
  std::vector<TargetMeasurement> measurements;
  Sensor sensor(FigureOfEight);
  for (int i = 0; i < 60; ++i) measurements.push_back(sensor.Measure(i / 30.0));
  for (const auto& measurement : measurements) in_order.Add(measurement);
  for (int i = 1; i + 2 < 60; i += 3) std::swap(measurements[i], measurements[i + 2]);
  for (const auto& measurement : measurements) {
    ASSERT_LE(late.Add(measurement), MeasurementFate::kAccepted);
  }
  const TurnState a = in_order.Predict(At(2.2))->motion;
  const TurnState b = late.Predict(At(2.2))->motion;
  EXPECT_LT((a.mean - b.mean).norm(), 1e-9);
  EXPECT_LT((a.covariance - b.covariance).norm(), 1e-9);
}

TEST(TargetTracker, RefusesTooLateMeasurementsAndLimitsMemory) {
  TargetTrackerOptions options;
  options.history = 10;
  TargetTracker tracker(options);
  Sensor sensor(Straight);
  for (int i = 0; i < 100; ++i) tracker.Add(sensor.Measure(i / 30.0));
  EXPECT_EQ(tracker.Add(sensor.Measure(89.5 / 30)), MeasurementFate::kTooOld);
  EXPECT_EQ(tracker.Add(sensor.Measure(90.5 / 30)), MeasurementFate::kAccepted);
  EXPECT_FALSE(tracker.Predict(At(89.0 / 30)));
}

TEST(TargetTracker, JumpsAndFalseDetectionsDoNotMoveTrack) {
  TargetTracker tracker({});
  Sensor sensor(Circle);
  Random random(5);
  int rejected = 0;
  for (int i = 0; i < 900; ++i) {
    const double t = i / 30.0;
    TargetMeasurement measurement = sensor.Measure(t);
    const bool is_false = i > 30 && random.Chance(0.2);
    if (is_false) measurement.position_in_world += Eigen::Vector3d(2 + random.Uniform(), -3, 0);
    const MeasurementFate fate = tracker.Add(measurement);
    if (is_false) {
      EXPECT_EQ(fate, MeasurementFate::kFarFromTrack) << t;
      ++rejected;
    }
    if (t < 2) continue;
    EXPECT_LT((tracker.Predict(At(t))->motion.position() - Circle(t)).norm(), 0.15) << t;
  }
  EXPECT_GT(rejected, 100);
}

TEST(TargetTracker, RestartsAtNewPlaceOfTarget) {
  TargetTracker tracker({});
  Sensor sensor(Circle);
  for (double t = 0; t < 3; t += 0.033) tracker.Add(sensor.Measure(t));
  std::vector<MeasurementFate> fates;
  for (int i = 0; i < 8; ++i) {
    TargetMeasurement measurement = sensor.Measure(3 + i / 30.0);
    measurement.position_in_world.x() += 5;
    fates.push_back(tracker.Add(measurement));
  }
  using enum MeasurementFate;
  EXPECT_THAT(fates,
              ::testing::ElementsAre(kFarFromTrack, kFarFromTrack, kFarFromTrack, kFarFromTrack,
                                     kStarted, kAccepted, kAccepted, kAccepted));
}

// A box is dragged off a person by somebody who crosses, long enough for a new track, and is on the
// person again in the next image.
TEST(TargetTracker, NewTrackIsNotThrownAheadByItsNextPlace) {
  constexpr double kRate_hz = 15, kCrossing_s = 3;
  const auto walk = [](double t) { return Eigen::Vector3d(-0.7 * t, 0, 0); };
  TargetTracker tracker({.acceleration_noise = 0.3, .sway_sigma_m = 0, .max_speed_mps = 30});
  Sensor sensor(walk, 0.1);
  int dragged = 0;
  for (double t = 0; t < 6; t += 1 / kRate_hz) {
    TargetMeasurement measurement = sensor.Measure(t);
    const bool is_dragged = t > kCrossing_s && dragged < 5;
    if (is_dragged) measurement.position_in_world += Eigen::Vector3d(0.8, -0.3, 0);
    const MeasurementFate fate = tracker.Add(measurement);
    if (is_dragged && ++dragged == 5) {
      EXPECT_EQ(fate, MeasurementFate::kStarted);
    }
    const auto soon = tracker.Predict(At(t + 0.3));
    if (t < 1) continue;
    ASSERT_TRUE(soon) << t;
    EXPECT_LT((soon->motion.position() - walk(t + 0.3)).norm(), 1.5) << t;
  }
}

TEST(TargetTracker, ClockJumpAheadDoesNotStopTracking) {
  TargetTracker tracker({});
  Sensor sensor(Standing);
  tracker.Add(sensor.Measure(0));
  EXPECT_EQ(tracker.Add(sensor.Measure(1000)), MeasurementFate::kStarted);
  MeasurementFate fate{};
  for (int i = 1; i <= 5; ++i) fate = tracker.Add(sensor.Measure(i / 30.0));
  EXPECT_EQ(fate, MeasurementFate::kStarted);
  EXPECT_EQ(tracker.Add(sensor.Measure(0.2)), MeasurementFate::kAccepted);
}

TEST(TargetTracker, RefusesNonFiniteMeasurements) {
  TargetTracker tracker({});
  Sensor sensor(Standing);
  for (const double bad :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(), 1e300}) {
    TargetMeasurement measurement = sensor.Measure(0);
    measurement.position_in_world.y() = bad;
    EXPECT_EQ(tracker.Add(measurement), MeasurementFate::kInvalid);
    measurement = sensor.Measure(0);
    measurement.covariance(1, 1) = bad;
    EXPECT_EQ(tracker.Add(measurement), MeasurementFate::kInvalid);
    measurement = sensor.Measure(0);
    measurement.shared_covariance(1, 1) = bad;
    EXPECT_EQ(tracker.Add(measurement), MeasurementFate::kInvalid);
    measurement = sensor.MeasureWithYaw(0);
    measurement.yaw_period = bad;
    EXPECT_EQ(tracker.Add(measurement), MeasurementFate::kInvalid);
    measurement = sensor.MeasureWithYaw(0);
    measurement.yaw_variance = bad;
    EXPECT_EQ(tracker.Add(measurement), MeasurementFate::kInvalid);
  }
  TargetMeasurement measurement = sensor.Measure(0);
  measurement.covariance(0, 0) = -1;
  EXPECT_EQ(tracker.Add(measurement), MeasurementFate::kInvalid);
  EXPECT_FALSE(tracker.Predict(At(0)));
}

TEST(TargetTracker, NeverReturnsNonFiniteValues) {
  Random random(11);
  TargetTracker tracker({});
  for (int i = 0; i < 3000; ++i) {
    const double scale = std::pow(10, random.Uniform(-3, 6));
    const double sigma = std::pow(10, random.Uniform(-4, 2.5));
    const double t = i / 30.0 + random.Uniform(-0.5, 0.5);
    tracker.Add({.time = At(t),
                 .position_in_world =
                     scale * Eigen::Vector3d(random.Normal(), random.Normal(), random.Normal()),
                 .covariance = sigma * sigma * Eigen::Matrix3d::Identity(),
                 .yaw = scale * random.Normal(),
                 .yaw_variance = sigma * sigma / 1e3,
                 .yaw_period = kFullTurn / (1 + i % 4)});
    if (const auto estimate = tracker.Predict(At(t + random.Uniform(0, 3)))) {
      ASSERT_TRUE(estimate->motion.mean.allFinite());
      ASSERT_TRUE(estimate->motion.covariance.allFinite());
      ASSERT_TRUE(std::isfinite(estimate->heading() + estimate->position_sigma_m()));
    }
  }
}

TEST(TargetTracker, ChecksOptions) {
  TargetTrackerOptions options;
  options.max_speed_mps = 0;
  options.lost_after_s = 0.1;
  EXPECT_EQ(ViolationsOf(options).size(), 2u);
  EXPECT_THROW(TargetTracker{options}, InputError);
}

}  // namespace
}  // namespace kestrel
