// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include <Eigen/Core>

#include "kestrel/core/base/time.h"
#include "kestrel/core/poses/set_point.h"
#include "kestrel/flight/guidance/confirmation.h"
#include "kestrel/flight/guidance/descent_guidance.h"  // IWYU pragma: export
#include "kestrel/flight/guidance/go_delivery.h"
#include "kestrel/flight/guidance/go_job.h"
#include "kestrel/flight/guidance/guidance_options.h"
#include "kestrel/flight/guidance/target_jump.h"

namespace kestrel {

// Flies a multicopter at the height of the search to an object, which may move, and down on it;
// does a job there, climbs, and stands still. A descent that failed is tried again, and so is a
// pick after which the object is still seen on the ground. What a person has marked, and a place,
// are objects here. A job that delivers takes the object to a box, and goes on to the next one. The
// others of a team are kept away from. docs/go.md describes it.
class GoGuidance : public DescentGuidance {
 public:
  static constexpr int kTries = 5;

  // Throws InputError when the options are not valid, or job and search are beyond the limits.
  GoGuidance(const GuidanceOptions& options, const GoJob& job);

  // True once the job is done: the UAV stands still until the mode is left.
  bool is_done() const { return is_done_; }
  // Only a gripper's job takes the UAV down that far.
  bool is_at_deck() const override;
  ObjectEnd ended() const override { return ended_; }
  bool is_at_work() const override;
  bool wants_object() const override { return !carries_ && !is_done_; }

 private:
  // The object's motion when the gripper moved.
  struct Gripped {
    TurnState motion;
    Time time;
  };

  void Begin(const GuidanceInput& input) override;
  Wish Choose(const GuidanceInput& input) override;
  const char* WhyGiveUp(const GuidanceInput& input) override;
  void ResumeAfterLink() override;
  void ResumeAfterPoses() override;

  void Reset();

  // A person's orders.
  void TakeOrder(const GuidanceInput& input);
  void Await(const char* reason);
  bool AwaitsPerson() const;
  bool HasJumped(const GuidanceInput& input);

  // Choice of the phase.
  void ChoosePhase(const GuidanceInput& input, const Situation& now);
  bool FindObject(const GuidanceInput& input);
  void ChooseApproach(const GuidanceInput& input, const Situation& now);
  void ChooseDescent(const GuidanceInput& input, const Situation& now);
  void ChooseCommit(const GuidanceInput& input, const Situation& now);
  bool IsAbove(const Situation& now) const;
  bool MayGrip(const TargetEstimate& target, const Situation& now) const;
  bool HasReached(const GuidanceInput& input, const Situation& now);
  void Act(const GuidanceInput& input);
  void Grip(const GuidanceInput& input);
  void ChooseClimb(const GuidanceInput& input, const Situation& now);
  void RememberGrip(const GuidanceInput& input);
  bool IsWhereGripped(const GuidanceInput& input) const;
  void LookWhetherGone(const GuidanceInput& input, const Situation& now);
  void TryAgain(const char* reason);
  void Finish();
  void Lose(Time now);
  bool Rests(Time now) const;
  void Leave(bool is_taken, const char* reason);
  void Deliver(const GuidanceInput& input, const Situation& now);
  bool IsLow() const;  // in a phase near the object
  bool MustClimbOff(const GuidanceInput& input, const Situation& now) const;
  static bool ComesNear(const Situation& now, std::span<const OtherUav> others, double distance_m);
  bool IsInFence(const Eigen::Vector2d& place) const;
  // Requests a motion of the gripper; true once the autopilot has accepted it.
  bool Operate(const GuidanceInput& input, GuidanceRequest motion);

  // Set-points.
  void KeepAway(const GuidanceInput& input, const Situation& now, SetPoint* command);
  SetPoint Command(const GuidanceInput& input, const Situation& now);
  SetPoint Pursue(const GuidanceInput& input, const Situation& now);
  SetPoint Wait(const Situation& now);
  SetPoint Stay(const Eigen::Vector2d& place, double height_m, const Situation& now);
  SetPoint Carry(const GuidanceInput& input, const Situation& now);
  double ClimbRate(const Situation& now) const;

  GoJob job_;
  GoDelivery delivery_;
  Eigen::Vector2d home_{0, 0};  // where guidance began
  double travel_m_ = 0;         // height of the UAV's layer
  Eigen::Vector2d going_to_{0, 0};
  ObjectEnd ended_;
  bool carries_ = false;  // an object, to the box
  bool is_near_box_ = false;
  bool skips_ = false;  // leaves the object, once it has climbed
  double yaw_ = 0;      // of the nose, rad
  Confirmation confirmation_;
  TargetJump jump_;                          // of what is marked
  std::optional<Eigen::Vector3d> waits_at_;  // for a person, once it stands still; of the feet
  int mark_ = 0;                             // number of the object; 0: none yet
  double object_z_m_ = 0;                    // its height in the world
  int failures_ = 0;                         // descents and picks
  std::optional<Gripped> at_grip_;           // nothing: it was not known where the object was
  bool has_gripped_ = false;                 // in this descent
  bool is_open_ = false;                     // the gripper, before a pick
  bool is_done_ = false;
  double unseen_s_ = 0;              // while it looks whether the object is gone
  const char* fault_ = nullptr;      // why it gives up, once it has climbed
  const char* give_up_ = nullptr;    // why it gives up now
  std::optional<Time> waits_since_;  // near the object, until it is above it
  std::optional<Time> rests_since_;  // does not sink any more, although it should
  std::optional<Time> gripped_;      // when the autopilot accepted the gripper's motion
  GuidanceRequest motion_ = GuidanceRequest::kNone;  // that is requested of the gripper
  int answers_before_ = 0;                           // number of answers when that began
};

}  // namespace kestrel
