// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "kestrel/comms/team/team_fusion.h"
#include "kestrel/comms/team/team_member.h"
#include "kestrel/comms/team/world_alignment.h"
#include "kestrel/core/base/time.h"
#include "kestrel/vision/mapping/object_map.h"
#include "kestrel/vision/mapping/team_object.h"
#include "kestrel/vision/objects/object_model.h"

namespace kestrel {

// The team's map as one UAV sees it.
struct TeamView {
  // In the UAV's own world, on its own clock and, if they move, at the time for which the view was
  // made; ids count from 1.
  std::vector<MappedObject> objects;
  std::map<ObjectRef, std::size_t> index;  // of the UAVs' objects in 'objects'
  // Who goes for each of them: of those alive that claim it the highest bid, of equal ones the
  // first by key.
  std::vector<std::optional<UavKey>> holders;
  // From the worlds of the UAVs to the common one; not of those of which it is not known yet.
  std::map<UavKey, WorldAlignment> common_from_world;
};

// All UAVs' maps as one. 'fusion' is this member's own, which remembers what does not change.
TeamView ViewTeam(const TeamMember& member, Time local, TeamFusion* fusion);

// The objects of the view: in the UAV's own world and on its own clock.
std::vector<TeamObject> OwnMap(const TeamView& view);

// The objects of the view, which 'fusion' made, in the common world; their times mean nothing. All
// that hold the same have the same to the last bit: what moves is where that UAV saw it that knows
// it best.
std::vector<TeamObject> CommonMap(const TeamMember& member, const TeamView& view,
                                  const TeamFusion& fusion);

// Chooses what the UAV at 'position' (in its own world) goes for, and claims it: the object with
// the most value for its distance that nobody else holds. It keeps what it has until that is gone
// or somebody bids more. The index in the view; nothing when there is no object left.
std::optional<std::size_t> ChooseObject(const TeamView& view, const Eigen::Vector3d& position,
                                        const ObjectModel& model, Time local, TeamMember* member);

}  // namespace kestrel
