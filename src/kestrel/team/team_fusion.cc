// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/team/team_fusion.h"

#include <algorithm>
#include <bit>
#include <numeric>

#include "kestrel/geometry/angles.h"
#include "kestrel/mapping/object_fusion.h"

namespace kestrel {
namespace {

constexpr std::size_t kCommonObjects = 3;  // that the others can be aligned with

}  // namespace

TeamFusion::TeamFusion(const TeamOptions& team, const ObjectMapOptions& options)
    : options_(options), prior_{team.world_sigma_m, Radians(team.world_yaw_sigma_deg)}, nodes_(2) {}

void TeamFusion::Update(const TeamMap& map) {
  bool has_changed = false;
  for (const auto& [uav, told] : map.parts()) {
    if (told.objects.empty()) {
      has_changed |= parts_.erase(uav) != 0;
      continue;
    }
    Part& part = parts_[uav];
    if (part.revision == told.revision) continue;
    Take(told, &part);
    has_changed = true;
  }
  if (!has_changed) return;
  order_.clear();
  if (!parts_.empty()) PlaceAll();
  FuseAll();
}

void TeamFusion::Take(const TeamMap::Part& told, Part* part) const {
  part->revision = told.revision;
  part->is_changed = true;
  part->objects.clear();
  for (const auto& [id, entry] : told.objects) {
    if (entry.object.may_move) continue;
    part->objects.push_back(entry.object);
    PredictObject(told.contents.now, options_.motion(), &part->objects.back());
  }
}

UavKey TeamFusion::ChooseCommon() const {
  const auto common = std::find_if(parts_.begin(), parts_.end(), [](const auto& part) {
    return part.second.objects.size() >= kCommonObjects;
  });
  return common == parts_.end() ? parts_.begin()->first : common->first;
}

void TeamFusion::PlaceAll() {
  order_.push_back(ChooseCommon());
  Place(order_.front(), true, {});
  std::vector<UavKey> waiting;
  for (const auto& [uav, part] : parts_) {
    if (uav != order_.front()) waiting.push_back(uav);
  }
  // One that is placed may be what the next one is placed by.
  for (std::size_t placed = 0; placed < order_.size();) {
    placed = order_.size();
    std::erase_if(waiting, [&](const UavKey& uav) {
      const auto world = FindWorld(uav, order_);
      if (!world) return false;
      Place(uav, true, *world);
      order_.push_back(uav);
      return true;
    });
  }
  for (const UavKey& uav : waiting) {
    Place(uav, false, UnknownAlignment(parts_.at(uav).objects, prior_));
    order_.push_back(uav);
  }
}

void TeamFusion::Place(const UavKey& uav, bool is_placed, const WorldAlignment& common_from_world) {
  Part& part = parts_.at(uav);
  part.is_placed = is_placed;
  if (part.common_from_world == common_from_world) return;
  part.common_from_world = common_from_world;
  part.is_changed = true;
}

std::optional<WorldAlignment> TeamFusion::FindWorld(const UavKey& uav,
                                                    const std::vector<UavKey>& placed) {
  const Part& part = parts_.at(uav);
  for (const UavKey& other : placed) {
    const Part& reference = parts_.at(other);
    Pair& pair = pairs_[{uav, other}];
    if (pair.revision != part.revision || pair.reference_revision != reference.revision) {
      pair = {part.revision, reference.revision,
              EstimateAlignment(part.objects, reference.objects, prior_)};
    }
    if (pair.alignment) return reference.common_from_world * *pair.alignment;
  }
  return std::nullopt;
}

void TeamFusion::FuseAll() {
  const std::size_t leaves = std::bit_ceil(std::max<std::size_t>(order_.size(), 1));
  const bool is_new = order_ != fused_order_;
  if (is_new) nodes_.assign(2 * leaves, {});
  for (Node& node : nodes_) node.is_changed = is_new;
  for (std::size_t i = 0; i < order_.size(); ++i) {
    Part& part = parts_.at(order_[i]);
    part.leaf = leaves + i;
    if (!is_new && !part.is_changed) continue;
    Node& leaf = nodes_[part.leaf];
    leaf.is_changed = true;
    leaf.objects = part.objects;
    for (MappedObject& object : leaf.objects) MoveToWorld(part.common_from_world, &object);
    part.is_changed = false;
  }
  for (std::size_t i = leaves - 1; i > 0; --i) {
    if (nodes_[2 * i].is_changed || nodes_[2 * i + 1].is_changed) FuseChildren(i);
  }
  fused_order_ = order_;
}

void TeamFusion::FuseChildren(std::size_t node) {
  nodes_[node].objects = nodes_[2 * node].objects;
  nodes_[node].from_right =
      FuseObjects(nodes_[2 * node + 1].objects, options_, &nodes_[node].objects);
  nodes_[node].is_changed = true;
}

const std::vector<MappedObject>& TeamFusion::standing() const { return nodes_[1].objects; }

std::vector<std::size_t> TeamFusion::IndicesOf(const UavKey& uav) const {
  const Part& part = parts_.at(uav);
  std::vector<std::size_t> indices(part.objects.size());
  std::iota(indices.begin(), indices.end(), std::size_t{0});
  for (std::size_t node = part.leaf; node > 1; node /= 2) {
    if (node % 2 == 0) continue;
    for (std::size_t& index : indices) index = nodes_[node / 2].from_right[index];
  }
  return indices;
}

bool TeamFusion::IsPlaced(const UavKey& uav) const { return parts_.at(uav).is_placed; }

const WorldAlignment& TeamFusion::CommonFromWorld(const UavKey& uav) const {
  return parts_.at(uav).common_from_world;
}

}  // namespace kestrel
