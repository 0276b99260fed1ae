// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/guidance/touchdown_timing.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "kestrel/core/geometry/angles.h"
#include "kestrel/flight/guidance/test_flight.h"

namespace kestrel {
namespace {

struct Touchdown {
  double deck_climb_mps;  // up or down
  double impact_mps;
  double tilt;
  double off_m;
};

// Lands on a ship that heaves by 1 m in 6 s and rolls by 8 degrees.
std::vector<Touchdown> LandOnShips(bool sees_deck) {
  std::vector<Touchdown> touchdowns;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    TestFlight flight({}, {}, {.path = "straight", .speed_mps = 1, .heave_m = 1, .roll_deg = 8},
                      seed);
    const bool is_down = flight.FlyUntil([&] { return flight.Height() <= 0; }, 120,
                                         [&](GuidanceInput& input) {
                                           if (!sees_deck) input.deck.reset();
                                         });
    if (!is_down) continue;
    const double deck_mps = flight.target.Velocity(flight.time_s).z();
    touchdowns.push_back({std::abs(deck_mps), deck_mps - flight.uav.velocity().z(),
                          std::acos(flight.target.Normal(flight.time_s).z()), flight.Off()});
  }
  return touchdowns;
}

double Quantile(std::vector<Touchdown> touchdowns, double Touchdown::*value, double part) {
  std::ranges::sort(touchdowns, {}, value);
  return touchdowns[static_cast<std::size_t>(part * (touchdowns.size() - 1))].*value;
}

TEST(TouchdownTimingTest, TouchesShipDeckWhenLevelAndHardlyRising) {
  const std::vector<Touchdown> timed = LandOnShips(true);
  const std::vector<Touchdown> untimed = LandOnShips(false);
  ASSERT_EQ(timed.size(), 20u);
  std::string figures;
  for (const auto& touchdowns : {timed, untimed}) {
    for (const auto value :
         {&Touchdown::deck_climb_mps, &Touchdown::impact_mps, &Touchdown::tilt}) {
      figures += fmt::format("{:.2f} {:.2f}, ", Quantile(touchdowns, value, 0.5),
                             Quantile(touchdowns, value, 0.95));
    }
  }
  RecordProperty("figures", figures);
  EXPECT_LT(Quantile(timed, &Touchdown::deck_climb_mps, 0.5), 0.2);
  EXPECT_LT(Quantile(timed, &Touchdown::impact_mps, 0.95), 1.2);
  EXPECT_LT(Quantile(timed, &Touchdown::tilt, 0.5), Radians(4));
  EXPECT_LT(Quantile(timed, &Touchdown::off_m, 0.5), 0.2);
  EXPECT_LT(Quantile(timed, &Touchdown::deck_climb_mps, 0.95),
            Quantile(untimed, &Touchdown::deck_climb_mps, 0.95));
}

TEST(TouchdownTimingTest, DoesNotWaitForCar) {
  for (const double slope : {0.0, 0.15}) {
    TouchdownTiming timing;
    const Eigen::Vector3d normal(std::sin(slope), 0, std::cos(slope));
    const Time start = TimeFromNanoseconds(1'000'000'000);
    for (int i = 0; i < 300; ++i) {
      const Time now = start + DurationFromSeconds(0.05 * i);
      timing.Observe(now, 1.8 + 0.02 * std::sin(0.7 * i), normal);
      EXPECT_FALSE(timing.Waits(now, 0.7));
      EXPECT_EQ(timing.Climb(now, 0.1), 0);
    }
  }
}

}  // namespace
}  // namespace kestrel
