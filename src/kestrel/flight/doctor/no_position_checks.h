// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "kestrel/flight/doctor/parameter_rules.h"

namespace kestrel {

// Check the parameters on which a flight without any position depends, see docs/indoors.md.
void CheckNoPositionOfArduPilot(ParameterRules* rules);
// The same for a landing by position that goes on without.
void CheckReserveOfArduPilot(ParameterRules* rules);
void CheckNoPositionOfPx4(ParameterRules* rules);

}  // namespace kestrel
