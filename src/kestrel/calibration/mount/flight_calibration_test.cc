// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/calibration/mount/flight_calibration.h"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kestrel/core/base/error.h"
#include "kestrel/core/base/random.h"
#include "kestrel/core/geometry/angles.h"

namespace kestrel {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Le;
using ::testing::Not;

constexpr double kDegree = kPi / 180;

Eigen::Quaterniond Turn(double angle, const Eigen::Vector3d& axis) {
  return Eigen::Quaterniond(Eigen::AngleAxisd(angle, axis));
}

Time At(double seconds) { return Time(DurationFromSeconds(10 + seconds)); }

// A UAV above the pattern that sways and turns, with the data of its camera and its navigation.
struct Flight {
  double sway = 0.05;  // amplitude of roll and pitch, rad
  double turn = 0.2;   // rad/s
  double climb_m = 3;  // from 2 m up
  double clock_offset_s = 0.12;
  Eigen::Vector3d angles{0.03, -0.05, 0.06};  // roll, pitch, yaw of the mount's error
  double target_speed_mps = 0;
  double noise_m = 0.005;
  double scale = 1;  // factor of the distances that the camera reports

  RigidTransform WorldFromBody(double t) const {
    return {Turn(turn * t, Eigen::Vector3d::UnitZ()) *
                Turn(sway * std::sin(4 * t), Eigen::Vector3d::UnitY()) *
                Turn(sway * std::sin(3 * t + 1), Eigen::Vector3d::UnitX()),
            {0.5 * std::sin(t), 0.5 * std::cos(0.7 * t), 2 + climb_m * t / 15}};
  }
  RigidTransform NominalMount() const {
    return {Turn(kPi, Eigen::Vector3d::UnitX()), {0.1, 0, -0.05}};
  }
  RigidTransform TrueMount() const {
    const Eigen::Quaterniond error = Turn(angles.z(), Eigen::Vector3d::UnitZ()) *
                                     Turn(angles.y(), Eigen::Vector3d::UnitY()) *
                                     Turn(angles.x(), Eigen::Vector3d::UnitX());
    return {error * NominalMount().rotation, NominalMount().translation};
  }
  std::vector<TargetSighting> Sightings() const {
    Random random(3);
    std::vector<TargetSighting> sightings;
    for (int i = 0; i < 300; ++i) {
      const double t = 0.5 + i / 20.0;
      const Eigen::Vector3d target(target_speed_mps * t, 0.2, 0);
      const Eigen::Vector3d noise(random.Normal(), random.Normal(), random.Normal());
      const Eigen::Vector3d center = (WorldFromBody(t) * TrueMount()).Inverse() * target;
      sightings.push_back({At(t), scale * center + noise_m * noise, 0.01});
    }
    return sightings;
  }
  std::vector<PoseSample> Poses() const {
    std::vector<PoseSample> poses;
    for (int i = 0; i < 1700; ++i) {
      poses.push_back({At(0.01 * i + clock_offset_s), WorldFromBody(0.01 * i)});
    }
    return poses;
  }
  FlightCalibration Calibrate(const FlightCalibrationOptions& options) const {
    return CalibrateFlight(Sightings(), Poses(), {NominalMount(), 0}, options);
  }
};

TEST(CalibrateFlight, FindsMountAndClockTogether) {
  const Flight flight{.sway = 0.3};
  const FlightCalibration calibration = flight.Calibrate({});
  EXPECT_LT((calibration.angles - flight.angles).norm(), 0.1 * kDegree);
  EXPECT_NEAR(calibration.estimate.clock_offset_s, flight.clock_offset_s, 0.001);
  EXPECT_LT(
      calibration.estimate.body_from_camera.rotation.angularDistance(flight.TrueMount().rotation),
      0.1 * kDegree);
  EXPECT_LT(calibration.rms_after_m, 0.012);
  EXPECT_GT(calibration.rms_before_m, 0.1);
  ASSERT_EQ(calibration.residuals.size(), static_cast<std::size_t>(calibration.sightings));
  double squares = 0;
  for (const SightingResidual& residual : calibration.residuals) {
    squares += residual.after_m * residual.after_m;
  }
  EXPECT_NEAR(std::sqrt(squares / calibration.sightings), calibration.rms_after_m, 1e-9);
  EXPECT_THAT(calibration.warnings, IsEmpty());
}

TEST(CalibrateFlight, FindsMountWithKnownClock) {
  Flight flight;
  flight.clock_offset_s = 0;
  const FlightCalibration calibration = flight.Calibrate({.estimate_clock = false});
  EXPECT_LT((calibration.angles - flight.angles).norm(), 0.1 * kDegree);
  EXPECT_EQ(calibration.estimate.clock_offset_s, 0);
  EXPECT_EQ(calibration.clock_sigma_s, 0);
}

TEST(CalibrateFlight, FindsClockOverMovingTarget) {
  Flight flight{.sway = 0.4};
  flight.angles.setZero();
  flight.target_speed_mps = 4;
  for (const double offset : {-0.1, 0.0, 0.07, 0.3}) {
    flight.clock_offset_s = offset;
    const FlightCalibration calibration =
        flight.Calibrate({.estimate_mount = false, .knot_spacing_s = 2});
    EXPECT_NEAR(calibration.estimate.clock_offset_s, offset, 0.001);
    EXPECT_LT(calibration.clock_sigma_s, 0.001);
  }
}

TEST(CalibrateFlight, WrongPatternSizeDoesNotChangeClock) {
  const Flight flight{.climb_m = 6, .scale = 1.005};
  const FlightCalibration calibration = flight.Calibrate({});
  EXPECT_NEAR(calibration.estimate.clock_offset_s, flight.clock_offset_s, 0.002);
}

// A gimbal that swings, stamps its reports late and is mounted askew, over a UAV that sways.
TEST(CalibrateFlight, FindsBiasAndClockOfGimbal) {
  constexpr double kStampDelay_s = 0.06;
  const Flight flight{.sway = 0.1};
  const auto platform = [](double t) {
    return Turn(0.5 * std::sin(1.3 * t), Eigen::Vector3d::UnitZ()) *
           Turn(1.2 + 0.3 * std::sin(t), Eigen::Vector3d::UnitY());
  };
  const RigidTransform ahead{Eigen::Quaterniond(0.5, -0.5, 0.5, -0.5), {0.02, 0, 0}};
  const RigidTransform on_platform{
      flight.TrueMount().rotation * flight.NominalMount().rotation.conjugate() * ahead.rotation,
      ahead.translation};
  for (const double rate_hz : {20.0, 5.0}) {
    FlownGimbal gimbal{
        {Eigen::Quaterniond::Identity(), {0.1, 0, -0.05}}, {}, flight.clock_offset_s};
    for (double t = 0; t < 17; t += 1 / rate_hz) {
      gimbal.reports.push_back(
          {At(t + flight.clock_offset_s + kStampDelay_s), platform(t), YawFrame::kVehicle});
    }
    std::vector<TargetSighting> sightings;
    for (int i = 0; i < 300; ++i) {
      const double t = 0.5 + i / 20.0;
      const RigidTransform camera =
          WorldFromPlatform(flight.WorldFromBody(t), gimbal.body_from_pivot,
                            {platform(t), YawFrame::kVehicle}) *
          on_platform;
      sightings.push_back({At(t), camera.Inverse() * Eigen::Vector3d(0, 0.2, 0), 0.01});
    }
    const FlightCalibration calibration =
        CalibrateFlight(sightings, flight.Poses(), {ahead, flight.clock_offset_s}, {}, gimbal);
    EXPECT_LT((calibration.angles - flight.angles).norm(), 0.1 * kDegree) << rate_hz;
    EXPECT_NEAR(calibration.estimate.clock_offset_s, flight.clock_offset_s + kStampDelay_s, 0.005)
        << rate_hz;
  }
}

TEST(CalibrateFlight, RejectsFalseDetections) {
  const Flight flight{.sway = 0.3};
  std::vector<TargetSighting> sightings = flight.Sightings();
  for (std::size_t i = 0; i < sightings.size(); i += 20) {
    sightings[i].center_in_camera += Eigen::Vector3d(2, 1, 0);
  }
  const FlightCalibration calibration =
      CalibrateFlight(sightings, flight.Poses(), {flight.NominalMount(), 0}, {});
  EXPECT_GE(calibration.outliers, 14);
  EXPECT_LT((calibration.angles - flight.angles).norm(), 0.1 * kDegree);
}

TEST(CalibrateFlight, ReportsWhatFlightCannotDetermine) {
  // It hangs still: nothing distinguishes the mount from the place of the target, or one time from
  // another.
  Flight flight{.sway = 0, .turn = 0, .climb_m = 0};
  flight.noise_m = 0.02;
  std::vector<PoseSample> poses = flight.Poses();
  for (PoseSample& pose : poses) pose.world_from_body = poses.front().world_from_body;
  const FlightCalibration calibration =
      CalibrateFlight(flight.Sightings(), poses, {flight.NominalMount(), 0}, {});
  EXPECT_THAT(WhyOfNoUse(calibration),
              AllOf(HasSubstr("does not determine the mount's roll (+- "), HasSubstr("yaw (+- "),
                    HasSubstr("the UAV turned by 0 degrees and changed its height by 0.0 m"),
                    HasSubstr("does not determine the clock offset"), Not(HasSubstr("\n"))));
  EXPECT_THAT(calibration.motion.tilt, Le(0.2));
}

TEST(CalibrateFlight, AcceptsFlightThatDeterminesAllQuantities) {
  const Flight flight{.sway = 0.3, .climb_m = 6};
  const FlightCalibration calibration = flight.Calibrate({});
  EXPECT_EQ(WhyOfNoUse(calibration), "");
  EXPECT_NEAR(calibration.motion.height_span_m, 6, 1);
  EXPECT_GT(calibration.motion.turn, 0.5);
}

TEST(CalibrateFlight, RejectsUncertainQuantities) {
  FlightCalibration result;
  result.rms_before_m = result.rms_after_m = 0.1;
  EXPECT_EQ(WhyOfNoUse(result), "");
  result.angle_sigmas.y() = Radians(13.5);
  EXPECT_THAT(WhyOfNoUse(result), HasSubstr("the mount's pitch (+- 13.5 degrees): over the"));
  result.angle_sigmas.setZero();
  result.rms_after_m = 0.2;
  EXPECT_EQ(WhyOfNoUse(result), "the positions agree less than before");
}

TEST(CalibrateFlight, RefusesTooFewSightings) {
  const Flight flight;
  std::vector<TargetSighting> sightings = flight.Sightings();
  sightings.resize(10);
  EXPECT_THROW(CalibrateFlight(sightings, flight.Poses(), {flight.NominalMount(), 0}, {}),
               InputError);
  EXPECT_THROW(CalibrateFlight(flight.Sightings(), {}, {flight.NominalMount(), 0}, {}), InputError);
}

}  // namespace
}  // namespace kestrel
