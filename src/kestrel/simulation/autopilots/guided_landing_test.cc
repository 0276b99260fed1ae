// SPDX-License-Identifier: BSD-3-Clause
// Guidance lands simulated autopilots on decks that carry them, and they disarm there by
// themselves. It knows the truth of the deck, and of the UAV what its autopilot estimates.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>
#include <variant>

#include <gtest/gtest.h>

#include "kestrel/comms/mavlink/autopilot_kind.h"
#include "kestrel/comms/mavlink/mavlink_enums.h"
#include "kestrel/comms/mavlink/ned.h"
#include "kestrel/comms/mavlink/set_point_message.h"
#include "kestrel/core/geometry/angles.h"
#include "kestrel/flight/guidance/landing_guidance.h"
#include "kestrel/simulation/autopilots/test_autopilot.h"
#include "kestrel/simulation/autopilots/test_guidance.h"

namespace kestrel {
namespace {

using Eigen::Vector3d;

struct Deck {
  const char* path;
  double speed_mps;
};

AutopilotModelOptions ModelFor(AutopilotFirmware firmware, double guide_after_s) {
  AutopilotModelOptions options;
  options.pilot.guide_after_s = guide_after_s;
  // The detector of PX4 as it comes does not land on what is faster.
  if (firmware == AutopilotFirmware::kPx4) options.parameters = "LNDMC_XY_VEL_MAX=12";
  return options;
}

GuidanceOptions GuidanceTo(AutopilotFirmware firmware, const char* touchdown_heading) {
  GuidanceOptions options = GuidanceFor(firmware);
  options.touchdown_heading = touchdown_heading;
  return options;
}

class GuidedLanding : public TestAutopilot {
 public:
  GuidedLanding(AutopilotFirmware firmware, const AutopilotModelOptions& options, const Deck& deck,
                std::uint64_t seed, bool sends_carried, const char* touchdown_heading = "any")
      : TestAutopilot(firmware, options, TestVehicle(deck.path, deck.speed_mps), seed),
        kind_(firmware == AutopilotFirmware::kPx4 ? AutopilotKind::kPx4
                                                  : AutopilotKind::kArduPilot),
        sends_carried_(sends_carried && firmware == AutopilotFirmware::kArduPilot),
        guidance_(GuidanceTo(firmware, touchdown_heading)) {
    for (const std::uint32_t id :
         {mavlink::Attitude::kId, mavlink::AttitudeQuaternion::kId, mavlink::LocalPositionNed::kId,
          mavlink::ExtendedSysState::kId}) {
      constexpr float kEach_us = 20000;
      Command(mavlink::kCommandSetMessageInterval, static_cast<float>(id), kEach_us);
    }
  }

  // Flies until it has disarmed; false when that takes longer.
  bool Land(double longest_s) {
    Run(longest_s, [this] {
      if (model.is_armed()) Guide();
    });
    return !model.is_armed();
  }
  int go_arounds() const { return guidance_.go_arounds(); }

 private:
  void Guide() {
    TakeReports();
    const GuidanceOutput output = guidance_.Update(Input());
    if (output.request == GuidanceRequest::kLand) {
      Command(mavlink::kCommandDoSetMode, 1,
              static_cast<float>(CustomModeOf(kind_, FlightMode::kLand)));
    }
    if (!output.set_point) return;
    if (output.set_point->is_carried && sends_carried_) {
      Send(CarriedMessage(*output.set_point, 1, 1, 0));
    } else {
      Send(SetPointMessage(*output.set_point, kind_, 1, 1, 0));
    }
  }

  void TakeReports() {
    for (const AutopilotMessage& message : sent) {
      if (const auto* place = std::get_if<mavlink::LocalPositionNed>(&message)) {
        uav_.world_from_body.translation = EnuFromNed({place->x, place->y, place->z});
        uav_.velocity_in_world = EnuFromNed({place->vx, place->vy, place->vz});
      } else if (const auto* state = std::get_if<mavlink::ExtendedSysState>(&message)) {
        is_landed_ = state->landed_state == mavlink::kLandedOnGround;
      }
    }
    sent.clear();
    uav_.world_from_body.rotation = model.truth().world_from_body.rotation;
  }

  GuidanceInput Input() const {
    GuidanceInput input;
    input.now = now;
    input.uav = uav_;
    input.target = TrueTarget(world, now);
    input.target_age_s = 0.05;
    input.is_guided = IsGuidedMode(kind_, model.custom_mode());
    input.is_armed = true;
    input.is_landed = is_landed_;
    return input;
  }

