// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include <Eigen/Core>

#include "kestrel/core/base/time.h"
#include "kestrel/core/poses/set_point.h"
#include "kestrel/flight/guidance/contact_detector.h"
#include "kestrel/flight/guidance/descent_guidance.h"  // IWYU pragma: export
#include "kestrel/flight/guidance/guidance_options.h"
#include "kestrel/flight/guidance/stay_on_deck.h"
#include "kestrel/flight/guidance/touchdown_heading.h"
#include "kestrel/flight/guidance/touchdown_timing.h"

namespace kestrel {

// Flies a multicopter to a moving target and down onto it by set-points. docs/guidance.md describes
// its phases and its reaction to each loss.
class LandingGuidance : public DescentGuidance {
 public:
  // 'place': where the vehicle should pass (m, world); nothing: where guidance begins. Throws
  // InputError when the options are not valid.
  explicit LandingGuidance(const GuidanceOptions& options,
                           const std::optional<Eigen::Vector2d>& place = std::nullopt);

  int go_arounds() const { return go_arounds_; }  // number of times it climbed again
  std::optional<double> heading_error() const override { return heading_.error(); }

 private:
  void Begin(const GuidanceInput& input) override;
  Wish Choose(const GuidanceInput& input) override;
  const char* WhyGiveUp(const GuidanceInput& input) override;
  void ResumeAfterLink() override;
  void ResumeAfterPoses() override;

  // Set-points.
  SetPoint Pursue(const GuidanceInput& input, const Situation& now);
  double ClimbRate(const GuidanceInput& input, const Situation& now);
  std::optional<double> WaitHeight(Time now, double height_m);

  // Choice of the phase.
  void ChoosePhase(const GuidanceInput& input, const Situation& now);
  void ChooseAbove(const Situation& now);
  void ChooseDescent(const GuidanceInput& input, const Situation& now);
  bool FindContact(const GuidanceInput& input, const Situation& now);
  void GoAround(const char* reason);
  bool IsLow() const;  // in a phase that descends

  ContactDetector contact_;
  StayOnDeck stay_;
  TouchdownTiming timing_;
  TouchdownHeading heading_;
  int go_arounds_ = 0;
  std::optional<Time> contact_since_;
};

}  // namespace kestrel
