// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>

namespace kestrel {

// An object of the paper's map (section 3.7), and a detection of one.
struct ColorTarget {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  // g, world, m
  Eigen::VectorXd score_likelihoods;                   // s, over the same scores in all targets
  Eigen::Vector3d color = Eigen::Vector3d::Zero();     // c, RGB
  int detections = 1;                                  // n

  int most_likely_score() const;  // s_max, an index; the likelihoods must not be empty
};

// The paper's map, as printed. It serves as the reference for ObjectMap.
class ColorTargetMap {
 public:
  // 'max_error_m': e_max, the largest localisation error, m.
  explicit ColorTargetMap(double max_error_m) : max_error_m_(max_error_m) {}

  // Algorithm 5: each detection is merged into the nearest object if that is nearer than e_max
  // (means of position and colour, sum of the likelihoods). Otherwise it becomes a new object.
  void Update(std::span<const ColorTarget> detections);

  const std::vector<ColorTarget>& objects() const { return objects_; }

 private:
  double max_error_m_;
  std::vector<ColorTarget> objects_;
};

}  // namespace kestrel
