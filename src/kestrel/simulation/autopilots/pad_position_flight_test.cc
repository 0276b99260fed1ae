// SPDX-License-Identifier: BSD-3-Clause
// Simulated autopilots without GNSS fly and land by their place over a pad that stands, over
// MAVLink, in simulated time and without images.
#include <cstdint>
#include <limits>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kestrel/simulation/autopilots/test_pointed_flight.h"

namespace kestrel {
namespace {

using testing::HasSubstr;
using testing::Not;

class PadPositionFlightTest : public testing::TestWithParam<AutopilotFirmware> {
 protected:
  static bool is_px4() { return GetParam() == AutopilotFirmware::kPx4; }

  static AutopilotModelOptions Uav(double altitude_m, double guide_after_s) {
    AutopilotModelOptions options;
    options.estimate.has_gnss = false;
    options.parameters = is_px4() ? "EKF2_EV_CTRL=11" : "VISO_TYPE=1,EK3_SRC1_POSXY=6";
    options.pilot.start_altitude_m = altitude_m;
    options.pilot.offset_east_m = 0.5;
    options.pilot.offset_north_m = -0.3;
    options.pilot.land_after_s = -1;
    options.pilot.guide_after_s = guide_after_s;
    return options;
  }
  static PointedFlight Flight(const AutopilotModelOptions& options, bool by_pad = true,
                              std::uint64_t seed = 1) {
    return {GetParam(),
            options,
            TestVehicle("standing", 0),
            {.has_gimbal = false, .guides = true, .sends_pad_position = by_pad, .seed = seed}};
  }
  // Lands; returns how far from the pad's centre the feet came down, m.
  static double OffsetOf(const AutopilotModelOptions& options, bool by_pad, std::uint64_t seed) {
    PointedFlight flight = Flight(options, by_pad, seed);
    EXPECT_TRUE(flight.Land(90)) << seed << ": " << flight.reported;
    const auto& contact = flight.model.result().contact;
    if (!contact) return std::numeric_limits<double>::infinity();
    return contact->feet_in_pattern.head<2>().norm();
  }
};
INSTANTIATE_TEST_SUITE_P(Both, PadPositionFlightTest,
                         testing::Values(AutopilotFirmware::kArduPilot, AutopilotFirmware::kPx4));

// As near to its centre as with GNSS: the wind decides.
TEST_P(PadPositionFlightTest, LandsOnPadThatStands) {
  constexpr double kWorse_m = 0.03;
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    AutopilotModelOptions with_gnss = Uav(5, 10);
    with_gnss.estimate.has_gnss = true;
    const double limit_m = kWorse_m + OffsetOf(with_gnss, false, seed);
    const double offset_m = OffsetOf(Uav(5, 10), true, seed);
    RecordProperty("offset_m_" + std::to_string(seed), std::to_string(offset_m));
    EXPECT_LT(offset_m, limit_m) << seed;
  }
}

TEST_P(PadPositionFlightTest, ReportsParameterThatIsMissing) {
  AutopilotModelOptions options = Uav(5, 20);
  options.parameters.clear();
  PointedFlight flight = Flight(options);
  flight.Fly(15);
  EXPECT_THAT(flight.reported, HasSubstr(is_px4() ? "set EKF2_EV_CTRL" : "set VISO_TYPE"));
}

// The autopilot itself would go on for seconds, and drift.
TEST_P(PadPositionFlightTest, LandsWhereItIsWhenPadIsLost) {
  PointedFlight flight = Flight(Uav(4, 10));
  flight.Fly(12);
  ASSERT_TRUE(IsGuidedMode(is_px4() ? AutopilotKind::kPx4 : AutopilotKind::kArduPilot,
                           flight.model.custom_mode()))
      << flight.reported;
  const Eigen::Vector3d place = flight.model.truth().world_from_body.translation;
  flight.is_blind = true;
  flight.Fly(3);
  EXPECT_EQ(
      flight.model.custom_mode(),
      CustomModeOf(is_px4() ? AutopilotKind::kPx4 : AutopilotKind::kArduPilot, FlightMode::kLand))
      << flight.reported;
  EXPECT_TRUE(flight.Land(40)) << flight.reported;
  const Eigen::Vector3d moved = flight.model.truth().world_from_body.translation - place;
  EXPECT_LT(moved.head<2>().norm(), 1.5);
}

// --- Kestrel is gone ---

struct Aftermath {
  double mode_s = 0;      // until the autopilot has left the mode of set-points
  double drift_m = 0;     // until then
  double ground_s = 0;    // until contact
  double off_m = 0;       // how far away from where it was that is
  double impact_mps = 0;  // at contact, down
};

// Kestrel flies at about 3 m over the pad, in a wind of 3 m/s, and is gone.
class AbandonedPadFlightTest : public PadPositionFlightTest {
 protected:
  static AutopilotModelOptions InWind() {
    AutopilotModelOptions options = Uav(5, 10);
    options.uav.wind.min_mps = options.uav.wind.max_mps = 3;
    if (is_px4()) options.parameters += ",EKF2_NOAID_TOUT=1000000,COM_OBL_RC_ACT=4";
    return options;
  }
  static AutopilotKind Kind() { return is_px4() ? AutopilotKind::kPx4 : AutopilotKind::kArduPilot; }

