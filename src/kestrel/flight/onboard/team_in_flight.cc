// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/onboard/team_in_flight.h"

#include <chrono>

namespace kestrel {

TeamInFlight InFlight(const TeamGoal& goal) {
  TeamInFlight team{goal.time, goal.rank, {}};
  for (const TeamMate& mate : goal.mates) {
    team.others.push_back({mate.position.head<2>(), mate.velocity.head<2>(), mate.goes_first});
  }
  return team;
}

FlightToObjects ToObjects(const GuidedFlight& guided, const PoseHistory& poses, Time now,
                          const FlightToObjects& before) {
  constexpr Duration kAge = std::chrono::milliseconds(500);
  const ObjectEnd ended = guided.ended();
  FlightToObjects flight{.at = {},
                         .wants_object = guided.wants_object(),
                         .ended = ended.mark,
                         .has_taken = ended.is_taken};
  if (!guided.is_in_air()) return flight;
  if (const auto pose = poses.Predict(now, kAge, UnmodelledMotion())) {
    flight.at = UavFlight{pose->world_from_body.translation, pose->motion.velocity_in_world,
                          guided.is_at_work()};
  } else if (before.at) {
    flight.at = UavFlight{before.at->position, {0, 0, 0}, guided.is_at_work()};
  }
  return flight;
}

}  // namespace kestrel
