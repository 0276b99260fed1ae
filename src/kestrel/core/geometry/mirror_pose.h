// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "kestrel/core/geometry/rigid_transform.h"

namespace kestrel {

// Returns the pose with which a far plane looks nearly the same: its normal, z, is mirrored at the
// line of sight.
RigidTransform MirrorPose(const RigidTransform& camera_from_plane);

}  // namespace kestrel
