// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace kestrel {

// A height of the ground above the world's z = 0 (m), given or seen, with a standard deviation.
struct GroundHeight {
  double height_m = 0;
  double sigma_m = 0;
};

// Estimates the height of the ground from a given height (a setting, and a navigation whose z may
// be an altitude above sea level, or drift) and from sightings (objects of known size). The given
// height holds until the sightings contradict it: for several frames in a row, most of the latest
// sightings agree with each other and not with the given height. The standard deviation of a
// sighting must include the errors that sightings share (the focal length, the size of a print):
// heights are averaged, but the mean is not considered more certain than a single sighting.
class GroundHeightEstimator {
 public:
  GroundHeightEstimator() { sightings_.reserve(kCapacity); }

  // Adds the sightings of one frame. A frame without a sighting changes nothing. Sightings that are
  // not finite are ignored.
  void Update(const GroundHeight& given, std::span<const GroundHeight> seen);

  // Forgets the sightings, but not a contradiction. For frames that each have a height of their
  // own.
  void ForgetSightings();

  // Returns the height that holds: the given one, or the seen one where that contradicts it.
  GroundHeight Estimate(const GroundHeight& given) const { return contradiction_.value_or(given); }

  // Returns how much higher the ground is seen than given; nothing as long as they agree or too
  // little was seen.
  std::optional<GroundHeight> Contradiction() const;

  // True when most of the latest sightings contradict the given height and agree with this
  // sighting. The first sighting has none against it.
  bool Supports(const GroundHeight& sighting) const;

 private:
  static constexpr std::size_t kCapacity = 32;

  std::size_t CountNear(const GroundHeight& height) const;
  GroundHeight MeanNear(double height_m) const;

  std::vector<GroundHeight> sightings_;  // the latest, oldest first
  GroundHeight given_;
  std::optional<GroundHeight> majority_;       // mean of most, where it contradicts
  int contradicting_frames_ = 0;               // in a row
  std::optional<GroundHeight> contradiction_;  // 'majority_' once it has held for enough frames
};

}  // namespace kestrel
