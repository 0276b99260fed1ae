// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "kestrel/core/base/random.h"
#include "kestrel/vision/mapping/object_map.h"

namespace kestrel {

// Indices of colours in the model.
inline constexpr std::size_t kRed = 0;
inline constexpr std::size_t kYellow = 2;

inline Time At(double seconds) { return Time(DurationFromSeconds(seconds)); }

// A detection of a disc of the model's colour 'color' at 'position', with standard deviation
// 'sigma_m' per axis.
inline ObjectMeasurement MeasureDisc(const Eigen::Vector3d& position, std::size_t color,
                                     double sigma_m = 0.05) {
  ObjectMeasurement measurement;
  measurement.position = position;
  measurement.covariance = sigma_m * sigma_m * Eigen::Matrix3d::Identity();
  measurement.color_probabilities[color] = 0.95;
  return measurement;
}

inline ObjectMeasurement MeasureNoisily(const Eigen::Vector3d& position, std::size_t color,
                                        double sigma_m, Random* random) {
  const Eigen::Vector3d noise(random->Normal(), random->Normal(), random->Normal());
  return MeasureDisc(position + sigma_m * noise, color, sigma_m);
}

struct SeesAll : FieldOfView {
  bool Shows(const MappedObject& /*object*/) const override { return true; }
};
struct SeesNothing : FieldOfView {
  bool Shows(const MappedObject& /*object*/) const override { return false; }
};

}  // namespace kestrel
