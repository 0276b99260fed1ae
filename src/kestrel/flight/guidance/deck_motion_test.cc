// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/guidance/deck_motion.h"

#include <cmath>
#include <functional>
#include <limits>

#include <gtest/gtest.h>

#include "kestrel/core/base/random.h"
#include "kestrel/core/geometry/angles.h"
#include "kestrel/simulation/scene/motion.h"

namespace kestrel {
namespace {

using Signal = std::function<double(double time_s)>;

constexpr double kStep_s = 0.05;
constexpr double kNoise_m = 0.03;
constexpr double kNoise_deg = 1;

// A deck on waves, and what is observed of it.
struct Waves {
  Signal height;
  Signal roll;  // rad, about the x axis

  double Climb(double time_s) const {
    return (height(time_s + 0.01) - height(time_s - 0.01)) / 0.02;
  }
  static Waves Regular(double range_m, double period_s, double roll_deg, double phase) {
    const double rate = 2 * kPi / period_s;
    return {[=](double time_s) { return 2 + 0.5 * range_m * std::sin(rate * time_s + phase); },
            [=](double time_s) { return Radians(roll_deg) * std::cos(rate * time_s + phase); }};
  }
  // Waves of periods from 0.6 to 1.6 of this one.
  static Waves Irregular(double sigma_m, double period_s, double roll_sigma_deg, Random* random) {
    const Signal heave = Wander(sigma_m, period_s, random);
    const Signal roll = Wander(Radians(roll_sigma_deg), period_s, random);
    return {[=](double time_s) { return 2 + heave(time_s); }, roll};
  }
};

Time At(double time_s) { return Time(DurationFromSeconds(100 + time_s)); }

// A deck that is observed for as long as a test needs it.
struct Observed {
  Observed(const Waves& waves_in, std::uint64_t seed) : waves(waves_in), random(seed) {}

  void Observe(double seconds) {
    for (const double end_s = time_s + seconds; time_s < end_s; time_s += kStep_s) {
      const double height_m = waves.height(time_s) + kNoise_m * random.Normal();
      const double roll = waves.roll(time_s) + Radians(kNoise_deg) * random.Normal();
      deck.Observe(At(time_s), height_m, {0, -std::sin(roll), std::cos(roll)});
      seen_s = time_s;
    }
  }

