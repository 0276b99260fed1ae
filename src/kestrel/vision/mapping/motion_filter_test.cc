// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/mapping/motion_filter.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <iterator>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "kestrel/vision/mapping/test_map.h"

namespace kestrel {
namespace {

using Eigen::Vector3d;
using Path = std::function<Vector3d(double time_s)>;

constexpr double kPeriod_s = 0.1;
constexpr double kSigma_m = 0.035;  // error of a detection from 6 m, as estimated by the pipeline
constexpr int kSeeds = 20;

// Errors that sightings at one time share, and the clock shift that the map is given.
struct SharedError {
  Path error = [](double /*time_s*/) { return Vector3d(0, 0, 0); };
  Path clock_shift = [](double /*time_s*/) { return Vector3d(0, 0, 0); };
};

// Returns the filter's estimates of a disc on 'path' after each of 'count' sightings.
std::vector<MappedObject> Watch(const Path& path, const SharedError& shared, int count,
                                Random* random) {
  const ObjectMotion motion = ObjectMapOptions().motion();
  MotionFilter filter;
  std::vector<MappedObject> reported(count);
  for (int i = 0; i < count; ++i) {
    const double time_s = kPeriod_s * i;
    ObjectMeasurement seen =
        MeasureNoisily(path(time_s) + shared.error(time_s), kYellow, kSigma_m, random);
    seen.clock_shift = shared.clock_shift(time_s);
    if (i == 0) {
      filter = MotionFilter(seen, motion);
    } else {
      filter.Predict(kPeriod_s, motion);
      filter.Fuse(seen, motion);
    }
    filter.Publish(&reported[i]);
  }
  return reported;
}

Vector3d Stand(double /*time_s*/) { return {1, -2, 0}; }

Path Drive(double speed_mps, Random* random) {
  const double course = random->Uniform(0, 2 * std::numbers::pi);
  const Vector3d velocity = speed_mps * Vector3d(std::cos(course), std::sin(course), 0);
  return [=](double time_s) { return Vector3d(time_s * velocity); };
}

// Error of a navigation: some centimetres, over seconds and minutes.
Path Drift(Random* random) {
  std::vector<double> phases(6);
  for (double& phase : phases) phase = random->Uniform(0, 2 * std::numbers::pi);
  return [=](double time_s) {
    const auto axis = [&](int i) {
      return 0.03 * std::sin(time_s / 3 + phases[i]) + 0.05 * std::sin(time_s / 40 + phases[i + 3]);
    };
    return Vector3d(axis(0), axis(1), axis(2));
  };
}

// Velocity of a UAV that flies at 6 m/s to and fro on lanes with turns.
Path Lanes(Random* random) {
  constexpr double kSpeed_mps = 6;
  const double lane_s = random->Uniform(2, 8);
  const double turn_s = random->Uniform(2, 4);
  const double begin_s = random->Uniform(0, 20);
  return [=](double time_s) {
    const double half_s = lane_s + turn_s;
    const double turns = std::floor((time_s + begin_s) / half_s);
    const double in_lane_s = time_s + begin_s - turns * half_s;
    const double turned = std::max(0.0, in_lane_s - lane_s) / turn_s;
    const double course = std::numbers::pi * (turns + turned);
    return Vector3d(kSpeed_mps * Vector3d(std::cos(course), std::sin(course), 0));
  };
}

// Number of the first sighting after which the disc is reported as moving; 0: never.
int FirstReported(const std::vector<MappedObject>& reported) {
  const auto first =
      std::find_if(reported.begin(), reported.end(), [](auto& one) { return one.moves; });
  return first == reported.end() ? 0 : 1 + static_cast<int>(first - reported.begin());
}

TEST(MotionFilter, StandingObjectNeverMoves) {
  for (int seed = 1; seed <= kSeeds; ++seed) {
    Random random(seed);
    const auto reported = Watch(Stand, {.error = Drift(&random)}, 2000, &random);
    EXPECT_EQ(FirstReported(reported), 0) << "seed " << seed;
    EXPECT_EQ(reported.back().velocity().norm(), 0);
    EXPECT_LT((reported.back().position() - Stand(0)).norm(), 0.15);
  }
}

TEST(MotionFilter, WrongClockDoesNotMoveStandingObject) {
  for (int seed = 1; seed <= kSeeds; ++seed) {
    Random random(seed);
    const Path drift = Drift(&random);
    const Path velocity = Lanes(&random);
    const SharedError shared{
        [&](double time_s) { return Vector3d(drift(time_s) + 0.02 * velocity(time_s)); }, velocity};
    EXPECT_EQ(FirstReported(Watch(Stand, shared, 2000, &random)), 0) << "seed " << seed;
  }
}

TEST(MotionFilter, SingleOutlierDoesNotMoveStandingObject) {
  Random random(1);
  const Path jump = [](double time_s) {
    return Vector3d(std::abs(time_s - 5) < 0.01 ? 0.5 : 0, 0, 0);
  };
  EXPECT_EQ(FirstReported(Watch(Stand, {.error = jump}, 100, &random)), 0);
}

TEST(MotionFilter, DetectsMovingObjectAndItsVelocity) {
  struct Case {
    double speed_mps;
    int sightings;  // latest sighting at which it must be reported as moving
  };
  for (const Case c : {Case{0.3, 15}, Case{0.6, 10}, Case{1.4, 6}, Case{2, 6}}) {
    for (int seed = 1; seed <= kSeeds; ++seed) {
      Random random(seed);
      const Path path = Drive(c.speed_mps, &random);
      const auto reported = Watch(path, {.error = Drift(&random)}, 100, &random);
      const int first = FirstReported(reported);
      EXPECT_TRUE(first > 0 && first <= c.sightings) << c.speed_mps << " m/s: " << first;
      EXPECT_TRUE(reported.back().moves);
      EXPECT_LT((reported.back().velocity() - path(1)).norm(), 0.15) << c.speed_mps << " m/s";
    }
  }
}

TEST(MotionFilter, EstimatesVelocityAfterTenSightings) {
  for (const double speed_mps : {0.6, 1.4, 2.0}) {
    double squares = 0;
    for (int seed = 1; seed <= kSeeds; ++seed) {
      Random random(seed);
      const Path path = Drive(speed_mps, &random);
      const auto reported = Watch(path, {.error = Drift(&random)}, 10, &random);
      squares += (reported.back().velocity() - path(1)).squaredNorm();
    }
    EXPECT_LT(std::sqrt(squares / kSeeds), 0.15) << speed_mps << " m/s";
  }
}

TEST(MotionFilter, StoppedObjectStandsWhereItStopped) {
  constexpr double kStop_s = 20;
  for (int seed = 1; seed <= kSeeds; ++seed) {
    Random random(seed);
    const Path whole = Drive(0.6, &random);
    const Path path = [&](double time_s) { return whole(std::min(time_s, kStop_s)); };
    const auto reported = Watch(path, {}, 250, &random);
    EXPECT_TRUE(reported[200].moves);
    EXPECT_FALSE(reported.back().moves) << "seed " << seed;
    EXPECT_LT((reported.back().position() - whole(kStop_s)).norm(), 0.15);
  }
}

TEST(MotionFilter, DetectsObjectThatStartsMoving) {
  constexpr int kStands = 1000;
  for (int seed = 1; seed <= kSeeds; ++seed) {
    Random random(seed);
    const Path whole = Drive(0.6, &random);
    const Path path = [&](double time_s) { return whole(std::max(0.0, time_s - 100)); };
    const int first = FirstReported(Watch(path, {.error = Drift(&random)}, kStands + 20, &random));
    EXPECT_GT(first, kStands) << "seed " << seed;
  }
}

}  // namespace
}  // namespace kestrel
