// SPDX-License-Identifier: BSD-3-Clause
// Guided landings with two cameras, one of which is wrong from the first sighting on, in simulated
// time and without images.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

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

// A UAV that the pilot keeps beside the car, 10 m above it.
PointedFlight FlightBesideCar(const TestEye& second, int seed) {
  AutopilotModelOptions options;
  options.pilot.land_after_s = -1;
  options.pilot.offset_east_m = 2 * std::cos(seed);
  options.pilot.offset_north_m = 2 * std::sin(seed);
  options.pilot.heading_deg = 18 * seed;
  PointedFlight::Choice choice;
  choice.has_gimbal = false;
  choice.half_view_deg = 50;
  choice.cameras = {{}, second};
  choice.seed = static_cast<std::uint64_t>(seed);
  return {AutopilotFirmware::kArduPilot, options, TestVehicle("figure8", 4.2), choice};
}

TEST(TwoCamerasTest, CameraThatTurnsIsNoticedInTwoSeconds) {
  constexpr int kFlightsBeside = 20;
  for (const double turned_deg : {3, 5, 10}) {
    for (int seed = 1; seed <= kFlightsBeside; ++seed) {
      PointedFlight flight = FlightBesideCar({}, seed);
      flight.Fly(8 + 0.7 * seed);
      ASSERT_TRUE(flight.has_track());
      ASSERT_FALSE(flight.HasBeenLeftOut(1)) << seed;
      flight.Change(1, {.turned_deg = turned_deg, .turn_axis_deg = 50.0 * seed});
      flight.Fly(2);
      EXPECT_TRUE(flight.HasBeenLeftOut(1)) << turned_deg << " " << seed;
      EXPECT_FALSE(flight.HasBeenLeftOut(0)) << turned_deg << " " << seed;
    }
  }
}

TEST(TwoCamerasTest, CamerasThatAreLittleWrongAreNeverLeftOut) {
  constexpr int kFlightsBeside = 20;
  for (int seed = 1; seed <= kFlightsBeside; ++seed) {
    const TestEye second{
        .late_s = 0.03 * std::cos(seed), .turned_deg = 0.5, .turn_axis_deg = 50.0 * seed};
    PointedFlight flight = FlightBesideCar(second, seed);
    flight.Fly(60);
    ASSERT_TRUE(flight.has_track());
    EXPECT_FALSE(flight.HasBeenLeftOut(0)) << seed;
    EXPECT_FALSE(flight.HasBeenLeftOut(1)) << seed;
  }
}

// Guided landings on the car on the figure of eight.
class TwoCamerasLandingTest : public testing::TestWithParam<AutopilotFirmware> {
 protected:
  struct Landings {
    int landed = 0;
    std::vector<int> left_out;  // flights in which a camera was left out
    std::vector<double> offsets_m;

    double median_m() {
      std::sort(offsets_m.begin(), offsets_m.end());
      return offsets_m.empty() ? 99 : offsets_m[offsets_m.size() / 2];
    }
  };

  static Landings Land(const std::vector<TestEye>& cameras, int flights) {
    Landings landings;
    landings.left_out.resize(cameras.size());
    for (int seed = 1; seed <= flights; ++seed) {
      AutopilotModelOptions options;
      options.pilot.guide_after_s = 4 + 0.9 * seed;
      options.pilot.land_after_s = -1;
      if (GetParam() == AutopilotFirmware::kPx4) options.parameters = "LNDMC_XY_VEL_MAX=12";
      PointedFlight::Choice choice;
      choice.has_gimbal = false;
      choice.half_view_deg = 40;
      choice.cameras = cameras;
      choice.guides = true;
      choice.seed = static_cast<std::uint64_t>(seed);
      PointedFlight flight(GetParam(), options, TestVehicle("figure8", 4.2), choice);
      const bool is_down = flight.Land(120);
      for (std::size_t i = 0; i < cameras.size(); ++i) {
        landings.left_out[i] += flight.HasBeenLeftOut(i) ? 1 : 0;
      }
      const SitlResult& result = flight.model.result();
      if (!is_down || !result.contact || !result.contact->on_board) continue;
      ++landings.landed;
      landings.offsets_m.push_back(result.offset_m());
    }
    return landings;
  }
};
INSTANTIATE_TEST_SUITE_P(Both, TwoCamerasLandingTest,
                         testing::Values(AutopilotFirmware::kArduPilot, AutopilotFirmware::kPx4));

TEST_P(TwoCamerasLandingTest, LandsOnCarAsWithOneCamera) {
  constexpr int kLandings = 5;
  constexpr double kMargin_m = 0.03;
  Landings one = Land({{}}, kLandings);
  ASSERT_EQ(one.landed, kLandings);
  const TestEye wide{.sight_range_m = 15}, narrow{.sight_range_m = 60, .half_view_deg = 15};
  const TestEye ahead{.tilt_deg = 45};
  for (const TestEye& second : {narrow, ahead}) {
    const bool is_narrow = second.half_view_deg > 0;
    Landings two = Land({is_narrow ? wide : TestEye{}, second}, kLandings);
    const std::string name = is_narrow ? "narrow" : "ahead";
    RecordProperty(name + "_median_m", std::to_string(two.median_m()));
    EXPECT_EQ(two.landed, kLandings) << name;
    EXPECT_EQ(two.left_out, std::vector({0, 0})) << name;
    EXPECT_LT(two.median_m(), one.median_m() + kMargin_m) << name;
  }
}

TEST_P(TwoCamerasLandingTest, LandsWithOneCameraWrongInDescent) {
  constexpr int kLandings = 5;
  const std::pair<const char*, TestEye> faults[] = {
      {"stopped", {.wrong_below_m = 5, .is_stopped = true}},
      {"frozen", {.wrong_below_m = 5, .is_frozen = true}},
      {"late", {.wrong_below_m = 5, .late_s = 0.3}},
      {"turned", {.wrong_below_m = 5, .turned_deg = 5}}};
  for (const auto& [name, eye] : faults) {
    for (const std::size_t wrong : {0, 1}) {
      std::vector<TestEye> cameras(2);
      cameras[wrong] = eye;
      const Landings landings = Land(cameras, kLandings);
      EXPECT_EQ(landings.landed, kLandings) << name << wrong;
      EXPECT_EQ(landings.left_out[wrong], kLandings) << name << wrong;
    }
  }
}

}  // namespace
}  // namespace kestrel
