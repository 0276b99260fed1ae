// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include <Eigen/Core>

#include "kestrel/core/base/time.h"
#include "kestrel/core/poses/set_point.h"
#include "kestrel/flight/guidance/confirmation.h"
#include "kestrel/flight/guidance/guidance.h"  // IWYU pragma: export
#include "kestrel/flight/guidance/guidance_options.h"
#include "kestrel/flight/guidance/stand_off.h"
#include "kestrel/flight/guidance/target_jump.h"
#include "kestrel/flight/guidance/view_limits.h"

namespace kestrel {

// Follows what a person has marked, from beside and above it, with the nose towards it. It stands
// still and looks until a person orders it to fly to this mark, and whenever the target is lost. It
// never descends below the height asked for. docs/follow.md describes it.
class FollowGuidance : public Guidance {
 public:
  // 'view': of a camera that is fixed to the body; nothing: it is on a gimbal. Throws InputError
  // when the options are not valid, the height is beyond the limits, or such a camera does not see
  // the target from there.
  FollowGuidance(const GuidanceOptions& options, const std::optional<ViewLimits>& view);

 private:
  void Begin(const GuidanceInput& input) override;
  Wish Choose(const GuidanceInput& input) override;
  const char* WhyGiveUp(const GuidanceInput& /*input*/) override { return nullptr; }
  bool IsBehind(const GuidanceInput& input) const override;

  void ChoosePhase(const GuidanceInput& input);
  const char* WhyNotFollow(const GuidanceInput& input);
  void TakeOrder(const GuidanceInput& input, const char* trouble);
  void Stop(const char* reason);
  bool IsFollowing() const;
  double DistanceError(const GuidanceInput& input) const;

  SetPoint Stay(const GuidanceInput& input);
  SetPoint Pursue(const GuidanceInput& input);
  void TurnNose(const GuidanceInput& input, double seconds);
  void LimitLean(const GuidanceInput& input, double seconds, SetPoint* set_point) const;

  std::optional<ViewLimits> view_;
  StandOff stand_off_;
  Confirmation confirmation_;
  std::optional<Time> lost_;  // since when that is lost
  TargetJump jump_;
  std::optional<Eigen::Vector3d> stay_;  // where it stands still; nothing: it still brakes
  double yaw_ = 0;                       // where the nose is to point, rad
  double yaw_rate_ = 0;                  // rad/s
};

}  // namespace kestrel
