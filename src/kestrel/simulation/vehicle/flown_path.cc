// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/simulation/vehicle/flown_path.h"

#include <algorithm>
#include <cstddef>

namespace kestrel {

RigidTransform FlownPath::At(double time_s) const {
  const double last = static_cast<double>(poses_.size()) - 1;
  const double place = std::clamp((time_s - begin_s_) / step_s_, 0.0, last);
  const auto before = static_cast<std::size_t>(place);
  const std::size_t after = std::min(before + 1, poses_.size() - 1);
  const double part = place - static_cast<double>(before);
  const RigidTransform& from = poses_[before];
  const RigidTransform& to = poses_[after];
  return {from.rotation.slerp(part, to.rotation),
          from.translation + part * (to.translation - from.translation)};
}

}  // namespace kestrel
