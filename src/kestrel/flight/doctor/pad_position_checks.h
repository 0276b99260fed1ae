// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "kestrel/flight/doctor/parameter_rules.h"

namespace kestrel {

// Check the parameters by which an autopilot uses the pad as its position, see docs/indoors.md.
void CheckPadPositionOfArduPilot(ParameterRules* rules);
void CheckPadPositionOfPx4(ParameterRules* rules);

}  // namespace kestrel
