// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include <gtest/gtest.h>

#include "kestrel/flight/guidance/test_flight.h"

namespace kestrel {

inline constexpr auto kAsItIs = [](GuidanceInput&) {};
inline constexpr auto kNoTarget = [](GuidanceInput& input) { input.target.reset(); };
inline constexpr auto kUnseen = [](GuidanceInput& input) { input.target_age_s = 1.5; };
inline constexpr auto kTakenBack = [](GuidanceInput& input) { input.is_guided = false; };

// Flies until 'phase' is reached. In contact the deck carries the UAV.
inline TestFlight InPhase(GuidancePhase phase, const GuidanceOptions& options = {}) {
  TestFlight flight(options);
  if (phase == GuidancePhase::kSearch) {
    flight.FlyUntil([] { return false; }, 2, kNoTarget);
  } else if (phase == GuidancePhase::kFollow) {
    // The target is not known well enough for a descent.
    flight.FlyUntil([&] { return flight.output.phase == phase && flight.Height() < 2.7; }, 30,
                    [&](GuidanceInput& input) {
                      input.target = flight.target.Estimate(input.now, flight.time_s, 0.4);
                    });
  } else if (phase == GuidancePhase::kGoAround) {
    flight.FlyUntilPhase(GuidancePhase::kDescend);
    flight.FlyUntil([&] { return flight.Height() < 1.2; }, 30);
    flight.FlyUntil([&] { return flight.output.phase == phase; }, 5, kUnseen);
  } else if (phase == GuidancePhase::kLanded) {
    flight.LandOnDeck();
  } else {
    flight.FlyUntilPhase(phase);
  }
  EXPECT_EQ(ToString(flight.output.phase), std::string(ToString(phase)));
  return flight;
}

}  // namespace kestrel
