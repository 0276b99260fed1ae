// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/simulation/vehicle/wind.h"

#include <cmath>
#include <numbers>

#include "kestrel/core/base/limits.h"

namespace kestrel {

std::vector<std::string> WindOptions::Validate() const {
  std::vector<std::string> violations;
  Require(max_mps, Range{min_mps, 30}, "max_mps", &violations);
  return violations;
}

Path MakeWind(const WindOptions& options, Random* random) {
  const double speed = random->Uniform(options.min_mps, options.max_mps);
  const double direction = random->Uniform(0, 2 * std::numbers::pi);
  const Eigen::Vector3d steady(speed * std::cos(direction), speed * std::sin(direction), 0);
  const double gust = options.gusts * speed;
  const auto x = Wander(gust, options.gust_period_s, random);
  const auto y = Wander(gust, options.gust_period_s, random);
  const auto z = Wander(0.5 * gust, options.gust_period_s, random);
  return [=](double time_s) {
    return Eigen::Vector3d(steady + Eigen::Vector3d(x(time_s), y(time_s), z(time_s)));
  };
}

}  // namespace kestrel
