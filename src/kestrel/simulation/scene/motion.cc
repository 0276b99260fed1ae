// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/simulation/scene/motion.h"

#include <array>
#include <cmath>

#include "kestrel/core/geometry/angles.h"

namespace kestrel {

Eigen::Vector3d VelocityOf(const Motion& world_from_body, double time_s) {
  constexpr double kStep_s = 1e-3;
  return (world_from_body(time_s + kStep_s).translation -
          world_from_body(time_s - kStep_s).translation) /
         (2 * kStep_s);
}

std::function<double(double)> Wander(double sigma, double period_s, Random* random) {
  constexpr int kSines = 4;
  std::array<double, kSines> rates{};
  std::array<double, kSines> phases{};
  for (int i = 0; i < kSines; ++i) {
    rates[i] = 2 * kPi / (period_s * random->Uniform(0.6, 1.6));
    phases[i] = random->Uniform(0, 2 * kPi);
  }
  const double amplitude = sigma * std::sqrt(2.0 / kSines);
  return [=](double time_s) {
    double sum = 0;
    for (int i = 0; i < kSines; ++i) sum += std::sin(rates[i] * time_s + phases[i]);
    return amplitude * sum;
  };
}

}  // namespace kestrel
