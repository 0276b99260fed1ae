// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>

#include <Eigen/Core>

#include "kestrel/core/base/random.h"
#include "kestrel/core/geometry/rigid_transform.h"

namespace kestrel {

// Pose of a body in the world as a function of time (s); smooth, thread-safe.
using Motion = std::function<RigidTransform(double time_s)>;

// Position (m) as a function of time (s), twice differentiable.
using Path = std::function<Eigen::Vector3d(double time_s)>;

// Velocity (m/s) of a body's origin in the world.
Eigen::Vector3d VelocityOf(const Motion& world_from_body, double time_s);

// A smooth random function of time: sines with random phases and with periods around 'period_s';
// mean 0, standard deviation 'sigma'.
std::function<double(double time_s)> Wander(double sigma, double period_s, Random* random);

}  // namespace kestrel
