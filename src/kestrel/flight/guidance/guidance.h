// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <limits>
#include <optional>
#include <span>

#include <Eigen/Core>

#include "kestrel/core/base/time.h"
#include "kestrel/core/geometry/rigid_transform.h"
#include "kestrel/core/poses/set_point.h"
#include "kestrel/flight/guidance/flight_limits.h"
#include "kestrel/flight/guidance/flight_model.h"
#include "kestrel/flight/guidance/following_demand.h"
#include "kestrel/flight/guidance/guidance_options.h"
#include "kestrel/flight/guidance/guidance_phase.h"
#include "kestrel/flight/guidance/guidance_request.h"
#include "kestrel/flight/guidance/other_uav.h"
#include "kestrel/flight/guidance/stale_safety.h"
#include "kestrel/flight/guidance/target_pursuit.h"
#include "kestrel/vision/tracking/target_tracker.h"

namespace kestrel {

// The UAV's own state.
struct UavState {
  RigidTransform world_from_body;               // FLU to ENU
  Eigen::Vector3d velocity_in_world{0, 0, 0};   // m/s
  std::optional<double> position_sigma_m = {};  // per axis, where it is known
};

// The deck in one frame.
struct DeckSighting {
  Time time;
  double height_m = 0;              // world
  Eigen::Vector3d normal{0, 0, 1};  // in the world
};

// A person's order to fly to what is marked, or to stop. Aligned as std::atomic needs it to work
// without locks.
struct alignas(8) FollowOrder {
  int number = 0;  // each order has a larger one than the order before
  int mark = 0;    // the mark to which the UAV is to fly; 0: to none
};

// The autopilot's answers to requests of the gripper.
struct GripperAnswers {
  int number = 0;            // so far
  bool is_accepted = false;  // the newest one; false as well when none came
};

// The end of the job at an object.
struct ObjectEnd {
  int mark = 0;           // the object's number; 0: no job has ended yet
  bool is_taken = false;  // false: given up
};

// All inputs of guidance at an instant.
struct GuidanceInput {
  Time now;                     // never earlier than the one before
  std::optional<UavState> uav;  // predicted to now; nothing when the poses have stopped
  // False: without a pose the autopilot's own position is a guess, which it cannot hold.
  bool can_hold = true;
  std::optional<TargetEstimate> target;  // predicted to now; nothing while there is none, or lost
  // Time since the newest frame that showed the target was taken, s; without the delay of late
  // video where that is known, at most kMostVideoDelay_s of it, as far as a track predicts well.
  static constexpr double kMostVideoDelay_s = 0.3;
  double target_age_s = std::numeric_limits<double>::infinity();
  std::optional<DeckSighting> deck;  // the newest frame that showed it
  // Number of the person's mark, or of the object, that the target is of; 0: of none.
  int mark = 0;
  FollowOrder order;  // the newest one
  GripperAnswers gripper;
  std::span<const OtherUav> others;    // of the team, that fly
  int layer = 0;                       // of the heights at which they travel, from the lowest one
  std::optional<Eigen::Vector2d> box;  // where objects are delivered, once it is known (m, world)
  bool is_guided = false;  // the mode in which the autopilot obeys set-points, by its heartbeat
  bool is_armed = false;
  bool is_landed = false;    // the autopilot reports that it is on the ground
  bool is_link_up = true;    // messages come from the autopilot
  bool is_camera_up = true;  // new images come that differ from the ones before
  double mode_age_s = 0;     // time since the autopilot reported its mode, s
  double link_delay_s = 0;   // time from sending a set-point to its use, s
};

struct GuidanceOutput {
  std::optional<SetPoint> set_point;  // nothing: send none
  GuidancePhase phase = GuidancePhase::kIdle;
  GuidanceRequest request = GuidanceRequest::kNone;
  const char* reason = "";  // reason for the phase, for the user; a literal
  // Following the target demands more than the limits: the UAV falls behind, or would.
  bool cannot_follow = false;
};

// The common part of the guidance of each task: beginning and end with the pilot's mode, losses of
// link, mode, poses and camera, an autopilot that does not obey, and limits. A state machine
// without clock, socket or thread: everything that happens is in the inputs.
//
// It begins when is_guided turns true and ends when it turns false. To begin again, the pilot must
// leave the mode and give it anew.
class Guidance {
 public:
  virtual ~Guidance() = default;

  // Call it at 20 Hz or more, in order of time.
  GuidanceOutput Update(const GuidanceInput& input);

  // With stream_before_start: sends set-points of standing still again before the mode is given.
  // After the pilot has left the mode none are sent until this is called, because PX4 would go back
  // to OFFBOARD by itself. No effect while guidance flies.
  void Rearm();

  // Sets the middle of the geofence (m, world), instead of the place where guidance begins.
  void SetFenceCenter(const Eigen::Vector2d& center);

