// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include <Eigen/Core>

#include "kestrel/vision/target/target_detection.h"

namespace kestrel {

// Knowledge about a view of the pattern, given by the navigation or by the user.
struct GivenView {
  std::optional<double> altitude_m;             // height of the camera above the pattern
  std::optional<Eigen::Vector3d> up_in_camera;  // unit vector away from the ground
};

// A difference between a given value and the seen one.
struct Contradiction {
  double difference;       // median over the detections
  double sigma;            // standard deviation of the median
  std::size_t detections;  // number of detections
};

// Compares the given views of the pattern with its latest detections. Both mirror poses of a
// detection count: agreement with one of them is no contradiction.
class InputContradictions {
 public:
  void Add(const GivenView& given, const TargetDetection& seen);

  // Returns by how much (m) the given altitude is larger than the seen one. Nothing where they
  // agree, where too little was seen, or where the attitude is wrong, because the altitude depends
  // on it. With an attitude the pattern may lie on a vehicle, so its depth below the camera may be
  // less than given.
  std::optional<Contradiction> Altitude() const;

  // Returns the tilt (rad) of the pattern from level if the attitude were right. Nothing where that
  // tilt is plausible or too little was seen.
  std::optional<Contradiction> Attitude() const;

 private:
  struct Difference {
    double value;
    double sigma;
  };

  // The latest differences, in a ring buffer.
  class Latest {
   public:
    void Add(const Difference& difference);
    bool empty() const { return added_ == 0; }
    // Returns nothing when there are too few.
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
