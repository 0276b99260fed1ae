// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <limits>
#include <optional>
#include <string>

#include <Eigen/Core>

#include "kestrel/core/base/time.h"
#include "kestrel/core/geometry/rigid_transform.h"
#include "kestrel/core/poses/set_point.h"
#include "kestrel/flight/guidance/contact_detector.h"
#include "kestrel/flight/guidance/flight_limits.h"
#include "kestrel/flight/guidance/flight_model.h"
#include "kestrel/flight/guidance/following_demand.h"
#include "kestrel/flight/guidance/guidance_options.h"
#include "kestrel/flight/guidance/guidance_phase.h"
#include "kestrel/flight/guidance/guidance_request.h"
#include "kestrel/flight/guidance/road_memory.h"
#include "kestrel/flight/guidance/stale_safety.h"
#include "kestrel/flight/guidance/stay_on_deck.h"
#include "kestrel/flight/guidance/target_pursuit.h"
#include "kestrel/flight/guidance/target_search.h"
#include "kestrel/flight/guidance/touchdown_heading.h"
#include "kestrel/flight/guidance/touchdown_timing.h"
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

// All inputs of guidance at an instant.
struct GuidanceInput {
  Time now;                              // never earlier than the one before
  std::optional<UavState> uav;           // predicted to now; nothing when the poses have stopped
  std::optional<TargetEstimate> target;  // predicted to now; nothing while there is none, or lost
  // Time since the newest frame that showed the target was taken, s.
  double target_age_s = std::numeric_limits<double>::infinity();
  std::optional<DeckSighting> deck;  // the newest frame that showed it
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

// Flies a multicopter to a moving target and down onto it by set-points. A state machine without
// clock, socket or thread: everything that happens is in the inputs. docs/guidance.md describes its
// phases and its reaction to each loss.
//
// It begins when is_guided turns true and ends when it turns false. To begin again, the pilot must
// leave the mode and give it anew.
class LandingGuidance {
 public:
  // 'place': where the vehicle should pass (m, world); nothing: where guidance begins. Throws
  // InputError when the options are not valid.
  explicit LandingGuidance(const GuidanceOptions& options,
                           const std::optional<Eigen::Vector2d>& place = std::nullopt);

  // Call it at 20 Hz or more, in order of time.
  GuidanceOutput Update(const GuidanceInput& input);

  // With stream_before_start: sends set-points of standing still again before the mode is given.
  // After the pilot has left the mode none are sent until this is called, because PX4 would go back
  // to OFFBOARD by itself. No effect while guidance flies.
  void Rearm();

  // Sets the middle of the geofence (m, world), instead of the place where guidance begins.
  void SetFenceCenter(const Eigen::Vector2d& center);

  GuidancePhase phase() const { return phase_; }
  // True from when it gives up, or refuses to begin in the air, until the mode is left.
  bool has_given_up() const { return has_given_up_; }
  int go_arounds() const { return go_arounds_; }  // number of times it climbed again
  // Part of the limits that following the target takes, the largest of the last seconds.
  const FollowingDemand& demand() const { return demand_.demand(); }
  // TouchdownHeading::error.
  const std::optional<double>& heading_error() const { return heading_.error(); }
  // Wind, drag and the autopilot's answer, as learnt in flight.
  const FlightModel& model() const { return model_; }

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

  // Beginning and end.
  void FollowMode(const GuidanceInput& input);
  void Start(const GuidanceInput& input);
  void End(const char* reason);
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
  SetPoint Search(const GuidanceInput& input, const Situation& now);
  SetPoint Pursue(const GuidanceInput& input, const Situation& now);
  double ClimbRate(const GuidanceInput& input, const Situation& now);
  std::optional<double> WaitHeight(Time now, double height_m);
  GuidanceOutput Output(const std::optional<SetPoint>& set_point, GuidanceRequest request) const;

  // Choice of the phase.
  Situation Look(const GuidanceInput& input) const;
  void ChoosePhase(const GuidanceInput& input, const Situation& now);
  void ChooseAbove(const Situation& now);
  bool MayDescend(const Situation& now) const;
  void ChooseDescent(const GuidanceInput& input, const Situation& now);
  bool FindContact(const GuidanceInput& input, const Situation& now);
  void Enter(GuidancePhase phase, const char* reason);
  void GoAround(const char* reason);
  double Cone(double height_m) const;
  bool IsLow() const;  // in a phase that descends

  GuidanceOptions options_;
  bool has_place_;
  bool has_fence_center_ = false;
  FlightLimits limits_;
  FlightModel model_;
  StaleSafety stale_;
  TargetPursuit pursuit_;
  RoadMemory road_;
  TargetSearch search_;
  DemandWatch demand_;
  ContactDetector contact_;
  StayOnDeck stay_;
  TouchdownTiming timing_;
  TouchdownHeading heading_;

  GuidancePhase phase_ = GuidancePhase::kIdle;
  const char* reason_;
  int go_arounds_ = 0;
  Time entered_;  // time at which the phase began
  bool is_active_ = false;
  bool has_given_up_ = false;  // requests hold while it has the mode
  bool may_stream_;
  std::optional<bool> was_guided_;         // nothing: not reported yet
  Time last_;                              // time of the last update
  std::optional<Time> link_lost_;          // since when there is no link
  std::optional<Time> mode_wanted_since_;  // since then the autopilot has not reported its mode
  std::optional<Time> poses_lost_;
  std::optional<Time> camera_lost_;
  std::optional<Time> disobeys_since_;
  std::optional<Time> beyond_since_;         // following demands more than the limits
  Eigen::Vector3d velocity_trend_{0, 0, 0};  // the UAV's velocity through a low pass
  std::optional<Time> contact_since_;
  Eigen::Vector2d place_{0, 0};  // where the vehicle was last, or should pass
  std::optional<SetPoint> sent_;
};

}  // namespace kestrel
