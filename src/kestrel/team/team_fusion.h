// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "kestrel/mapping/mapped_object.h"
#include "kestrel/mapping/object_map.h"
#include "kestrel/team/team_map.h"
#include "kestrel/team/team_options.h"
#include "kestrel/team/world_alignment.h"

namespace kestrel {

// What stands in the maps of a team, as one map in the common world: that of the first UAV by key
// with three such objects, or, where none has as many, of the first. Every other world is aligned
// with the first of those already placed with which that is sure; worlds with which it is not are
// taken for the common one, less surely. A function of what the maps hold: all that hold the same
// see the same, to the last bit.
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
    bool is_changed = true;  // since it was fused
    std::size_t leaf = 0;
  };
  struct Pair {
    std::uint64_t revision = 0;
    std::uint64_t reference_revision = 0;
    std::optional<WorldAlignment> alignment;
  };
  // The children of node i are 2 i and 2 i + 1; the leaves are the last half.
  struct Node {
    std::vector<MappedObject> objects;
    std::vector<std::size_t> from_right;  // where those of the second child are
    bool is_changed = true;
  };

  void Take(const TeamMap::Part& told, Part* part) const;
  UavKey ChooseCommon() const;
  void PlaceAll();
  void Place(const UavKey& uav, bool is_placed, const WorldAlignment& common_from_world);
  std::optional<WorldAlignment> FindWorld(const UavKey& uav, const std::vector<UavKey>& placed);
  void FuseAll();
  void FuseChildren(std::size_t node);

  ObjectMapOptions options_;
  WorldPrior prior_;
  std::map<UavKey, Part> parts_;
  std::map<std::pair<UavKey, UavKey>, Pair> pairs_;  // a UAV, and the one it is aligned with
  std::vector<UavKey> order_;                        // of the leaves
  std::vector<UavKey> fused_order_;
  std::vector<Node> nodes_;
};

}  // namespace kestrel
