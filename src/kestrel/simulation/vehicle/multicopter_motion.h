// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>

#include <Eigen/Geometry>

#include "kestrel/core/base/random.h"
#include "kestrel/simulation/scene/motion.h"

namespace kestrel {

// Returns the attitude (world_from_body) of a multicopter whose thrust, as an acceleration in the
// world, is along its z axis. y is across the heading 'yaw' (rad). x points along it where the lean
// is to one side only, and else aside from it by about the product of both leans (rad).
Eigen::Quaterniond MulticopterAttitude(const Eigen::Vector3d& thrust, double yaw);

// Returns the motion of a multicopter's body (x forward, y left, z up) that follows 'position': its
// thrust, along z, balances acceleration and gravity. 'yaw' is the heading of x, rad.
Motion MulticopterMotion(const Path& position, const std::function<double(double time_s)>& yaw,
                         double attitude_noise_deg, Random* random);

}  // namespace kestrel
