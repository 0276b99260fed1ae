// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/simulation/autopilots/camera_faults.h"

#include <array>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "kestrel/core/base/violations.h"

namespace kestrel {
namespace {

std::optional<CameraFault> FaultOf(const std::string& kind) {
  constexpr std::array<std::pair<const char*, CameraFault>, 7> kFaults = {
      {{"none", CameraFault::kNone},
       {"frozen", CameraFault::kFrozen},
       {"black", CameraFault::kBlack},
       {"bright", CameraFault::kBright},
       {"slow", CameraFault::kSlow},
       {"stopped", CameraFault::kStopped},
       {"beside", CameraFault::kBeside}}};
  for (const auto& [name, fault] : kFaults) {
    if (kind == name) return fault;
  }
  return std::nullopt;
}

}  // namespace

std::vector<std::string> CameraFaultOptions::Validate() const {
  constexpr double kLongest_s = 10000;
  std::vector<std::string> violations;
  if (!FaultOf(kind)) {
    violations.push_back(fmt::format(
        "kind is '{}', expected none, frozen, black, bright, slow, stopped or beside", kind));
  }
  RequireIn(after_s, 0, kLongest_s, "after_s", &violations);
  RequireIn(for_s, 0, kLongest_s, "for_s", &violations);
  return violations;
}

CameraFault CameraFaultOptions::At(double since_start_s) const {
  if (since_start_s < after_s || since_start_s >= after_s + for_s) return CameraFault::kNone;
  return FaultOf(kind).value_or(CameraFault::kNone);
}

}  // namespace kestrel
