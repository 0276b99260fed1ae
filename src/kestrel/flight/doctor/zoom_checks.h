// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "kestrel/flight/doctor/finding.h"
#include "kestrel/flight/doctor/observations.h"

namespace kestrel {

// Checks that a camera that zooms reports its field of view often enough, and that its file has a
// lens for it.
Finding CheckZoom(const DoctorObservations& observations);

}  // namespace kestrel
