// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include <Eigen/Core>

#include "kestrel/vision/landing/landing_pattern_detector.h"

namespace kestrel {

// What is told of a view of the pattern, by the navigation or by the user.
struct ToldView {
  std::optional<double> altitude_m;             // of the camera above the pattern
  std::optional<Eigen::Vector3d> up_in_camera;  // unit vector away from the ground
};

// By how much what is told contradicts what is seen.
struct Contradiction {
  double difference;       // median over the detections
  double sigma;            // standard deviation of that
  std::size_t detections;  // how many it is the median of
};

// Compares what is told of the pattern with what its latest detections show. Both poses of a
// detection count: what agrees with one of them is no contradiction.
class ToldContradictions {
 public:
  void Add(const ToldView& told, const LandingDetection& seen);

  // How much larger (m) the altitude is told than seen; nothing where they agree, where too little
  // was seen, or where the attitude is wrong, on which the altitude hangs. With an attitude the
  // pattern may lie on a vehicle, less deep below the camera than told.
  std::optional<Contradiction> Altitude() const;

  // How far from level (rad) the pattern would lie if the attitude were right; nothing where it may
  // lie so, or too little was seen.
  std::optional<Contradiction> Attitude() const;

 private:
  struct Difference {
    double value;
    double sigma;
  };

  // The latest differences.
  class Latest {
   public:
    void Add(const Difference& difference);
    bool empty() const { return added_ == 0; }
    // Nothing when there are too few.
    std::optional<Contradiction> Median() const;

   private:
    static constexpr std::size_t kCapacity = 64;

    std::array<Difference, kCapacity> differences_;
    std::size_t added_ = 0;
  };

  Latest altitudes_;
  Latest tilts_;
};

}  // namespace kestrel
