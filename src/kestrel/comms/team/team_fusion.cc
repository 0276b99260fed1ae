// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/comms/team/team_fusion.h"

#include <algorithm>
#include <bit>
#include <numeric>

#include "kestrel/core/geometry/angles.h"
#include "kestrel/vision/mapping/object_fusion.h"

namespace kestrel {
namespace {

// Number of objects that never agree on an alignment by chance.
constexpr std::size_t kBeyondDoubt = 7;

std::vector<MappedObject> Moved(std::vector<MappedObject> objects, const WorldAlignment& to) {
  for (MappedObject& object : objects) MoveToWorld(to, &object);
  return objects;
}

}  // namespace

TeamFusion::TeamFusion(const TeamOptions& team, const ObjectMapOptions& options)
    : options_(options), prior_{team.world_sigma_m, Radians(team.world_yaw_sigma_deg)}, nodes_(4) {}

void TeamFusion::Update(const TeamMap& map) {
  bool has_changed = false;
  for (const auto& [uav, reported] : map.parts()) {
    if (reported.objects.empty()) {
      has_changed |= parts_.erase(uav) != 0;
      continue;
    }
    Part& part = parts_[uav];
    if (part.revision == reported.revision) continue;
    Take(reported, &part);
    has_changed = true;
  }
  if (!has_changed) return;
  PlaceAll();
  FuseAll();
  FuseAdrift();
}

void TeamFusion::Take(const TeamMap::Part& reported, Part* part) const {
  part->revision = reported.revision;
  part->is_changed = true;
  part->objects.clear();
  for (const auto& [id, entry] : reported.objects) {
    if (entry.object.may_move) continue;
    part->objects.push_back(entry.object);
    PredictObject(reported.contents.now, options_.motion(), &part->objects.back());
  }
}

void TeamFusion::PlaceAll() {
  for (auto& [uav, part] : parts_) part.is_placed = false;
  order_.clear();
  for (const Place& place : ChooseCommonGroup()) {
    SetWorld(place.group_from_world, true, &parts_.at(place.uav));
    order_.push_back(place.uav);
  }
  for (auto& [uav, part] : parts_) {
    if (!part.is_placed) SetWorld(UnknownAlignment(part.objects, prior_), false, &part);
  }
}

TeamFusion::Group TeamFusion::ChooseCommonGroup() {
  std::vector<Place> waiting;
  std::size_t most = 0;
  for (const auto& [uav, part] : parts_) {
    waiting.push_back({uav, 0, {}});
    most = std::max(most, part.objects.size());
  }
  // In a small map's world the others would be placed less certainly.
  std::stable_partition(waiting.begin(), waiting.end(), [&](const Place& place) {
    return 2 * parts_.at(place.uav).objects.size() >= most;
  });
  Group common;
  while (!waiting.empty() && (common.empty() || CountObjects(waiting) > CountObjects(common))) {
    Group group = TakeGroup(&waiting);
    if (common.empty() || CountObjects(group) > CountObjects(common)) common = std::move(group);
  }
  return common;
}

// Takes the first of those that wait, and all that can be aligned with it or with one already
// taken.
TeamFusion::Group TeamFusion::TakeGroup(std::vector<Place>* waiting) {
  Group group{waiting->front()};
  waiting->erase(waiting->begin());
  for (std::size_t next = 0; next < group.size(); ++next) {
    for (Place& place : *waiting) Align(group[next], &place);
    std::erase_if(*waiting, [&](const Place& place) {
      if (place.matches < kBeyondDoubt) return false;
      group.push_back(place);
      return true;
    });
    if (next + 1 < group.size()) continue;
    // Only the most certain of the doubtful ones is taken: others may be placed with more certainty
    // by it.
    const auto surest =
        std::max_element(waiting->begin(), waiting->end(),
                         [](const Place& a, const Place& b) { return a.matches < b.matches; });
    if (surest == waiting->end() || surest->matches == 0) break;
    group.push_back(*surest);
    waiting->erase(surest);
  }
  return group;
}

std::size_t TeamFusion::CountObjects(const std::vector<Place>& places) const {
  return std::accumulate(places.begin(), places.end(), std::size_t{0},
                         [&](std::size_t sum, const Place& place) {
                           return sum + parts_.at(place.uav).objects.size();
                         });
}

// Aligns with the reference, if more objects agree on that than on what was found before.
void TeamFusion::Align(const Place& reference, Place* waiting) {
  const Part& part = parts_.at(waiting->uav);
  const Part& other = parts_.at(reference.uav);
  Pair& pair = pairs_[{waiting->uav, reference.uav}];
  if (pair.revision != part.revision || pair.reference_revision != other.revision) {
    pair = {part.revision, other.revision, EstimateAlignment(part.objects, other.objects, prior_)};
  }
  if (!pair.found || pair.found->matches <= waiting->matches) return;
  waiting->matches = pair.found->matches;
  waiting->group_from_world = reference.group_from_world * pair.found->alignment;
}

void TeamFusion::SetWorld(const WorldAlignment& common_from_world, bool is_placed, Part* part) {
  part->is_placed = is_placed;
  if (part->common_from_world == common_from_world) return;
  part->common_from_world = common_from_world;
  part->is_changed = true;
}

void TeamFusion::FuseAll() {
  const std::size_t leaves = std::bit_ceil(std::max<std::size_t>(order_.size(), 2));
  const bool is_new = order_ != fused_order_;
  if (is_new) nodes_.assign(2 * leaves, {});
  for (Node& node : nodes_) node.is_changed = is_new;
  for (std::size_t i = 0; i < order_.size(); ++i) {
    Part& part = parts_.at(order_[i]);
    part.leaf = leaves + i;
    if (!is_new && !part.is_changed) continue;
    nodes_[part.leaf].is_changed = true;
    part.is_changed = false;
  }
  for (std::size_t i = leaves - 1; i > 0; --i) {
    if (nodes_[2 * i].is_changed || nodes_[2 * i + 1].is_changed) FuseChildren(i);
  }
  fused_order_ = order_;
}

void TeamFusion::FuseChildren(std::size_t node) {
  // A leaf's objects are moved when they are needed: a copy of all maps would need much memory.
  const auto objects_of = [&](std::size_t child) {
    const std::size_t leaves = nodes_.size() / 2;
    if (child < leaves) return nodes_[child].objects;
    if (child - leaves >= order_.size()) return std::vector<MappedObject>();
    const Part& part = parts_.at(order_[child - leaves]);
    return Moved(part.objects, part.common_from_world);
  };
  nodes_[node].objects = objects_of(2 * node);
  nodes_[node].from_right = FuseObjects(objects_of(2 * node + 1), &nodes_[node].objects);
  nodes_[node].is_changed = true;
}

// Objects of unplaced worlds do not change what is known, and are new only where they can match
// nothing. They come last, so that they take no place of better known ones.
void TeamFusion::FuseAdrift() {
  standing_ = nodes_[1].objects;
  for (auto& [uav, part] : parts_) {
    if (part.is_placed) continue;
    std::vector<MappedObject> fused = standing_;
    part.indices = FuseObjects(Moved(part.objects, part.common_from_world), &fused);
    standing_.insert(standing_.end(), fused.begin() + std::ssize(standing_), fused.end());
  }
}

const std::vector<MappedObject>& TeamFusion::standing() const { return standing_; }

std::vector<std::size_t> TeamFusion::IndicesOf(const UavKey& uav) const {
  const Part& part = parts_.at(uav);
  if (!part.is_placed) return part.indices;
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
