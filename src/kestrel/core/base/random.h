// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>

namespace kestrel {

// Random numbers that are the same with every standard library. Only the engine is the standard's,
// because its sequence is specified; that of the standard distributions is not.
class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}

  // Returns 64 random bits, suitable as the seed of another Random.
  std::uint64_t Bits() { return engine_(); }

  // Uniform in [0, 1).
  double Uniform() { return static_cast<double>(engine_() >> 11) * 0x1p-53; }

  // Uniform in [low, high); 'low' when they are equal.
  double Uniform(double low, double high) { return low + (high - low) * Uniform(); }

  // Uniform over the integers low ... high, both included; low <= high.
  int Integer(int low, int high) {
    const double count = static_cast<double>(high) - low + 1;
    return static_cast<int>(low + std::floor(count * Uniform()));
  }

  // True with 'probability', 0 to 1.
  bool Chance(double probability) { return Uniform() < probability; }

  // Standard normal (Box and Muller, both values of a pair are used).
  double Normal() {
    if (has_spare_) {
      has_spare_ = false;
      return spare_;
    }
    const double radius = std::sqrt(-2 * std::log(1 - Uniform()));
    const double angle = 2 * std::numbers::pi * Uniform();
    spare_ = radius * std::sin(angle);
    has_spare_ = true;
    return radius * std::cos(angle);
  }

 private:
  std::mt19937_64 engine_;
  double spare_ = 0;
  bool has_spare_ = false;
};

}  // namespace kestrel
