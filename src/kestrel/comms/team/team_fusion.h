// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "kestrel/comms/team/team_map.h"
#include "kestrel/comms/team/team_options.h"
#include "kestrel/comms/team/world_alignment.h"
#include "kestrel/vision/mapping/mapped_object.h"
#include "kestrel/vision/mapping/object_map.h"

namespace kestrel {

// Fuses the standing objects of a team's maps into one map in the common world: that of the first
// UAV by key whose map is at least half as large as the largest. Worlds that can be aligned with
// each other, directly or through others, form a group. If there are several groups, the common
// world is that of the first UAV of the group with the most objects. Every other world is aligned
// with the first placed one for which the alignment is beyond doubt; if there is none, with the one
// for which most objects agree. A world that cannot be aligned is taken for the common one, with
// less certainty: its objects are matched with those that are there already, and only the rest is
// added. The result is a function of the maps alone: all that hold the same maps get the same
// result, to the last bit.
//
// Unchanged parts are not computed again: alignments are kept by pair, the fused maps in a binary
// tree, in which only the branch of a changed map is redone.
class TeamFusion {
 public:
  TeamFusion(const TeamOptions& team, const ObjectMapOptions& options);

  // 'map': the same one in every call. UAVs with empty maps are ignored.
  void Update(const TeamMap& map);

  const ObjectMapOptions& options() const { return options_; }

  // Position and certainty are those of their UAVs' maps; times are on several clocks.
  const std::vector<MappedObject>& standing() const;
  // Returns the index in standing() of each standing object of a UAV's map, by their ids.
  std::vector<std::size_t> IndicesOf(const UavKey& uav) const;

  // True when the position of the UAV's world is known.
  bool IsPlaced(const UavKey& uav) const;
  // Transform from the UAV's world to the common one; its uncertainty is in the covariance.
  const WorldAlignment& CommonFromWorld(const UavKey& uav) const;

 private:
  struct Part {
    std::uint64_t revision = 0;         // revision of the map's part that these are from
    std::vector<MappedObject> objects;  // standing ones, by id, in the UAV's own world
    bool is_placed = false;
    WorldAlignment common_from_world;
    bool is_changed = true;            // since the last fusion
    std::size_t leaf = 0;              // if the UAV is placed
    std::vector<std::size_t> indices;  // in standing_, if the UAV is not placed
  };
  struct Pair {
    std::uint64_t revision = 0;
    std::uint64_t reference_revision = 0;
    std::optional<FoundAlignment> found;
  };
  // A UAV that waits to be placed in a group, or is placed: in the world of the group's first UAV.
  struct Place {
    UavKey uav;
    std::size_t matches = 0;  // matches of the best alignment with a UAV of the group; 0: none
    WorldAlignment group_from_world;
  };
  using Group = std::vector<Place>;
  // The children of node i are 2 i and 2 i + 1; the leaves are the last half.
  struct Node {
    std::vector<MappedObject> objects;    // objects of its subtree; a leaf has none
    std::vector<std::size_t> from_right;  // where the objects of the second child are
    bool is_changed = true;
  };

  void Take(const TeamMap::Part& reported, Part* part) const;
  void PlaceAll();
  Group ChooseCommonGroup();
  Group TakeGroup(std::vector<Place>* waiting);
  std::size_t CountObjects(const std::vector<Place>& places) const;
  void Align(const Place& reference, Place* waiting);
  static void SetWorld(const WorldAlignment& common_from_world, bool is_placed, Part* part);
  void FuseAll();
  void FuseChildren(std::size_t node);
  void FuseAdrift();

  ObjectMapOptions options_;
  WorldPrior prior_;
  std::map<UavKey, Part> parts_;
  std::map<std::pair<UavKey, UavKey>, Pair> pairs_;  // a UAV, and the one with which it is aligned
  std::vector<UavKey> order_;                        // order of the leaves, one for each placed UAV
  std::vector<UavKey> fused_order_;
  std::vector<Node> nodes_;
  std::vector<MappedObject> standing_;
};

}  // namespace kestrel
