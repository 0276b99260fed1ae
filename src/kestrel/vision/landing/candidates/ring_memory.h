// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include <Eigen/Core>

namespace kestrel {

// Location of a tested ring, pixels at full resolution.
struct RingPlace {
  Eigen::Vector2d center_px;
  Eigen::Vector2d diameters_px;
  double reach_px = 0;  // its edges were searched within this distance
};

// Remembers the rings of an image that were tested, because another pass sees the same ring again.
// Does not allocate once it is reserved; further rings are not remembered.
class RingMemory {
 public:
  // Distance of the centres of two starts that come to the same, as a share of the shorter axis.
  static constexpr double kSameStart = 0.05;

  void Reserve() { places_.reserve(kMaxPlaces); }
  void Clear() { places_.clear(); }
  void Note(const RingPlace& place) {
    if (places_.size() < places_.capacity()) places_.push_back(place);
  }

  // True when nearly the same ring was tested: the centres are within 'same_center' times the
  // shorter axis, the diameters agree to 10 %, and its edges were searched at least as far away.
  bool Holds(const RingPlace& place, double same_center) const {
    constexpr double kSameSize = 0.1;
    return std::any_of(places_.begin(), places_.end(), [&](const RingPlace& other) {
      return (place.center_px - other.center_px).norm() < same_center * place.diameters_px.y() &&
             ((place.diameters_px - other.diameters_px).array().abs() <
              kSameSize * place.diameters_px.array())
                 .all() &&
             place.reach_px <= other.reach_px;
    });
  }

 private:
  static constexpr std::size_t kMaxPlaces = 64;
  std::vector<RingPlace> places_;
};

}  // namespace kestrel
