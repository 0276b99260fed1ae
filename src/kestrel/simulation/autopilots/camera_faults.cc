// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/simulation/autopilots/camera_faults.h"

#include <array>
#include <optional>
#include <utility>

namespace kestrel {
namespace {

std::optional<CameraFault> FaultOf(const std::string& kind) {
  constexpr std::array<std::pair<const char*, CameraFault>, 9> kFaults = {
      {{"none", CameraFault::kNone},
       {"frozen", CameraFault::kFrozen},
       {"black", CameraFault::kBlack},
       {"bright", CameraFault::kBright},
       {"slow", CameraFault::kSlow},
       {"stopped", CameraFault::kStopped},
       {"beside", CameraFault::kBeside},
       {"late", CameraFault::kLate},
       {"turned", CameraFault::kTurned}}};
  for (const auto& [name, fault] : kFaults) {
    if (kind == name) return fault;
  }
  return std::nullopt;
}

}  // namespace

CameraFault CameraFaultOptions::At(double since_start_s) const {
  if (since_start_s < after_s || since_start_s >= after_s + for_s) return CameraFault::kNone;
  return FaultOf(kind).value_or(CameraFault::kNone);
}

}  // namespace kestrel
