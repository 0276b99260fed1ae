// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>

#include <Eigen/Core>

#include "kestrel/vision/landing/landing_pattern_detector.h"

namespace kestrel {

// The focal length as a factor of the calibration's.
struct FocalFactor {
  double factor;
  double sigma;            // standard deviation
  std::size_t detections;  // how many say so
};

// In how many detections the pattern is not where pose and calibration have it.
struct MisfitCount {
  std::size_t misfits;
  std::size_t detections;  // that have edges
};

// Adds up what the detections of a run say about the calibration: an information filter. One view
// leaves a line of focal lengths and principal points open; views from several sides have one point
// in common. The distortion is asked for too: one that is wrong would pass for another focal
// length. Does not allocate, however long the run is.
class CalibrationMonitor {
 public:
  void Add(const LandingDetection& detection);

  // What the detections say together; nothing where there are too few of them.
  std::optional<FocalFactor> Focal() const;

  // The same, where it contradicts the calibration.
  std::optional<FocalFactor> Contradiction() const;

  // How many misfits there are, where they are more than a print here and there that is not flat.
  std::optional<MisfitCount> Misfits() const;

 private:
  // The views from one side: they share what the print is off, and count as one that has no noise.
  struct Side {
    std::array<int, 4> key;  // from where the print is seen, and where in the image
    Eigen::Matrix4d information = Eigen::Matrix4d::Zero();
    Eigen::Vector4d pull = Eigen::Vector4d::Zero();
    double shared = 0;      // variance that its views have in common, of that of their mean
    double surprise_0 = 0;  // of the calibration as it is

    // Square of how far 'error' is from what the views say, in their covariance.
    double Surprise(const Eigen::Vector4d& error) const;
    double Trust() const { return 1 / (1 + shared); }
  };

  void AddEvidence(const LandingDetection& detection);
  Side* SideOf(const LandingDetection& detection);
  void Weigh();

  static constexpr std::size_t kMostSides = 128;
  std::array<Side, kMostSides> sides_{};
  std::size_t side_count_ = 0;
  std::size_t views_ = 0;
  Eigen::Vector4d error_ = Eigen::Vector4d::Zero();  // of the calibration, by all views
  double log_focal_sigma_ = 0;
  MisfitCount misfits_{};
};

// The line that says how the detections contradict the calibration, whose focal length is
// 'focal_px', and what to do; empty where they do not.
std::string LensWarning(const CalibrationMonitor& monitor, double focal_px);

}  // namespace kestrel
