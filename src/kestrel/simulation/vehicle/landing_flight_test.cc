// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/simulation/vehicle/landing_flight.h"

#include <gtest/gtest.h>

#include "kestrel/core/base/options.h"

namespace kestrel {
namespace {

using Eigen::Vector3d;

TEST(LandingFlightTest, ApproachEndsAtGivenAltitude) {
  const LandingFlightOptions options{.start_altitude_m = 13, .end_altitude_m = 0.4};
  Random random(3);
  const Motion motion = LandingFlight(
      options, [](double) { return Vector3d(0, 0, 2); }, 15, &random);
  EXPECT_NEAR(motion(0).translation.z(), 2 + 13, 0.01);
  EXPECT_NEAR(motion(15).translation.z(), 2 + 0.4, 0.01);
}

TEST(LandingFlightTest, RefusesInvalidOptions) {
  LandingFlightOptions flight;
  flight.end_altitude_m = -1;
  EXPECT_EQ(ViolationsOf(flight).at(0), "end_altitude_m is -1, expected 0.1 to 100");
}

}  // namespace
}  // namespace kestrel
