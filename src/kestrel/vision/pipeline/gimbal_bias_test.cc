// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/pipeline/gimbal_bias.h"

#include <cmath>
#include <cstdint>
#include <numbers>

#include <gtest/gtest.h>

#include "kestrel/core/base/random.h"
#include "kestrel/core/geometry/angles.h"

namespace kestrel {
namespace {

using Eigen::AngleAxisd;
using Eigen::Quaterniond;
using Eigen::Vector3d;

constexpr double kSeconds = 30;
constexpr double kNoise_m = 0.02;

struct Outcome {
  double before_m, after_m;  // error of the pad's place at the end, without and with the bias
  double surprise;           // squared error of the angles by their own covariance, of three
};

Vector3d Normal(double sigma, Random* random) {
  return sigma * Vector3d(random->Normal(), random->Normal(), random->Normal());
}

// Looks from 'position' at the origin, its image's y axis down.
Quaterniond LookFrom(const Vector3d& position) {
  Eigen::Matrix3d axes;
  axes.col(2) = -position.normalized();
  axes.col(0) = axes.col(2).cross(Vector3d::UnitZ()).normalized();
  axes.col(1) = axes.col(2).cross(axes.col(0));
  return Quaterniond(axes);
}

// From 12 m beside the pad to 3 m, a quarter around it, by a gimbal that is half a degree off in
// each axis.
Outcome Fly(std::uint64_t seed) {
  Random random(seed);
  const Vector3d angles = Normal(Radians(0.6), &random);
  const Quaterniond wrong(AngleAxisd(angles.norm(), angles.normalized()));
  GimbalBias bias;
  Quaterniond learnt = Quaterniond::Identity();
  Outcome outcome{};
  for (double t = 0; t < kSeconds; t += 0.1) {
    const double share = t / kSeconds, turn = std::numbers::pi / 2 * share;
    const Vector3d position =
        (12 - 9 * share) * Vector3d(0.6 * std::cos(turn), 0.6 * std::sin(turn), 0.8);
    const Quaterniond truth = LookFrom(position);
    const Vector3d center = truth.conjugate() * -position;
    const Vector3d seen = center + Normal(kNoise_m, &random);
    const Quaterniond reported = truth * wrong.conjugate();
    const auto place = [&](const Quaterniond& rotation) -> Vector3d {
      return position + rotation * seen;
    };
    const Quaterniond used = reported * learnt;
    outcome.before_m = (position + reported * center).norm();
    outcome.after_m = (position + used * center).norm();
    learnt = learnt * bias.Add({Time(DurationFromSeconds(100 + t)), seen, used, place(used),
                                kNoise_m * kNoise_m * Eigen::Matrix3d::Identity(), 0.01});
  }
  const AngleAxisd left(learnt.conjugate() * wrong);
  const Vector3d error = left.angle() * left.axis();
  outcome.surprise = error.cwiseQuotient(bias.sigma_rad()).squaredNorm();
  return outcome;
}

TEST(GimbalBiasTest, PlacesStandingPadBetterByWhatWasLearnt) {
  constexpr int kFlights = 20;
  double before_m = 0, after_m = 0, surprise = 0;
  for (int seed = 1; seed <= kFlights; ++seed) {
    const Outcome outcome = Fly(static_cast<std::uint64_t>(seed));
    before_m += outcome.before_m / kFlights;
    after_m += outcome.after_m / kFlights;
    surprise += outcome.surprise / kFlights;
  }
  EXPECT_LT(after_m, 0.3 * before_m);
  EXPECT_GT(surprise, 1.5);
  EXPECT_LT(surprise, 5);
}

TEST(GimbalBiasTest, LearnsNothingWhileGimbalTurns) {
  GimbalBias bias;
  for (int i = 0; i < 50; ++i) {
    const Quaterniond turned(AngleAxisd(0.05 * i, Vector3d::UnitZ()));
    const Quaterniond turn = bias.Add({Time(DurationFromSeconds(1 + 0.2 * i)),
                                       {0, 0, 5},
                                       turned,
                                       Vector3d(0.1 * i, 0, 0),
                                       1e-4 * Eigen::Matrix3d::Identity(),
                                       0});
    EXPECT_TRUE(turn.isApprox(Quaterniond::Identity()));
  }
}

}  // namespace
}  // namespace kestrel
