// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/simulation/recordings/simulated_landing.h"

#include <utility>

#include <fmt/format.h>

#include "kestrel/io/recording/euroc/euroc_layout.h"
#include "kestrel/simulation/labelled_images/landing_stills.h"
#include "kestrel/simulation/recordings/truth_text.h"
#include "kestrel/simulation/scene/solids.h"
#include "kestrel/simulation/vehicle/flight_time.h"

namespace kestrel {
namespace {

Drawing AirframeOf(const SurroundingsOptions& options, const CameraCalibration& camera,
                   bool is_fixed) {
  return options.landing_legs && is_fixed ? LandingLegs(camera.intrinsics, /*four=*/true)
                                          : Drawing();
}

World WithUav(World world, const SurroundingsOptions& options, const Motion& world_from_uav) {
  if (!options.uav_shadow) return world;
  constexpr double kSize_m = 0.8;  // from rotor to rotor
  world.bodies.push_back(world_from_uav);
  AddUavShadow(static_cast<int>(world.bodies.size()) - 1, kSize_m, &world);
  return world;
}

}  // namespace

SimulatedLanding::SimulatedLanding(const FlightRecordingOptions& options,
                                   const SurroundingsOptions& surroundings,
                                   const CameraCalibration& camera, LandingScene scene,
                                   const Motion& world_from_uav, std::uint64_t seed)
    : print_(std::move(scene.print)),
      drawn_(fmt::format("drawn_arm_half_length_m: {}\n", scene.pattern.arm_half_length_m)),
      world_from_pattern_(std::move(scene.world_from_pattern)),
      flight_(options, camera, AirframeOf(surroundings, camera, !options.gimbal.is_there()),
              WithUav(std::move(scene.world), surroundings, world_from_uav), world_from_uav,
              scene.target, seed) {}

std::string SimulatedLanding::SceneText(const std::string& kind, const std::string& options) const {
  return flight_.SceneText(kind) + drawn_ + "options:\n" + Indented(options);
}

std::vector<RecordingFile> SimulatedLanding::Files() const {
  std::string rows = LandingTruthHeader();
  for (const double time_s : flight_.times_s()) {
    const auto seen = SeenPattern(TimeOfFlight(time_s), time_s, *flight_.CameraAt(time_s), print_,
                                  world_from_pattern_);
    if (seen) rows += LandingTruthRow(*seen);
  }
  std::vector<RecordingFile> files = flight_.Files();
  files.push_back({euroc::kTruePatterns, rows});
  return files;
}

}  // namespace kestrel