  void Command(std::uint16_t command, float p1, float p2) {
    mavlink::CommandLong message;
    message.target_system = 1;
    message.command = command;
    message.param1 = p1;
    message.param2 = p2;
    Send(message);
  }

  AutopilotKind kind_;
  bool sends_carried_;
  LandingGuidance guidance_;
  UavState uav_;
  bool is_landed_ = false;
};

struct Circumstances {
  double rest_climb_mps = 0;
  bool sends_carried = true;  // false: in contact it sends the deck's velocity
};

struct Disarmed {
  int flights = 0;
  double longest_s = 0;  // from contact
  int go_arounds = 0;
};

// Flies 20 times, each from another place of the path and in another wind.
Disarmed Fly(AutopilotFirmware firmware, const Deck& deck,
             const Circumstances& circumstances = {}) {
  Disarmed disarmed;
  for (int seed = 1; seed <= 20; ++seed) {
    AutopilotModelOptions options = ModelFor(firmware, 1 + 0.9 * seed);
    options.estimate.rest_climb_mps = circumstances.rest_climb_mps;
    GuidedLanding landing(firmware, options, deck, seed, circumstances.sends_carried);
    const bool is_down = landing.Land(90);
    disarmed.go_arounds += landing.go_arounds();
    const SitlResult& result = landing.model.result();
    if (!is_down || !result.contact || !result.contact->on_board) continue;
    ++disarmed.flights;
    disarmed.longest_s = std::max(disarmed.longest_s, result.disarm_s);
  }
  return disarmed;
}

class GuidedLandingTest : public testing::TestWithParam<AutopilotFirmware> {};
INSTANTIATE_TEST_SUITE_P(Both, GuidedLandingTest,
                         testing::Values(AutopilotFirmware::kArduPilot, AutopilotFirmware::kPx4));

// On the eight ArduPilot's detector has to wait for its straight part, where the deck itself
// accelerates less than it allows.
TEST_P(GuidedLandingTest, DisarmsOnEveryDeckByItself) {
  for (const auto& [deck, longest_s] :
       {std::pair(Deck{"standing", 0}, 7.0), std::pair(Deck{"straight", 4.2}, 7.0),
        std::pair(Deck{"figure8", 4.2}, 20.0)}) {
    const Disarmed disarmed = Fly(GetParam(), deck);
    EXPECT_EQ(disarmed.flights, 20) << deck.path;
    EXPECT_LT(disarmed.longest_s, longest_s) << deck.path;
  }
}

// ArduPilot leans against the deck by velocities until its detector refuses.
TEST(ArduPilotGuidedLandingTest, VelocitiesAgainstDrivingDeckKeepArduPilotArmed) {
  const Deck deck{"figure8", 4.2};
  EXPECT_LT(Fly(AutopilotFirmware::kArduPilot, deck, {.sends_carried = false}).flights, 10);
}

TEST_P(GuidedLandingTest, StaysDownWhenEstimateClimbsAtRest) {
  const Deck deck{"figure8", 4.2};
  const int go_arounds = Fly(GetParam(), deck).go_arounds;
  for (const double error_mps : {-0.12, 0.12}) {
    const Disarmed disarmed = Fly(GetParam(), deck, {.rest_climb_mps = error_mps});
    EXPECT_EQ(disarmed.flights, 20) << error_mps;
    EXPECT_EQ(disarmed.go_arounds, go_arounds) << error_mps;
  }
}

// From every heading of the pilot to one over a pad that turns with the car on the eight.
TEST_P(GuidedLandingTest, LandsWithRequestedHeading) {
  constexpr double kWanted_deg = 120, kMostOff_deg = 2;
  for (int seed = 1; seed <= 8; ++seed) {
    GuidedLanding landing(GetParam(), ModelFor(GetParam(), 1 + 0.9 * seed), Deck{"figure8", 4.2},
                          seed, /*says_carried=*/true, "120");
    EXPECT_TRUE(landing.Land(90)) << seed;
    const auto& contact = landing.model.result().contact;
    ASSERT_TRUE(contact && contact->on_board) << seed;
    const double error = contact->heading_in_pattern - Radians(kWanted_deg);
    EXPECT_LT(std::abs(Degrees(std::remainder(error, kFullTurn))), kMostOff_deg) << seed;
    EXPECT_LT(contact->feet_in_pattern.head<2>().norm(), 0.4) << seed;
  }
}

}  // namespace
}  // namespace kestrel
