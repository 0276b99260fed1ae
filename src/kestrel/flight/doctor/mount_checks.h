// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "kestrel/flight/doctor/finding.h"
#include "kestrel/flight/doctor/observations.h"

namespace kestrel {

// Checks of how the camera is mounted.

// Whether it is told at all, and the camera looks down by it.
Finding CheckMountGiven(const std::optional<RigidTransform>& body_from_camera);

// Whether the pattern lies level by mount and attitude, as on a level deck.
Finding CheckMountByGravity(const std::optional<RigidTransform>& body_from_camera,
                            const VisionObservations& vision);

// Whether the pattern stays where it is (or drives straight on, where 'target_moves') while the UAV
// moves or tilts: the same for the mount turned by quarters of a turn in all ways, of which the
// right one keeps it in place best.
Finding CheckMountByMotion(const std::optional<RigidTransform>& body_from_camera,
                           const VisionObservations& vision, bool target_moves);

std::vector<Finding> CheckMount(const DoctorObservations& observations);

}  // namespace kestrel
