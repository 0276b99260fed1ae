// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <limits>

namespace kestrel {

// Correlation of the residuals of neighbours. They share pixels, dirt, light and an imperfect blur
// model, and such errors do not average out. Model: a first-order autoregressive process.
class NeighborCorrelation {
 public:
  // Adds two neighbouring residuals.
  void Add(double a, double b) {
    products_ += a * b;
    squares_ += 0.5 * (a * a + b * b);
  }

  // Returns how many residuals count as one: (1 + r) / (1 - r) with their correlation r, clamped to
  // 0 to 'most'.
  double Redundancy(double most) const {
    const double r =
        std::clamp(products_ / std::max(squares_, std::numeric_limits<double>::min()), 0.0, most);
    return (1 + r) / (1 - r);
  }

 private:
  double products_ = 0;
  double squares_ = 0;
};

}  // namespace kestrel
