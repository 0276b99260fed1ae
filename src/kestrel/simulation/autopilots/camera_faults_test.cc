// SPDX-License-Identifier: BSD-3-Clause
// Guided landings with two cameras, one of which is wrong from the first sighting on, in simulated
// time and without images.
#include <cstdint>
#include <string>
#include <tuple>

#include <gtest/gtest.h>

#include "kestrel/simulation/autopilots/test_pointed_flight.h"

namespace kestrel {
namespace {

constexpr int kFlights = 5;

// A vehicle, and the index of the camera that is wrong.
class TwoCameraFlightTest : public testing::TestWithParam<std::tuple<const char*, std::size_t>> {
 protected:
  static constexpr double kLongest_s = 120;  // for a flight

  static std::size_t wrong() { return std::get<1>(GetParam()); }
  static std::size_t right() { return 1 - wrong(); }

  // 'right_sight_m': range from which the other camera sees the pad.
  static PointedFlight FlightWith(const TestEye& wrong_eye, int seed,
                                  double right_sight_m = kTestSightRange_m) {
    const std::string path = std::get<0>(GetParam());
    AutopilotModelOptions options;
    options.pilot.guide_after_s = 4 + 0.9 * seed;
    options.pilot.land_after_s = -1;
    PointedFlight::Choice choice;
    choice.has_gimbal = false;
    choice.half_view_deg = 50;
    choice.cameras.resize(2);
    choice.cameras[wrong()] = wrong_eye;
    choice.cameras[right()].sight_range_m = right_sight_m;
    choice.guides = true;
    choice.seed = static_cast<std::uint64_t>(seed);
    return {AutopilotFirmware::kArduPilot, options, TestVehicle(path, path == "standing" ? 0 : 4.2),
            choice};
  }
  static bool Lands(PointedFlight* flight) {
    const bool is_down = flight->Land(kLongest_s);
    const auto& contact = flight->model.result().contact;
    return is_down && contact && contact->on_board;
  }
  static void ExpectOnlyWrongOneIsLeftOut(const TestEye& wrong_eye) {
    constexpr double kLater_m = 12;  // the wrong one sees the pad first
    for (const double right_sight_m : {kTestSightRange_m, kLater_m}) {
      for (int seed = 1; seed <= kFlights; ++seed) {
        PointedFlight flight = FlightWith(wrong_eye, seed, right_sight_m);
        EXPECT_TRUE(Lands(&flight)) << seed << " " << right_sight_m;
        EXPECT_GT(flight.LeftOutFor(wrong()), 5) << seed << " " << right_sight_m;
        EXPECT_LT(flight.LeftOutFor(right()), 5) << seed << " " << right_sight_m;
      }
    }
  }
};
INSTANTIATE_TEST_SUITE_P(StandingAndMoving, TwoCameraFlightTest,
                         testing::Combine(testing::Values("standing", "figure8"),
                                          testing::Values(0, 1)));

TEST_P(TwoCameraFlightTest, LateCameraIsLeftOutAndUavLands) {
  ExpectOnlyWrongOneIsLeftOut({.late_s = 0.3});
}

// Nothing in the views says which mount is turned.
TEST_P(TwoCameraFlightTest, TurnedCameraIsNoticedAndUavComesDown) {
  for (int seed = 1; seed <= kFlights; ++seed) {
    PointedFlight flight = FlightWith({.turned_deg = 5}, seed);
    EXPECT_TRUE(flight.Land(kLongest_s)) << seed;
    EXPECT_GT(flight.LeftOutFor(0) + flight.LeftOutFor(1), 1) << seed;
  }
}

TEST_P(TwoCameraFlightTest, CamerasWhoseClocksAreLittleApartAreBothUsed) {
  constexpr double kProbation_s = 2.5;  // a track that begins wrong may cost one of them this once
  for (const double late_s : {-0.03, 0.03}) {
    for (int seed = 1; seed <= kFlights; ++seed) {
      PointedFlight flight = FlightWith({.late_s = late_s}, seed);
      EXPECT_TRUE(Lands(&flight)) << seed << " " << late_s;
      EXPECT_LT(flight.LeftOutFor(right()), kProbation_s) << seed << " " << late_s;
      EXPECT_LT(flight.LeftOutFor(wrong()), kProbation_s) << seed << " " << late_s;
    }
  }
}

}  // namespace
}  // namespace kestrel
