// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include <Eigen/Core>

#include "kestrel/core/base/time.h"
#include "kestrel/flight/guidance/guidance_options.h"
#include "kestrel/flight/guidance/road_memory.h"
#include "kestrel/flight/guidance/search_path.h"

namespace kestrel {

// Search for a target. One that was never seen is waited for at a place. One that was lost is first
// expected where its road leads; once the UAV's way there and the camera's view are too short for
// what is uncertain, it is waited for on its lap or where it was lost, and then searched for on a
// spiral around the place; after a while the search is over.
class TargetSearch {
 public:
  explicit TargetSearch(const GuidanceOptions& options) : options_(options), spiral_(options) {}

  // Begins for a target that was never seen and should pass at 'place' (m, world).
  void Start(const Eigen::Vector2d& place);
  // Begins for a target that was lost at 'place': 'road' is its way until now.
  void StartAfterLoss(Time now, const RoadMemory& road, const Eigen::Vector2d& place);

  // Returns the place to be at now. 'seconds': since the last call.
  Eigen::Vector2d Advance(Time now, const RoadMemory& road, const Eigen::Vector2d& uav,
                          double seconds);

  // True once the target was not found for the time set in the options.
  bool IsOver(Time now) const;
  // Present step of the search, for the user; a literal.
  const char* step() const { return step_; }

 private:
  bool HasMissed(Time now, const RoadMemory::Prediction& target, const RoadMemory& road,
                 const Eigen::Vector2d& uav) const;

  GuidanceOptions options_;
  SearchPath spiral_;
  std::optional<Time> lost_;  // nothing: the target was never seen
  Eigen::Vector2d lost_at_{0, 0};
  double waited_s_ = 0;
  bool is_on_road_ = false;  // expects the target where its road leads
  const char* step_ = "";
};

}  // namespace kestrel
