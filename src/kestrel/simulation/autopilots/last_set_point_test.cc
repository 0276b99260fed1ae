// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "kestrel/comms/mavlink/set_point_message.h"
#include "kestrel/core/base/random.h"
#include "kestrel/flight/guidance/landing_guidance.h"
#include "kestrel/simulation/autopilots/test_autopilot.h"
#include "kestrel/simulation/autopilots/test_guidance.h"

namespace kestrel {
namespace {

using Eigen::Vector3d;

// Form of the set-points for PX4.
enum class Form { kVelocity, kPlace };

struct FlightCase {
  AutopilotFirmware firmware;
  std::string path;
  double speed_mps;
  Form form;
};

AutopilotModelOptions InWind() {
  AutopilotModelOptions options;
  options.pilot.guide_after_s = 1;
  return options;
}

GuidanceOptions GuidanceOf(const FlightCase& flight) {
  GuidanceOptions options = GuidanceFor(flight.firmware);
  if (flight.firmware == AutopilotFirmware::kPx4 && flight.form == Form::kPlace) {
    options.stale.position_gain = 0.95;
    options.stale.height_gain = 1;
  }
  return options;
}

// Guidance flies a simulated autopilot.
class TrackedFlight {
 public:
  TrackedFlight(const FlightCase& landing, std::uint64_t seed)
      : autopilot_(landing.firmware, InWind(), TestVehicle(landing.path, landing.speed_mps), seed),
        kind_(landing.firmware == AutopilotFirmware::kPx4 ? AutopilotKind::kPx4
                                                          : AutopilotKind::kArduPilot),
        guidance_(GuidanceOf(landing)),
        random_(seed) {}

  // Flies on until 'until' is true; false when that takes too long.
  template <class Until>
  bool FlyUntil(double longest_s, const Until& until) {
    bool is_done = false;
    for (double passed_s = 0; passed_s < longest_s && !is_done; passed_s += 0.02) {
      autopilot_.Run(0.02, [&] { Step(); });
      is_done = until();
    }
    return is_done;
  }

  // Sends nothing more. Returns the way to the farthest place, the lowest height above the deck's,
  // and whether the UAV came down.
  struct Stop {
    double farthest_m = 0, lowest_m = 1e9;
    bool is_down = false;
  };
  Stop FallSilent(double seconds) {
    Stop stop;
    const Vector3d where = Position();
    const double deck_m = where.z() - kLeg_m - Height();
    autopilot_.Run(seconds, [&] {
      stop.farthest_m = std::max(stop.farthest_m, (Position() - where).head<2>().norm());
      stop.lowest_m = std::min(stop.lowest_m, Position().z() - kLeg_m - deck_m);
    });
    stop.is_down = autopilot_.model.result().contact.has_value();
    return stop;
  }

  // Height of the feet above the deck, m.
  double Height() const {
    return Position().z() - kLeg_m - autopilot_.world.PatternAt(autopilot_.now).translation.z();
  }
  std::optional<double> Offset() const {
    const SitlResult& result = autopilot_.model.result();
    return result.contact ? std::optional(result.offset_m()) : std::nullopt;
  }
  GuidancePhase phase() const { return guidance_.phase(); }

 private:
  static constexpr double kLeg_m = 0.35;

  Vector3d Position() const { return autopilot_.model.truth().world_from_body.translation; }

  // A track with the errors of a good camera.
  TargetEstimate Target() {
    TargetEstimate target = TrueTarget(autopilot_.world, autopilot_.now);
    for (int axis = 0; axis < 3; ++axis) target.motion.mean(axis) += 0.02 * random_.Normal();
    for (int axis = 3; axis < 5; ++axis) target.motion.mean(axis) += 0.05 * random_.Normal();
    return target;
  }

  void Step() {
    GuidanceInput input;
    input.now = autopilot_.now;
    const PoseSample& truth = autopilot_.model.truth();
    input.uav = UavState{truth.world_from_body, truth.motion->velocity_in_world, std::nullopt};
    input.target = Target();
    input.target_age_s = 0.05;
    input.is_guided = IsGuidedMode(kind_, autopilot_.model.custom_mode());
    input.is_armed = autopilot_.model.is_armed();
    const GuidanceOutput output = guidance_.Update(input);
    if (output.set_point) autopilot_.Send(SetPointMessage(*output.set_point, kind_, 1, 1, 0));
  }

  TestAutopilot autopilot_;
  AutopilotKind kind_;
  LandingGuidance guidance_;
  Random random_;
};

double MedianOf(std::vector<double> values) {
  std::ranges::sort(values);
  return values[values.size() / 2];
}

// Offsets at contact, m.
std::vector<double> Land(const FlightCase& landing, int seeds) {
  std::vector<double> offsets;
  for (int seed = 1; seed <= seeds; ++seed) {
    TrackedFlight flight(landing, seed);
    flight.FlyUntil(60, [&] { return flight.Offset().has_value(); });
    if (flight.Offset()) offsets.push_back(*flight.Offset());
  }
  return offsets;
}

TEST(LastSetPointTest, PlacesLandPx4AsWellAsVelocities) {
  const auto px4 = AutopilotFirmware::kPx4;
  for (const double speed_mps : {0.0, 4.17}) {
    const std::string path = speed_mps > 0 ? "figure8" : "standing";
    const auto by_velocity = Land({px4, path, speed_mps, Form::kVelocity}, 20);
    const auto by_place = Land({px4, path, speed_mps, Form::kPlace}, 20);
    ASSERT_EQ(by_velocity.size(), 20u);
    ASSERT_EQ(by_place.size(), 20u);
    RecordProperty(path, fmt::format("{:.3f} {:.3f}", MedianOf(by_velocity), MedianOf(by_place)));
    EXPECT_LT(MedianOf(by_place), 1.2 * MedianOf(by_velocity) + 0.02) << path;
  }
}

// The computer dies while the UAV descends on a deck that drives: it stops in the air, on both.
TEST(LastSetPointTest, LastSetPointIsHarmless) {
  std::string figures;
  for (const auto firmware : {AutopilotFirmware::kArduPilot, AutopilotFirmware::kPx4}) {
    for (const double height_m : {2.0, 1.0, 0.6}) {
      double farthest_m = 0, lowest_m = 1e9;
      for (int seed = 1; seed <= 5; ++seed) {
        TrackedFlight flight({firmware, "figure8", 4.17, Form::kPlace}, seed);
        ASSERT_TRUE(flight.FlyUntil(60, [&] {
          return flight.phase() == GuidancePhase::kDescend && flight.Height() < height_m;
        }));
        const auto stop = flight.FallSilent(8);
        EXPECT_FALSE(stop.is_down);
        farthest_m = std::max(farthest_m, stop.farthest_m);
        lowest_m = std::min(lowest_m, stop.lowest_m);
      }
      figures += fmt::format("{} {:g} m: farthest {:.1f}, lowest {:.2f}; ",
                             firmware == AutopilotFirmware::kPx4 ? "PX4" : "ArduPilot", height_m,
                             farthest_m, lowest_m);
      EXPECT_LT(farthest_m, 10);
      EXPECT_GT(lowest_m, 0.18 * height_m) << "above the deck's height";
    }
  }
  RecordProperty("figures", figures);
}

}  // namespace
}  // namespace kestrel
