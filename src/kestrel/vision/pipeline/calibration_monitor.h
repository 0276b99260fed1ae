// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>

#include <Eigen/Core>

#include "kestrel/vision/target/target_detection.h"

namespace kestrel {

// Estimated focal length, as a factor of the calibrated one.
struct FocalFactor {
  double factor;
  double sigma;            // standard deviation
  std::size_t detections;  // number of detections it is estimated from
};

// Number of detections whose pattern is not where pose and calibration predict it.
struct MisfitCount {
  std::size_t misfits;
  std::size_t detections;  // detections with edges
};

// Combines the evidence of a run's detections about the calibration (an information filter). One
// view leaves a line of focal lengths and principal points open; views from several sides have one
// point in common. The distortion is estimated too, because a wrong one would pass for another
// focal length. Does not allocate, however long the run is.
class CalibrationMonitor {
 public:
  void Add(const TargetDetection& detection);

  // Returns the estimate from all detections; nothing when there are too few of them.
  std::optional<FocalFactor> Focal() const;

  // Returns the same estimate where it contradicts the calibration.
  std::optional<FocalFactor> Contradiction() const;

  // Returns the misfits where there are more than isolated prints that are not flat would cause.
  std::optional<MisfitCount> Misfits() const;

 private:
  // The views from one side. They share the errors of the print, and count as one view without
  // noise.
  struct Side {
    std::array<int, 4> key;  // viewing direction in the print and in the image, quantized
    Eigen::Matrix4d information = Eigen::Matrix4d::Zero();
    Eigen::Vector4d pull = Eigen::Vector4d::Zero();
    double shared = 0;      // variance that its views share, divided by the variance of their mean
    double surprise_0 = 0;  // squared Mahalanobis distance of the calibration as it is

    // Squared Mahalanobis distance of 'error' from the evidence of its views, weighted by Trust.
    double Surprise(const Eigen::Vector4d& error) const;
    double Trust() const { return 1 / (1 + shared); }
  };

  void AddEvidence(const TargetDetection& detection);
  Side* SideOf(const TargetDetection& detection);
  void Weigh();

  static constexpr std::size_t kMostSides = 128;
  std::array<Side, kMostSides> sides_{};
  std::size_t side_count_ = 0;
  std::size_t views_ = 0;
  Eigen::Vector4d error_ = Eigen::Vector4d::Zero();  // estimated error of the calibration
  double log_focal_sigma_ = 0;
  MisfitCount misfits_{};
};

// Returns a line that describes how the detections contradict the calibration, whose focal length
// is 'focal_px', and what to do; empty where they do not.
std::string LensWarning(const CalibrationMonitor& monitor, double focal_px);

}  // namespace kestrel
