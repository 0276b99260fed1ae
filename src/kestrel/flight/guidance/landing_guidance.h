// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include <Eigen/Core>

#include "kestrel/core/base/time.h"
#include "kestrel/core/poses/set_point.h"
#include "kestrel/flight/guidance/contact_detector.h"
#include "kestrel/flight/guidance/guidance.h"  // IWYU pragma: export
#include "kestrel/flight/guidance/guidance_options.h"
#include "kestrel/flight/guidance/road_memory.h"
#include "kestrel/flight/guidance/stay_on_deck.h"
#include "kestrel/flight/guidance/target_search.h"
#include "kestrel/flight/guidance/touchdown_heading.h"
#include "kestrel/flight/guidance/touchdown_timing.h"

namespace kestrel {

// Flies a multicopter to a moving target and down onto it by set-points. docs/guidance.md describes
// its phases and its reaction to each loss.
class LandingGuidance : public Guidance {
 public:
  // 'place': where the vehicle should pass (m, world); nothing: where guidance begins. Throws
  // InputError when the options are not valid.
  explicit LandingGuidance(const GuidanceOptions& options,
                           const std::optional<Eigen::Vector2d>& place = std::nullopt);

  int go_arounds() const { return go_arounds_; }  // number of times it climbed again
  std::optional<double> heading_error() const override { return heading_.error(); }

 private:
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

  void Begin(const GuidanceInput& input) override;
  Wish Choose(const GuidanceInput& input) override;
  const char* WhyGiveUp(const GuidanceInput& input) override;
  bool IsBehind(const GuidanceInput& input) const override;
  void ResumeAfterLink() override;
  void ResumeAfterPoses() override;

  // Set-points.
  SetPoint Search(const GuidanceInput& input, const Situation& now);
  SetPoint Pursue(const GuidanceInput& input, const Situation& now);
  double ClimbRate(const GuidanceInput& input, const Situation& now);
  std::optional<double> WaitHeight(Time now, double height_m);

  // Choice of the phase.
  Situation Look(const GuidanceInput& input) const;
  void ChoosePhase(const GuidanceInput& input, const Situation& now);
  void ChooseAbove(const Situation& now);
  bool MayDescend(const Situation& now) const;
  void ChooseDescent(const GuidanceInput& input, const Situation& now);
  bool FindContact(const GuidanceInput& input, const Situation& now);
  void GoAround(const char* reason);
  double Cone(double height_m) const;
  bool IsLow() const;  // in a phase that descends

  RoadMemory road_;
  TargetSearch search_;
  ContactDetector contact_;
  StayOnDeck stay_;
  TouchdownTiming timing_;
  TouchdownHeading heading_;
  int go_arounds_ = 0;
  std::optional<Time> contact_since_;
};

}  // namespace kestrel