  // Flies until guidance descends through 3 m.
  static void Descend(PointedFlight* flight) {
    constexpr double kHeight_m = 3;
    for (int i = 0; i < 400 && HeightOf(*flight) > kHeight_m; ++i) flight->Fly(0.1);
    ASSERT_LT(HeightOf(*flight), kHeight_m) << flight->reported;
    ASSERT_TRUE(IsGuidedMode(Kind(), flight->model.custom_mode())) << flight->reported;
  }
  static double HeightOf(const PointedFlight& flight) {
    return flight.model.truth().world_from_body.translation.z();
  }
  static Aftermath Watch(PointedFlight* flight) {
    constexpr double kStep_s = 0.02, kLongest_s = 40;
    Aftermath after;
    const Eigen::Vector3d place = flight->model.truth().world_from_body.translation;
    const auto off_m = [&] {
      return (flight->model.truth().world_from_body.translation - place).head<2>().norm();
    };
    for (double s = 0; s < kLongest_s && flight->model.is_armed(); s += kStep_s) {
      flight->Fly(kStep_s);
      if (IsGuidedMode(Kind(), flight->model.custom_mode())) {
        after.mode_s = s + kStep_s;
        after.drift_m = off_m();
      }
      const auto& contact = flight->model.result().contact;
      if (!contact || after.ground_s > 0) continue;
      after.ground_s = s;
      after.off_m = off_m();
      after.impact_mps = -contact->velocity_in_world.z();
    }
    EXPECT_FALSE(flight->model.is_armed()) << flight->reported;
    return after;
  }
  void Record(const Aftermath& after) {
    RecordProperty("mode_s", std::to_string(after.mode_s));
    RecordProperty("drift_m", std::to_string(after.drift_m));
    RecordProperty("ground_s", std::to_string(after.ground_s));
    RecordProperty("off_m", std::to_string(after.off_m));
    RecordProperty("impact_mps", std::to_string(after.impact_mps));
  }
};
INSTANTIATE_TEST_SUITE_P(Both, AbandonedPadFlightTest,
                         testing::Values(AutopilotFirmware::kArduPilot, AutopilotFirmware::kPx4));

TEST_P(AbandonedPadFlightTest, GuardLandsWhenKestrelIsKilled) {
  PointedFlight flight = Flight(InWind());
  Descend(&flight);
  flight.Kill();
  const Aftermath after = Watch(&flight);
  Record(after);
  EXPECT_THAT(flight.modes_by_guard(), testing::Each(FlightMode::kLand));
  EXPECT_EQ(flight.refusals, 0);
  EXPECT_LT(after.mode_s, 0.2);
  EXPECT_LT(after.impact_mps, 1);
  EXPECT_THAT(flight.reported, HasSubstr("Kestrel is gone, no position: LAND"));
}

TEST_P(AbandonedPadFlightTest, GuardLandsWhenKestrelHangs) {
  PointedFlight flight = Flight(InWind());
  Descend(&flight);
  flight.Hang();
  const Aftermath after = Watch(&flight);
  Record(after);
  EXPECT_THAT(flight.modes_by_guard(), testing::Each(FlightMode::kLand));
  EXPECT_EQ(flight.refusals, 0);
  EXPECT_LT(after.mode_s, 0.4);
  EXPECT_LT(after.drift_m, 0.5);
  EXPECT_LT(after.impact_mps, 1);
  EXPECT_THAT(flight.reported, HasSubstr("Kestrel hangs, no position: LAND"));
}

TEST_P(AbandonedPadFlightTest, GuardGivesUavToPilotWithSticks) {
  AutopilotModelOptions options = InWind();
  options.pilot.has_sticks = true;
  PointedFlight flight = Flight(options);
  Descend(&flight);
  flight.Kill();
  flight.Fly(2);
  EXPECT_EQ(flight.model.custom_mode(), CustomModeOf(Kind(), FlightMode::kAltitude));
  EXPECT_THAT(flight.reported, HasSubstr("fly by hand"));
  EXPECT_EQ(flight.refusals, 0);
}

TEST_P(AbandonedPadFlightTest, GuardLandsWhenKestrelIsKilledAfterPadWasLost) {
  PointedFlight flight = Flight(InWind());
  Descend(&flight);
  flight.is_blind = true;
  flight.Fly(0.9);
  flight.Kill();
  const Aftermath after = Watch(&flight);
  Record(after);
  EXPECT_EQ(flight.refusals, 0);
  EXPECT_LT(after.impact_mps, 1);
}

// The pilot flies along with a vehicle that stops and drives off again.
TEST_P(PadPositionFlightTest, NoticesPadThatDrivesOff) {
  AutopilotModelOptions options = Uav(5, -1);
  options.pilot.follows_vehicle = true;
  PointedFlight flight(GetParam(), options, TestVehicle("stops", 3),
                       {.has_gimbal = false, .sends_pad_position = true});
  flight.Fly(40);
  EXPECT_THAT(flight.reported, HasSubstr("the pad moves: it is no position any more"));
}

TEST_P(PadPositionFlightTest, PadThatStandsIsNotTakenToMoveInGusts) {
  AutopilotModelOptions options = Uav(4, -1);
  options.uav.wind.min_mps = options.uav.wind.max_mps = 6;
  PointedFlight flight = Flight(options);
  flight.Fly(120);
  EXPECT_THAT(flight.reported, Not(HasSubstr("the pad moves"))) << flight.reported;
}

}  // namespace
}  // namespace kestrel
