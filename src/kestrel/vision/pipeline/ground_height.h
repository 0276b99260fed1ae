// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace kestrel {

// How high the ground is above the world's z = 0 (m), as somebody says, with a standard deviation.
struct GroundHeight {
  double height_m = 0;
  double sigma_m = 0;
};

// Where the ground is, by what is told (a setting, and a navigation whose z may be an altitude
// above sea level, or drift) and by what is seen (things of known size). What is told holds until
// what is seen contradicts it: most of the latest sightings agree with each other and not with what
// is told, in some frames in a row. The standard deviation of a sighting must have in it what
// sightings have in common (the focal length, the size of a print): heights are averaged, but the
// mean is taken to be no surer than they are.
class GroundHeightEstimator {
 public:
  GroundHeightEstimator() { sightings_.reserve(kCapacity); }

  // What one frame shows; one without a sighting changes nothing. Sightings that are not finite are
  // left out.
  void Update(const GroundHeight& told, std::span<const GroundHeight> seen);

  // Forgets what was seen, but not a contradiction: for frames each of which has a height of its
  // own.
  void ForgetSightings();

  // What holds: what is told, or what is seen where that contradicts it.
  GroundHeight Estimate(const GroundHeight& told) const { return contradiction_.value_or(told); }

  // How much higher the ground is seen than told; nothing as long as they agree, or too little was
  // seen.
  std::optional<GroundHeight> Contradiction() const;

  // Whether most of the latest sightings contradict what is told, and agree with this one. The
  // first sighting has nobody against it.
  bool Supports(const GroundHeight& sighting) const;

 private:
  static constexpr std::size_t kCapacity = 32;

  std::size_t CountNear(const GroundHeight& height) const;
  GroundHeight MeanNear(double height_m) const;

  std::vector<GroundHeight> sightings_;  // the latest, the oldest first
  GroundHeight told_;
  std::optional<GroundHeight> majority_;  // what most of them say, where that is not what is told
  int contradicting_frames_ = 0;          // in a row
  std::optional<GroundHeight> contradiction_;  // the majority, once there are enough of these
};

}  // namespace kestrel
