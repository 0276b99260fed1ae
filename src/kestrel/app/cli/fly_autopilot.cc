// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/cli/fly_autopilot.h"

#include <cstdint>
#include <string_view>

#include <fmt/format.h>

#include "kestrel/comms/mavlink/socket_address.h"

namespace kestrel {
namespace {

constexpr std::string_view kSimulatedArduPilot = "sim:ardupilot";
constexpr std::string_view kSimulatedPx4 = "sim:px4";
constexpr char kLoopback[] = "127.0.0.1";

}  // namespace

FlyAutopilot MakeFlyAutopilot(const std::string& argument, const FlyOptions& options,
                              SimulatedSource* source) {
  if (argument != kSimulatedArduPilot && argument != kSimulatedPx4) return {argument, nullptr};
  SimulatedAutopilotOptions simulated = options.sim_autopilot;
  simulated.firmware = argument.substr(std::string_view("sim:").size());
  simulated.signing_key = options.link.signing_key;
  const auto seed = static_cast<std::uint64_t>(options.sim_seed);
  const int port = FreeLoopbackPort();
  return {fmt::format("udpin://{}:{}", kLoopback, port),
          std::make_unique<SimulatedAutopilot>(
              simulated, fmt::format("udpout://{}:{}", kLoopback, port), source->World(), seed)};
}

}  // namespace kestrel
