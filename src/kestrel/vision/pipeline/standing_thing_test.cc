// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/pipeline/standing_thing.h"

#include <cmath>
#include <tuple>

#include <gtest/gtest.h>

#include "kestrel/core/base/random.h"
#include "kestrel/core/geometry/angles.h"

namespace kestrel {
namespace {

struct Thing {
  const char* name;
  double length_m, width_m, height_m;
  double most_m;  // error of its place on the ground, RMS at 20 degrees and more
};

class StandingThing : public testing::TestWithParam<std::tuple<Thing, double>> {};
INSTANTIATE_TEST_SUITE_P(Kinds, StandingThing,
                         testing::Combine(testing::Values(Thing{"child", 0.25, 0.4, 1.2, 0.25},
                                                          Thing{"tall person", 0.35, 0.6, 1.95,
                                                                0.25},
                                                          Thing{"small car", 3.6, 1.6, 1.2, 0.5},
                                                          Thing{"long car", 5, 1.95, 1.1, 0.5},
                                                          Thing{"motor boat", 6.4, 2.3, 1, 0.7},
                                                          Thing{"bus", 12, 2.5, 3.2, 1.6},
                                                          Thing{"crate", 0.5, 0.5, 0.5, 0.25}),
                                          testing::Values(20, 34, 50, 70)));

TEST_P(StandingThing, IsPlacedFromAllSides) {
  const auto& [thing, depression_deg] = GetParam();
  const double depression = Radians(depression_deg);
  Random random(1);
  double square = 0, normalized = 0;
  constexpr int kSides = 200;
  for (int i = 0; i < kSides; ++i) {
    const double side = random.Uniform(0, kPi / 2);
    const double deep = thing.length_m * std::cos(side) + thing.width_m * std::sin(side);
    const double wide = thing.length_m * std::sin(side) + thing.width_m * std::cos(side);
    const double high = deep * std::sin(depression) + thing.height_m * std::cos(depression);
    const FootBelow foot = EstimateFoot(wide * (1 + 0.05 * random.Normal()),
                                        high * (1 + 0.05 * random.Normal()), depression);
    const double error_m = foot.mean_m - 0.5 * thing.height_m * std::cos(depression);
    square += std::pow(error_m / std::sin(depression), 2) / kSides;
    normalized += std::pow(error_m / foot.sigma_m, 2) / kSides;
  }
  EXPECT_LT(std::sqrt(square), thing.most_m) << thing.name;
  EXPECT_LT(normalized, 1.5) << thing.name << ": 1 is right";
}

TEST(StandingThing, SeenLevelStandsAtTheLowerEnd) {
  const FootBelow foot = EstimateFoot(0.6, 1.8, 0);
  EXPECT_NEAR(foot.mean_m, 0.9, 1e-9);
  EXPECT_NEAR(foot.sigma_m, 0, 1e-6);
}

TEST(StandingThing, SeenFromAboveStandsInTheMiddle) {
  EXPECT_NEAR(EstimateFoot(1.8, 4.5, Radians(90)).mean_m, 0, 1e-9);
}

}  // namespace
}  // namespace kestrel
