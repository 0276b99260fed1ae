// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/pipeline/ground_height.h"

#include <algorithm>
#include <cmath>

namespace kestrel {
namespace {

// Within three standard deviations, which one of 370 exceeds.
bool Agree(const GroundHeight& a, const GroundHeight& b) {
  return std::abs(a.height_m - b.height_m) <= 3 * std::hypot(a.sigma_m, b.sigma_m);
}

}  // namespace

void GroundHeightEstimator::Update(const GroundHeight& given, std::span<const GroundHeight> seen) {
  constexpr int kMinFrames = 5;
  given_ = given;
  bool is_seen = false;
  for (const GroundHeight& sighting : seen) {
    if (!std::isfinite(sighting.height_m) || !std::isfinite(sighting.sigma_m)) continue;
    if (sightings_.size() == kCapacity) sightings_.erase(sightings_.begin());
    sightings_.push_back(sighting);
    is_seen = true;
  }
  if (!is_seen) return;
  double height_m = given.height_m;
  std::size_t most = CountNear(given);
  for (const GroundHeight& sighting : sightings_) {
    const std::size_t count = CountNear({sighting.height_m, 0});
    if (count <= most) continue;
    most = count;
    height_m = sighting.height_m;
  }
  const GroundHeight mean = MeanNear(height_m);
  const bool contradicts = 2 * most > sightings_.size() && !Agree(mean, given);
  contradicting_frames_ = contradicts ? contradicting_frames_ + 1 : 0;
  majority_ = contradicts ? std::optional(mean) : std::nullopt;
  contradiction_ = contradicting_frames_ >= kMinFrames ? majority_ : std::nullopt;
}

void GroundHeightEstimator::ForgetSightings() {
  sightings_.clear();
  majority_.reset();
}

std::optional<GroundHeight> GroundHeightEstimator::Contradiction() const {
  if (!contradiction_) return std::nullopt;
  return GroundHeight{contradiction_->height_m - given_.height_m,
                      std::hypot(contradiction_->sigma_m, given_.sigma_m)};
}

bool GroundHeightEstimator::Supports(const GroundHeight& sighting) const {
  return majority_ && Agree(sighting, *majority_);
}

std::size_t GroundHeightEstimator::CountNear(const GroundHeight& height) const {
  return std::ranges::count_if(
      sightings_, [&](const GroundHeight& sighting) { return Agree(sighting, height); });
}

GroundHeight GroundHeightEstimator::MeanNear(double height_m) const {
  double weights = 0;
  double sum = 0;
  double count = 0;
  for (const GroundHeight& sighting : sightings_) {
    if (!Agree(sighting, {height_m, 0})) continue;
    const double weight = 1 / (sighting.sigma_m * sighting.sigma_m);
    weights += weight;
    sum += weight * sighting.height_m;
    ++count;
  }
  if (count == 0) return {height_m, 0};
  return {sum / weights, std::sqrt(count / weights)};
}

}  // namespace kestrel