  GuidancePhase phase() const { return phase_; }
  // True where a stop would end on the deck or the ground, with the motors on.
  virtual bool is_at_deck() const {
    return phase_ == GuidancePhase::kLanded || phase_ == GuidancePhase::kCommit;
  }
  // True from when it gives up, or refuses to begin in the air, until the mode is left.
  bool has_given_up() const { return has_given_up_; }
  // Part of the limits that following the target takes, the largest of the last seconds.
  const FollowingDemand& demand() const { return demand_.demand(); }
  // TouchdownHeading::error of a landing.
  virtual std::optional<double> heading_error() const { return std::nullopt; }
  // The last job that ended at an object: it is taken, or guidance goes on to the next one.
  virtual ObjectEnd ended() const { return {}; }
  // True while the other UAVs of the team keep away.
  virtual bool is_at_work() const { return false; }
  // False while no object would help: it carries one, or is done.
  virtual bool wants_object() const { return true; }
  // Wind, drag and the autopilot's answer, as learnt in flight.
  const FlightModel& model() const { return model_; }

 protected:
  static constexpr double kHalted_mps = 0.5;  // a UAV that is slower stands still where it is
  static constexpr double kHeightGain = 1;    // climb rate per metre below the wanted height, 1/s

  // 'place': where the vehicle should pass (m, world); nothing: where guidance begins. Throws
  // InputError when the options are not valid.
  Guidance(const GuidanceOptions& options, const std::optional<Eigen::Vector2d>& place);
  Guidance(const Guidance&) = default;
  Guidance& operator=(const Guidance&) = default;

  // What a task wants at an instant.
  struct Wish {
    SetPoint set_point;
    bool follows_target = false;  // it may bring the UAV below limits.floor_m
    bool is_flying = true;        // false: it stands on the deck
    GuidanceRequest request = GuidanceRequest::kNone;
  };
  // Begins; the UAV's position is known.
  virtual void Begin(const GuidanceInput& input) = 0;
  // Chooses the phase and what to fly; may end guidance. The UAV's position is known.
  virtual Wish Choose(const GuidanceInput& input) = 0;
  // Returns why the task gives up, a literal; null: it does not.
  virtual const char* WhyGiveUp(const GuidanceInput& input) = 0;
  // True unless the UAV keeps up with the target. Target and position are known.
  virtual bool IsBehind(const GuidanceInput& input) const = 0;
  // Link or poses are back after a loss that lasted.
  virtual void ResumeAfterLink() {}
  virtual void ResumeAfterPoses() {}

  void End(const char* reason);
  void Enter(GuidancePhase phase, const char* reason);
  void set_reason(const char* reason) { reason_ = reason; }
  bool is_active() const { return is_active_; }
  Time last() const { return last_; }        // time of the last update
  Time entered() const { return entered_; }  // time at which the phase began
  double SecondsSinceLast(Time now) const;   // at most a moment, however long there was none
  // The place where the vehicle was last, or should pass (m, world).
  const Eigen::Vector2d& place() const { return place_; }
  void set_place(const Eigen::Vector2d& place) { place_ = place; }
  const std::optional<SetPoint>& sent() const { return sent_; }

  const GuidanceOptions& options() const { return options_; }
  const FlightLimits& limits() const { return limits_; }
  const StaleSafety& stale() const { return stale_; }
  FlightModel& flight_model() { return model_; }
  TargetPursuit& pursuit() { return pursuit_; }

 private:
  // Beginning and end.
  void FollowMode(const GuidanceInput& input);
  void Start(const GuidanceInput& input);
  bool HasLink(const GuidanceInput& input);
  bool GivesUp(const GuidanceInput& input);
  bool Obeys(const GuidanceInput& input);
  void WatchDemand(const GuidanceInput& input);
  bool CannotFollow() const;

  // Set-points.
  GuidanceOutput Idle(const GuidanceInput& input);
  GuidanceOutput Blind(const GuidanceInput& input);
  GuidanceRequest RequestBlind(const GuidanceInput& input) const;
  GuidanceOutput Fly(const GuidanceInput& input);
  GuidanceOutput Output(const std::optional<SetPoint>& set_point, GuidanceRequest request) const;

  GuidanceOptions options_;
  bool has_place_;
  bool has_fence_center_ = false;
  FlightLimits limits_;
  FlightModel model_;
  StaleSafety stale_;
  TargetPursuit pursuit_;
  DemandWatch demand_;

  GuidancePhase phase_ = GuidancePhase::kIdle;
  const char* reason_;
  Time entered_;
  bool is_active_ = false;
  bool has_given_up_ = false;  // requests hold while it has the mode
  bool may_stream_;
  std::optional<bool> was_guided_;  // nothing: not reported yet
  Time last_;
  std::optional<Time> link_lost_;          // since when there is no link
  std::optional<Time> mode_wanted_since_;  // since then the autopilot has not reported its mode
  std::optional<Time> poses_lost_;
  std::optional<Time> camera_lost_;
  std::optional<Time> disobeys_since_;
  std::optional<Time> beyond_since_;         // following demands more than the limits
  Eigen::Vector3d velocity_trend_{0, 0, 0};  // the UAV's velocity through a low pass
  Eigen::Vector2d place_{0, 0};
  std::optional<SetPoint> sent_;
};

}  // namespace kestrel
