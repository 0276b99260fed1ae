// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/fly/fly_autopilot.h"

#include <cstdint>
#include <optional>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "kestrel/comms/mavlink/socket_address.h"
#include "kestrel/core/base/error.h"

namespace kestrel {
namespace {

constexpr std::string_view kSimulated = "sim:";
constexpr std::string_view kSimulatedArduPilot = "sim:ardupilot";
constexpr std::string_view kSimulatedPx4 = "sim:px4";
constexpr char kLoopback[] = "127.0.0.1";

// The pilot changes the mode at the time of landing.
void PrepareGuidance(std::string_view name, SimulatedAutopilotOptions* options) {
  PilotOptions& pilot = options->model.pilot;
  if (pilot.guide_after_s < 0) pilot.guide_after_s = std::exchange(pilot.land_after_s, -1);
  std::string& parameters = options->model.parameters;
  if (name == kSimulatedPx4 && parameters.empty()) parameters = "LNDMC_XY_VEL_MAX=12";
}

// The pilot keeps the UAV where its camera sees the thing to follow, unless the user set the place,
// or a part of it.
void PrepareFollow(PilotOptions* pilot) {
  const PilotOptions usual;
  const auto replace = [&](double PilotOptions::*value, double by) {
    if (pilot->*value == usual.*value) pilot->*value = by;
  };
  replace(&PilotOptions::offset_east_m, 0);
  replace(&PilotOptions::offset_north_m, -12);
  replace(&PilotOptions::heading_deg, 0);
  replace(&PilotOptions::start_altitude_m, 8);
}

// The pilot begins above the middle of the field.
void PrepareHunt(PilotOptions* pilot) {
  const PilotOptions usual;
  if (pilot->start_altitude_m == usual.start_altitude_m) pilot->start_altitude_m = 6;
}

}  // namespace

FlyAutopilot MakeFlyAutopilot(const std::string& name, const FlyOptions& options, bool guides,
                              FlySource* source) {
  const bool has_gimbal = source->simulated.has_gimbal();
  if (!name.starts_with(kSimulated)) {
    if (!has_gimbal || name.empty()) return {name, nullptr};
    throw InputError(fmt::format(
        "autopilot {}: expected {} or {}: a sim: camera on a gimbal needs one that knows its "
        "attitude",
        name, kSimulatedArduPilot, kSimulatedPx4));
  }
  if (name != kSimulatedArduPilot && name != kSimulatedPx4) {
    throw InputError(
        fmt::format("autopilot {}: expected {} or {}", name, kSimulatedArduPilot, kSimulatedPx4));
  }
  SimulatedAutopilotOptions simulated = options.sim_autopilot;
  simulated.firmware = name.substr(kSimulated.size());
  simulated.signing_key = options.link.signing_key;
  simulated.model.has_gimbal = has_gimbal;
  simulated.model.zoom = source->simulated.zoom();
  simulated.model.zoomed_lens = source->simulated.lens();
  if (guides) PrepareGuidance(name, &simulated);
  if (source->simulated.World()->options().thing.is_there()) PrepareFollow(&simulated.model.pilot);
  if (source->simulated.World()->options().field.is_there()) {
    PrepareHunt(&simulated.model.pilot);
  }
  const auto seed = static_cast<std::uint64_t>(options.sim_seed);
  const int port = FreeLoopbackPort();
  auto uav = std::make_unique<SimulatedAutopilot>(
      simulated, fmt::format("udpout://{}:{}", kLoopback, port), source->simulated.World(), seed);
  source->live.true_offset_m = [uav = uav.get()]() -> std::optional<double> {
    const SitlResult result = uav->result();
    return result.contact ? std::optional(result.offset_m()) : std::nullopt;
  };
  return {fmt::format("udpin://{}:{}", kLoopback, port), std::move(uav)};
}

SessionOptions SessionOptionsFor(const FlyAutopilot& autopilot, const FlyOptions& options,
                                 bool guides) {
  SessionOptions session{.flight = options, .autopilot = autopilot.url, .guides = guides};
  // A simulated autopilot ends with this process.
  if (autopilot.simulated) session.flight.guard.enabled = false;
  return session;
}

}  // namespace kestrel
