// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

namespace kestrel {

// Solves h x = b for every column of 'b' by elimination without pivoting. 'h' must be symmetric and
// positive definite; only its diagonal and what lies below are read. Where it is not positive
// definite, the solution is huge or not finite. For the few unknowns of a pose this is several
// times as fast as Eigen's decompositions, which are made for large matrices.
template <int kSize, int kSides>
Eigen::Matrix<double, kSize, kSides> SolvePositive(Eigen::Matrix<double, kSize, kSize> h,
                                                   Eigen::Matrix<double, kSize, kSides> b) {
  for (int k = 0; k < kSize; ++k) {
    const double inverse = 1 / h(k, k);
    for (int j = k + 1; j < kSize; ++j) {
      const double share = inverse * h(j, k);
      for (int i = j; i < kSize; ++i) h(i, j) -= share * h(i, k);
      for (int side = 0; side < kSides; ++side) b(j, side) -= share * b(k, side);
    }
  }
  for (int k = kSize - 1; k >= 0; --k) {
    const double inverse = 1 / h(k, k);
    for (int side = 0; side < kSides; ++side) {
      double sum = b(k, side);
      for (int i = k + 1; i < kSize; ++i) sum -= h(i, k) * b(i, side);
      b(k, side) = inverse * sum;
    }
  }
  return b;
}

}  // namespace kestrel
