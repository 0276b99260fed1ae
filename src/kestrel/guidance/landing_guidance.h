// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "kestrel/navigation/set_point.h"
#include "kestrel/tracking/target_tracker.h"

namespace kestrel {

struct GuidanceOptions {
  double search_altitude_m = 10;  // above the world's z = 0
  // Height of the feet above the board at which it follows the vehicle before it goes down; further
  // away it flies higher, by 'glide' per metre.
  double follow_height_m = 2.5;
  double glide = 0.7;
  // Speed towards the target: in proportion to the distance, further away as fast as it can still
  // be braked.
  double position_gain = 2.5;
  double braking = 3;
  // How long before it is needed an acceleration is commanded: the attitude lags by as much.
  double lead_s = 0.12;
  // Over how long the target's velocity is smoothed: a vehicle sways on its springs, faster than a
  // UAV can follow.
  double smoothing_s = 0.5;
  // It goes down, in proportion to the height, while the target is within a cone: 'cone_m' wide on
  // the board and 'cone_slope' wider per metre of height.
  double sink_gain = 0.8;
  double max_sink_mps = 2.5;
  double touchdown_sink_mps = 0.7;
  double cone_m = 0.15;
  double cone_slope = 0.35;
  // Below this height it goes through with it.
  double commit_height_m = 0.35;
  // Where the target is known no better (standard deviation per axis) it does not go down, and
  // twice as badly it climbs.
  double max_sigma_m = 0.25;

  template <class Self, class Visitor>
  static void Visit(Self& self, Visitor&& visitor) {
    visitor("search_altitude_m", self.search_altitude_m, "m", "height above ground of the search");
    visitor("follow_height_m", self.follow_height_m, "m", "height above the board to follow in");
    visitor("glide", self.glide, "m/m", "height in approach, per metre of distance");
    visitor("position_gain", self.position_gain, "1/s", "speed towards the target per metre");
    visitor("braking", self.braking, "m/s^2", "deceleration that it counts on when far away");
    visitor("lead_s", self.lead_s, "s", "acceleration is commanded so long before it is needed");
    visitor("smoothing_s", self.smoothing_s, "s",
            "over how long the target's velocity is smoothed");
    visitor("sink_gain", self.sink_gain, "1/s", "speed of the descent per metre of height");
    visitor("max_sink_mps", self.max_sink_mps, "m/s", "fastest descent");
    visitor("touchdown_sink_mps", self.touchdown_sink_mps, "m/s", "slowest descent");
    visitor("cone_m", self.cone_m, "m", "how far off it may be at the board to go down");
    visitor("cone_slope", self.cone_slope, "m/m", "and more, per metre of height");
    visitor("commit_height_m", self.commit_height_m, "m", "below it goes through with it");
    visitor("max_sigma_m", self.max_sigma_m, "m", "known no better it does not go down");
  }
  std::vector<std::string> Validate() const;
};

enum class LandingPhase {
  kSearch,    // to the place where the vehicle should pass, or was last, and wait there
  kApproach,  // to above the target, or to follow it there
  kDescend,   // down above it
  kCommit,    // the last bit, whatever happens
};
const char* ToString(LandingPhase phase);  // "search", "approach", "descend", "commit"

// What the UAV knows of itself.
struct UavState {
  Eigen::Vector3d feet_in_world{0, 0, 0};  // middle of its feet
  Eigen::Vector3d velocity_in_world{0, 0, 0};
};

// Flies a multicopter onto a moving target by the predicted track, and nothing else. A plain
// controller, there to judge the vision:
// - horizontally, the target's smoothed velocity plus a speed towards it; the accelerations that
// these need
//   (the target's in its curve, that of closing in) are given along, so that it does not lag;
// - vertically, a height that depends on the phase.
class LandingGuidance {
 public:
  // 'place': where the vehicle should pass, m.
  LandingGuidance(const GuidanceOptions& options, const Eigen::Vector2d& place)
      : options_(options), place_(place) {}

  // 'target': at the present time, by the track; nothing while there is none or it is lost.
  SetPoint Command(const UavState& uav, const std::optional<TargetEstimate>& target);

  LandingPhase phase() const { return phase_; }
  int go_arounds() const { return go_arounds_; }  // how often it went up again

 private:
  struct Velocity {
    Time time;
    Eigen::Vector3d in_world;
  };

  SetPoint Search(const UavState& uav) const;
  Eigen::Vector3d Smoothed(const TargetEstimate& target);
  void ChoosePhase(const UavState& uav, const TargetEstimate& target);
  double ClimbRate(const UavState& uav, const TargetEstimate& target) const;
  double Cone(double height_m) const { return options_.cone_m + options_.cone_slope * height_m; }

  GuidanceOptions options_;
  Eigen::Vector2d place_;
  LandingPhase phase_ = LandingPhase::kSearch;
  int go_arounds_ = 0;
  std::optional<Velocity> smoothed_;  // of the target
};

}  // namespace kestrel