  Waves waves;
  Random random;
  DeckMotion deck;
  double time_s = 0;
  double seen_s = 0;
};

struct Errors {
  double height_m = 0;  // RMS
  double climb_mps = 0;
  double tilt_deg = 0;
  double within_two_sigma = 0;  // part of the heights
};

Errors ErrorsOf(const std::function<Waves(Random*)>& make, double ahead_s) {
  Errors errors;
  int count = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    Random random(seed);
    Observed observed(make(&random), seed + 100);
    observed.Observe(15);
    for (int i = 0; i < 20; ++i) {
      observed.Observe(1);
      const auto deck = observed.deck.Ahead(ahead_s);
      const double then_s = observed.seen_s + ahead_s;
      const double height_error = deck->height_m - observed.waves.height(then_s);
      errors.height_m += std::pow(height_error, 2);
      errors.climb_mps += std::pow(deck->climb_mps - observed.waves.Climb(then_s), 2);
      errors.tilt_deg += std::pow(Degrees(deck->tilt - std::abs(observed.waves.roll(then_s))), 2);
      errors.within_two_sigma += std::abs(height_error) < 2 * deck->height_sigma_m ? 1 : 0;
      ++count;
    }
  }
  errors.height_m = std::sqrt(errors.height_m / count);
  errors.climb_mps = std::sqrt(errors.climb_mps / count);
  errors.tilt_deg = std::sqrt(errors.tilt_deg / count);
  errors.within_two_sigma /= count;
  return errors;
}

// Heave of 1 m in 6 s with 8 degrees of roll.
Waves Ship(Random* random) { return Waves::Regular(1, 6, 8, random->Uniform(0, 2 * kPi)); }
Waves Sea(Random* random) { return Waves::Irregular(0.35, 6, 4, random); }

TEST(DeckMotionTest, PredictsSwell) {
  for (const double ahead_s : {0.5, 1.0, 2.0, 3.0}) {
    const Errors errors = ErrorsOf(Ship, ahead_s);
    EXPECT_LT(errors.height_m, 0.06 + 0.03 * ahead_s) << ahead_s;
    EXPECT_LT(errors.climb_mps, 0.08 + 0.03 * ahead_s) << ahead_s;
    EXPECT_LT(errors.tilt_deg, 1 + 0.5 * ahead_s) << ahead_s;
  }
}

// The mean level would be wrong by 0.35 m.
TEST(DeckMotionTest, PredictsIrregularWavesWithUncertainty) {
  const Errors soon = ErrorsOf(Sea, 1);
  EXPECT_LT(soon.height_m, 0.15);
  EXPECT_LT(soon.climb_mps, 0.2);
  const Errors later = ErrorsOf(Sea, 2);
  EXPECT_LT(later.height_m, 0.27);
  for (const Errors& errors : {soon, later}) EXPECT_GT(errors.within_two_sigma, 0.9);
}

TEST(DeckMotionTest, FindsWindowsOfLevelSlowlyRisingDeck) {
  constexpr double kMaxTilt_deg = 4;
  constexpr double kMaxClimb_mps = 0.25;
  int windows = 0;
  int good = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    Random random(seed);
    Observed observed(Sea(&random), seed);
    observed.Observe(15);
    for (int i = 0; i < 20; ++i) {
      observed.Observe(1);
      const auto window = observed.deck.NextWindow(Radians(kMaxTilt_deg), kMaxClimb_mps);
      if (!window) continue;
      EXPECT_LE(window->begin_s, window->end_s);
      const double middle_s = observed.seen_s + 0.5 * (window->begin_s + window->end_s);
      ++windows;
      // With a margin for the errors of the forecast.
      good += std::abs(observed.waves.Climb(middle_s)) < 1.3 * kMaxClimb_mps &&
                      std::abs(observed.waves.roll(middle_s)) < Radians(1.3 * kMaxTilt_deg)
                  ? 1
                  : 0;
    }
  }
  EXPECT_GT(windows, 200);
  EXPECT_GT(good, 0.85 * windows);
}

TEST(DeckMotionTest, StandingDeckIsAlwaysInWindow) {
  Observed observed({[](double) { return 1.8; }, [](double) { return 0.0; }}, 1);
  observed.Observe(5);
  EXPECT_FALSE(observed.deck.NextWindow(Radians(3), 0.15)) << "not known yet";
  observed.Observe(5);
  const auto window = observed.deck.NextWindow(Radians(3), 0.15);
  ASSERT_TRUE(window);
  EXPECT_EQ(window->begin_s, 0);
  EXPECT_NEAR(window->end_s, 3, 0.11);
  const auto steep = Waves::Regular(0, 6, 0, 0);
  Observed tilted({steep.height, [](double) { return Radians(10); }}, 1);
  tilted.Observe(10);
  EXPECT_FALSE(tilted.deck.NextWindow(Radians(3), 0.15)) << "it lies at 10 degrees";
}

TEST(DeckMotionTest, IgnoresInvalidObservationsAndRestartsAfterGap) {
  Observed observed(Waves::Regular(1, 6, 8, 0), 1);
  observed.Observe(10);
  const double before_m = observed.deck.Ahead(1)->height_m;
  observed.deck.Observe(At(observed.seen_s - 1), 50, {0, 0, 1});
  observed.deck.Observe(At(observed.seen_s + 1), std::numeric_limits<double>::quiet_NaN(),
                        {0, 0, 1});
  EXPECT_EQ(observed.deck.Ahead(1)->height_m, before_m);
  observed.time_s += 5;
  observed.Observe(1);
  EXPECT_FALSE(observed.deck.is_known());
}

}  // namespace
}  // namespace kestrel
