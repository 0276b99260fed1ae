// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/pipeline/stamp_lag.h"

#include <chrono>
#include <cmath>
#include <cstdint>
#include <random>

#include <gtest/gtest.h>

#include "kestrel/core/geometry/angles.h"

namespace kestrel {
namespace {

using Eigen::Vector3d;

constexpr double kFlight_s = 5;

Time AtSeconds(double seconds) { return Time(DurationFromSeconds(seconds)); }

// A UAV 8 m above the ground whose camera looks down, and what it sees of a target.
struct Flight {
  double swing = Radians(4);    // amplitude of roll and pitch
  double target_speed_mps = 0;  // on a circle
  double target_radius_m = 12;
  double late_s = 0;  // how late the stamps are
  std::uint64_t seed = 1;

  Vector3d Target(double t) const {
    const double angle = target_speed_mps / target_radius_m * t;
    return target_radius_m * Vector3d(std::sin(angle), 1 - std::cos(angle), 0);
  }
  RigidTransform Camera(double t) const {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> uniform(0, 1);
    const auto swinging = [&] {
      const double phase = 6 * uniform(random), rate = 2 + 4 * uniform(random);
      return swing * std::sin(phase + rate * t);
    };
    const Vector3d lean(swinging(), swinging(), 0);
    const Vector3d aside(0.4 * std::sin(0.5 * t), 0.3 * t, 8);
    return {RotationBy(lean) * RotationBy({kPi, 0, 0}), Target(t) + aside};
  }
  std::optional<double> Contradiction(double rate_hz = 20) const;
};

std::optional<double> Flight::Contradiction(double rate_hz) const {
  CameraCalibration calibration;
  calibration.body_from_camera = RigidTransform();
  CameraPoses poses(calibration, 1000, std::chrono::milliseconds(200), Duration::zero(),
                    Duration::zero());
  for (double t = 0; t < kFlight_s; t += 0.02) poses.Add(PoseSample{AtSeconds(t), Camera(t)});
  std::mt19937 random(seed);
  std::normal_distribution<double> noise_m(0, 0.03);
  StampLag lag;
  for (double t = 0.6; t < kFlight_s; t += 1 / rate_hz) {
    const Vector3d seen = Camera(t - late_s).Inverse() * Target(t - late_s);
    lag.Add(AtSeconds(t), seen + Vector3d(noise_m(random), noise_m(random), noise_m(random)), 0.03);
  }
  return lag.Contradiction(poses);
}

TEST(StampLagTest, FindsHowLateStampsAre) {
  for (const double speed_mps : {0.0, 4.0}) {
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
      const auto lag_s =
          Flight{.target_speed_mps = speed_mps, .late_s = 0.3, .seed = seed}.Contradiction();
      ASSERT_TRUE(lag_s) << seed << " " << speed_mps;
      EXPECT_NEAR(*lag_s, 0.3, 0.05) << seed << " " << speed_mps;
    }
  }
}

TEST(StampLagTest, FindsHowEarlyStampsAre) {
  const auto lag_s = Flight{.late_s = -0.2}.Contradiction();
  ASSERT_TRUE(lag_s);
  EXPECT_NEAR(*lag_s, -0.2, 0.05);
}

TEST(StampLagTest, ClocksThatAreLittleApartAreRight) {
  for (const double speed_mps : {0.0, 4.0}) {
    for (const double late_s : {-0.06, -0.03, 0.0, 0.03, 0.06}) {
      for (std::uint64_t seed = 1; seed <= 20; ++seed) {
        EXPECT_FALSE(
            (Flight{.target_speed_mps = speed_mps, .late_s = late_s, .seed = seed}.Contradiction()))
            << seed << " " << speed_mps << " " << late_s;
      }
    }
  }
}

TEST(StampLagTest, IsUnknownWhereTheViewDoesNotTurn) {
  EXPECT_FALSE((Flight{.swing = 0, .late_s = 0.3}.Contradiction()));
}

TEST(StampLagTest, IsUnknownFromFewSightings) {
  EXPECT_FALSE((Flight{.late_s = 0.3}.Contradiction(2)));
}

}  // namespace
}  // namespace kestrel
