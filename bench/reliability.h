// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

namespace kestrel {

// Compares probabilities with the shares of them that were right, by ten classes of probability.
class Reliability {
 public:
  void Add(double probability, bool is_right) {
    const int i = std::clamp(static_cast<int>(10 * probability), 0, 9);
    excess_[i] += probability - is_right;
    ++count_;
  }
  double count() const { return count_; }
  // Mean difference between a probability and the share of its class that was right.
  double ExpectedError() const {
    double sum = 0;
    for (const double excess : excess_) sum += std::abs(excess);
    return sum / std::max(1.0, count_);
  }

 private:
  std::array<double, 10> excess_{};
  double count_ = 0;
};

}  // namespace kestrel
