// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "kestrel/vision/landing/landing_pattern.h"

namespace kestrel {

// Points along the outlines of ring and arms, where the edges of the print are.
class PrintOutline {
 public:
  // Parts of the print: 0 to 3 are the arms, 4 to 7 the quarters of the ring around them.
  static constexpr int kArms = LandingPattern::kArms;
  static constexpr int kParts = 2 * kArms;
  static constexpr std::size_t kMaxPlaces = 160;

  struct Place {
    Eigen::Vector2d point;   // point on the plane, m
    Eigen::Vector2d normal;  // unit vector, from black to white
    int part;                // 0 to 3: arm, 4 to 7: quarter of the ring
    int side;                // 0 or 1: side of the arm, or inside and outside of the ring
    double width;            // width of the stroke, m
    double curvature;        // 1/m; positive where the outline bends around the black side
  };

  explicit PrintOutline(const LandingPattern& pattern);

  // All places, those of the ring first, in order along each outline.
  std::span<const Place> all() const { return places_; }
  std::span<const Place> ring() const { return std::span(places_).first(ring_places_); }

  double radius_m() const { return places_.front().point.norm(); }  // outer radius of the ring

  // True when two places lie on the same circle or on the same side of an arm.
  static bool AreOnOneOutline(const Place& a, const Place& b) {
    return a.curvature == b.curvature && a.side == b.side && (a.curvature != 0 || a.part == b.part);
  }

 private:
  void AddCircle(const LandingPattern& pattern, double radius, double sign, int count,
                 double arm_clearance);
  void AddArms(const LandingPattern& pattern);

  std::vector<Place> places_;
  std::size_t ring_places_ = 0;
};

}  // namespace kestrel
