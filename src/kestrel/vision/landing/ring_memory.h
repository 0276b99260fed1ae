// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include <Eigen/Core>

namespace kestrel {

// Where a ring was seen in the image, pixels at full resolution.
struct RingPlace {
  Eigen::Vector2d center_px;
  Eigen::Vector2d diameters_px;
  double reach_px = 0;  // within which its edges were looked for
};

// The rings of an image that were tested: another pass sees the same ring again. Does not allocate
// once it is reserved; what there is no room for is forgotten.
class RingMemory {
 public:
  void Reserve() { places_.reserve(kMaxPlaces); }
  void Clear() { places_.clear(); }
  void Note(const RingPlace& place) {
    if (places_.size() < places_.capacity()) places_.push_back(place);
  }

  // Whether nearly the same ring is there: its centre within a share of its shorter axis, and its
  // edges within what was looked at there.
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
