// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/options/fly_options.h"

#include "kestrel/core/base/violations.h"

namespace kestrel {

std::vector<std::string> FlyOptions::Validate() const {
  std::vector<std::string> violations = flight.Validate();
  AddViolations("camera", camera.Validate(), &violations);
  AddViolations("exposure", exposure.Validate(), &violations);
  AddViolations("link", link.Validate(), &violations);
  AddViolations("autopilot", autopilot.Validate(), &violations);
  AddViolations("recorder", recorder.Validate(), &violations);
  AddViolations("sim_camera", sim_camera.Validate(), &violations);
  AddViolations("sim_autopilot", sim_autopilot.Validate(), &violations);
  return violations;
}

}  // namespace kestrel
