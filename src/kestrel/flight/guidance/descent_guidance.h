// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include <Eigen/Core>

#include "kestrel/core/base/time.h"
#include "kestrel/core/poses/set_point.h"
#include "kestrel/flight/guidance/guidance.h"  // IWYU pragma: export
#include "kestrel/flight/guidance/guidance_options.h"
#include "kestrel/flight/guidance/road_memory.h"
#include "kestrel/flight/guidance/target_search.h"

namespace kestrel {

// The common part of the guidances that come down on a target: the UAV's state relative to it, the
// cone above it, and the search for a target that is not there.
class DescentGuidance : public Guidance {
 protected:
  // If the UAV moves faster over the target it does not descend, m/s.
  static constexpr double kMaxClosing_mps = 1;
  // Offset, in cones, at which the last bit of a descent is given up.
  static constexpr double kCommitCones = 3;

  // As of Guidance.
  DescentGuidance(const GuidanceOptions& options, const std::optional<Eigen::Vector2d>& place);

  // The UAV's state relative to the target.
  struct Situation {
    Eigen::Vector3d feet;
    Eigen::Vector3d velocity;
    double height_m = 0;  // height of the feet above the target
    double off_m = 0;     // horizontal distance from the target
    double slip_mps = 0;  // horizontal speed relative to the target
    bool is_in_sight = false;
    bool is_known = false;  // the target's position is known well enough to descend
    bool is_credible = true;
  };
  Situation Look(const GuidanceInput& input) const;
  bool MayDescend(const Situation& now) const;
  double Cone(double height_m) const;
  bool IsBehind(const GuidanceInput& input) const override;

  // The search: where guidance begins, or after a loss where the target was going.
  void StartSearch();
  void SearchAfterLoss(Time now);
  bool IsSearchOver(Time now) const { return search_.IsOver(now); }
  SetPoint Search(const GuidanceInput& input, const Situation& now);
  // Keeps the target's place and its road. The target is known.
  void KeepPlace(const GuidanceInput& input, const Situation& now);

 private:
  RoadMemory road_;
  TargetSearch search_;
};

}  // namespace kestrel
