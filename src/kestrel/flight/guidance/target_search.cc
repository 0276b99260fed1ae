// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/guidance/target_search.h"

namespace kestrel {
namespace {

using Eigen::Vector2d;

// The camera sees the target within so many metres per metre of altitude. A target is expected
// within two standard deviations.
constexpr double kView = 1;
constexpr double kSigmas = 2;
constexpr double kLapsOnRoad = 1;  // follows a lap in the mind for no longer

}  // namespace

void TargetSearch::Start(const Vector2d& place) {
  lost_.reset();
  waited_s_ = 0;
  is_on_road_ = false;
  step_ = "";
  spiral_.Start(place, {.wait_s = options_.search_wait_s, .radius_m = options_.search_radius_m});
}

void TargetSearch::StartAfterLoss(Time now, const RoadMemory& road, const Vector2d& place) {
  Start(place);
  lost_ = now;
  lost_at_ = place;
  const auto target = road.Predict(now);
  is_on_road_ = target.has_value();
  if (!is_on_road_) return;
  step_ = target->is_by_lap ? "the target is lost: flies where its last lap leads"
                            : "the target is lost: flies on as it drove";
}

Vector2d TargetSearch::Advance(Time now, const RoadMemory& road, const Vector2d& uav,
                               double seconds) {
  if (is_on_road_) {
    const auto target = road.Predict(now);
    if (target && !HasMissed(now, *target, road, uav)) return target->position;
    is_on_road_ = false;
    if (target && target->is_by_lap) {
      step_ = "waits for the target on its road";
      spiral_.Start(target->position,
                    {.wait_s = *road.Lap_s(), .radius_m = options_.search_radius_m});
    } else {
      // A target that is not where it drove to has turned; on a lap it comes back to this place,
      // and a second pass shows the lap.
      step_ = "waits where the target was lost, then searches around the place";
      spiral_.Start(lost_at_,
                    {.wait_s = options_.search_wait_s, .radius_m = options_.search_distance_m});
    }
  }
  waited_s_ += seconds;
  if (!lost_ && options_.search_radius_m == 0 && waited_s_ > options_.search_wait_s) {
    step_ = "the target does not come into sight; stays here, as search_radius_m is 0";
  }
  return spiral_.Advance(uav, seconds);
}

// A UAV that still has to catch up with the place has not missed the target there, as long as its
// way is longer than what is uncertain.
bool TargetSearch::HasMissed(Time now, const RoadMemory::Prediction& target, const RoadMemory& road,
                             const Vector2d& uav) const {
  if (target.is_by_lap && ToSeconds(now - *lost_) > kLapsOnRoad * *road.Lap_s()) return true;
  if ((target.position - lost_at_).norm() > options_.search_distance_m) return true;
  const double view_m = kView * options_.search_altitude_m;
  return kSigmas * target.sigma_m > view_m + (target.position - uav).norm();
}

bool TargetSearch::IsOver(Time now) const {
  return lost_ && ToSeconds(now - *lost_) > options_.search_limit_s;
}

}  // namespace kestrel
