// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
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

// The team's map, seen by one UAV.
struct TeamView {
  // In the UAV's own world, on its own clock; those that move at the time of the view. Ids count
  // from 1.
  std::vector<MappedObject> objects;
  std::map<ObjectRef, std::size_t> index;  // index in 'objects' of the UAVs' objects
  // Holder of each object: the UAV that is alive and claims it with the highest bid; of equal bids
  // the first by key.
  std::vector<std::optional<UavKey>> holders;
  std::vector<bool> is_gone;  // whether each object was taken, and not seen since
  // Transforms from the UAVs' worlds to the common one, as far as they are known.
  std::map<UavKey, WorldAlignment> common_from_world;
};

// Joins the maps of all UAVs. 'fusion' belongs to this member, and remembers what does not change.
TeamView ViewTeam(const TeamMember& member, Time local, TeamFusion* fusion);

// Returns the objects of the view, in the UAV's own world and on its own clock.
std::vector<TeamObject> OwnMap(const TeamView& view);

// Returns the objects of the view, which 'fusion' made, in the common world; their times mean
// nothing. Members that hold the same get the same, to the last bit: a moving object is where the
// UAV that knows it best saw it.
std::vector<TeamObject> CommonMap(const TeamMember& member, const TeamView& view,
                                  const TeamFusion& fusion);

// Returns whether an object of the view, by its index, may be chosen.
using ObjectFilter = std::function<bool(std::size_t)>;

// Chooses an object for the UAV at 'position' (in its own world), and claims it: the one with the
// most value for its distance that nobody else holds and nobody has taken. It keeps its object
// until that is gone or somebody bids more. Returns the index in the view; nothing when no object
// is left.
std::optional<std::size_t> ChooseObject(
    const TeamView& view, const Eigen::Vector3d& position, const ObjectModel& model, Time local,
    TeamMember* member, const ObjectFilter& may_choose = [](std::size_t) { return true; });

}  // namespace kestrel
