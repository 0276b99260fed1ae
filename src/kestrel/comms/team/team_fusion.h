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

// What stands in the maps of a team, as one map in the common world: that of the first UAV by key
// whose map is at least half as large as the largest. Of several groups of UAVs whose worlds can be
// aligned with each other, by whatever way, but not with those of another group, it is the first of
// the group with the most objects. Every other world is aligned with the first of those already
// placed with which that is beyond doubt, or, where it is with none, with that with which most
// objects agree. A world that cannot be aligned is taken for the common one, less surely: its
// objects are laid onto those that are there already, and only what is left is put beside them. A
// function of what the maps hold: all that hold the same see the same, to the last bit.
//
// What has not changed since the last call is not worked out again: alignments are kept by pair,
// and the fused maps in a binary tree, of which a map that has changed redoes its branch.
class TeamFusion {
 public:
  TeamFusion(const TeamOptions& team, const ObjectMapOptions& options);

  // 'map': the same one with every call. UAVs whose maps are empty are none here.
  void Update(const TeamMap& map);

  const ObjectMapOptions& options() const { return options_; }

  // Each where and as surely as its UAVs told it; times are those of several clocks.
  const std::vector<MappedObject>& standing() const;
  // Of the standing objects of a UAV's map, by their ids: the index of each in standing().
  std::vector<std::size_t> IndicesOf(const UavKey& uav) const;

  // Whether it is known where the UAV's world lies.
  bool IsPlaced(const UavKey& uav) const;
  // From the UAV's world to the common one, with what is not known of it in the covariance.
  const WorldAlignment& CommonFromWorld(const UavKey& uav) const;

 private:
  struct Part {
    std::uint64_t revision = 0;         // of the told map that this is
    std::vector<MappedObject> objects;  // that stand, by id, in the UAV's own world
    bool is_placed = false;
    WorldAlignment common_from_world;
    bool is_changed = true;            // since it was fused
    std::size_t leaf = 0;              // if it is placed
    std::vector<std::size_t> indices;  // in standing_, if it is not
  };
  struct Pair {
    std::uint64_t revision = 0;
    std::uint64_t reference_revision = 0;
    std::optional<FoundAlignment> found;
  };
  // A UAV that waits to be placed in a group, or is: in the world of the group's first.
  struct Place {
    UavKey uav;
    std::size_t matches = 0;  // of the best alignment with one of the group; 0: there is none
    WorldAlignment group_from_world;
  };
  using Group = std::vector<Place>;
  // The children of node i are 2 i and 2 i + 1; the leaves are the last half.
  struct Node {
    std::vector<MappedObject> objects;    // of a leaf none: those of its part
    std::vector<std::size_t> from_right;  // where those of the second child are
    bool is_changed = true;
  };

  void Take(const TeamMap::Part& told, Part* part) const;
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
  std::map<std::pair<UavKey, UavKey>, Pair> pairs_;  // a UAV, and the one it is aligned with
  std::vector<UavKey> order_;                        // of the leaves: those that are placed
  std::vector<UavKey> fused_order_;
  std::vector<Node> nodes_;
  std::vector<MappedObject> standing_;
};

}  // namespace kestrel
