// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>

namespace kestrel {

// How much the residuals of neighbours have in common (pixels, dirt, light, blur that is not as
// modelled), which does not average out: they are taken for a first-order autoregressive process.
class NeighborCorrelation {
 public:
  // Two neighbours.
  void Add(double a, double b) {
    products_ += a * b;
    squares_ += 0.5 * (a * a + b * b);
  }

  // How many residuals count as one: (1 + r) / (1 - r) with their correlation r, 0 to 'most'.
  double Redundancy(double most) const {
    const double r = std::clamp(products_ / std::max(squares_, 1e-12), 0.0, most);
    return (1 + r) / (1 - r);
  }

 private:
  double products_ = 0;
  double squares_ = 0;
};

}  // namespace kestrel
