// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "kestrel/flight/doctor/finding.h"
#include "kestrel/flight/doctor/observations.h"

namespace kestrel {

// Checks of the camera's mount.

// A mount that moves is not judged: the checks below hold for a camera that is fixed to the body.
Finding CheckGimbalMount();

// Checks that the mount is given, and that by it the camera looks down.
Finding CheckMountGiven(const std::optional<RigidTransform>& body_from_camera);

// Checks that, by mount and attitude, the pattern lies level, as on a level deck.
Finding CheckMountByGravity(const std::optional<RigidTransform>& body_from_camera,
                            const VisionObservations& vision);

// Checks that, by the mount, the pattern stays where it is (or drives straight on, where
// 'target_moves') while the UAV moves or tilts. The mount is compared with all mounts turned by
// quarter turns: the right one keeps the pattern in place best.
Finding CheckMountByMotion(const std::optional<RigidTransform>& body_from_camera,
                           const VisionObservations& vision, bool target_moves);

std::vector<Finding> CheckMount(const DoctorObservations& observations);

}  // namespace kestrel
