// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/comms/team/team_view.h"

#include <algorithm>
#include <chrono>

#include "kestrel/vision/mapping/object_fusion.h"

namespace kestrel {
namespace {

// Returns the difference to add to times of the UAV's clock for times of the clock that shows 'now'
// at 'local'.
Duration ShiftOf(const TeamMap::Part& part, Time local, Time now) {
  const Duration since_sent = std::max(local - part.sent_at, Duration::zero());
  return now - since_sent - part.contents.now;
}

// Returns the moving objects of a UAV's map, at 'now' and in the common world.
std::vector<MappedObject> MovingObjects(const TeamMap::Part& part, Duration shift, Time now,
                                        const ObjectMotion& motion,
                                        const WorldAlignment& common_from_world) {
  std::vector<MappedObject> moving;
  for (const auto& [id, entry] : part.objects) {
    if (!entry.object.may_move) continue;
    MappedObject& object = moving.emplace_back(entry.object);
    for (Time* time : {&object.time, &object.first_seen, &object.last_seen}) *time += shift;
    PredictObject(now, motion, &object);
    MoveToWorld(common_from_world, &object);
  }
  return moving;
}

// Fills the index of the UAV's objects in the view; widens the time in which standing objects were
// seen.
void Index(const UavKey& uav, const TeamMap::Part& part, Duration shift,
           const std::vector<std::size_t>& standing, const std::vector<std::size_t>& moving,
           TeamView* view) {
  auto next_standing = standing.begin();
  auto next_moving = moving.begin();
  for (const auto& [id, entry] : part.objects) {
    const std::size_t index = entry.object.may_move ? *next_moving++ : *next_standing++;
    view->index.emplace_hint(view->index.end(), ObjectRef{uav, id}, index);
    if (entry.object.may_move) continue;
    MappedObject& object = view->objects[index];
    object.first_seen = std::min(object.first_seen, entry.object.first_seen + shift);
    object.last_seen = std::max(object.last_seen, entry.object.last_seen + shift);
  }
}

// Finds the holder of each claimed object.
void FindHolders(const TeamMember& member, Time local, TeamView* view) {
  view->holders.resize(view->objects.size());
  std::vector<double> bids(view->objects.size());
  for (const UavKey& uav : member.Known()) {
    const std::optional<Claim> claim = member.ClaimOf(uav, local);
    if (!claim) continue;
    const auto object = view->index.find(claim->object);
    if (object == view->index.end()) continue;
    std::optional<UavKey>& holder = view->holders[object->second];
    if (holder && bids[object->second] >= claim->bid) continue;
    holder = uav;
    bids[object->second] = claim->bid;
  }
}

// Finds the objects that were taken. One that is seen long after that is there all the same: the
// eyes of a UAV see it for a moment after somebody else has declared it taken.
void FindGone(const TeamMember& member, Time local, Time now, TeamView* view) {
  constexpr Duration kSeenAfter = std::chrono::seconds(3);
  view->is_gone.resize(view->objects.size());
  for (const TeamMember::Gone& gone : member.AllGone()) {
    const auto found = view->index.find(gone.object);
    if (found == view->index.end()) continue;
    const std::size_t i = found->second;
    if (now - view->objects[i].last_seen + kSeenAfter > local - gone.since) view->is_gone[i] = true;
  }
}

}  // namespace

TeamView ViewTeam(const TeamMember& member, Time local, TeamFusion* fusion) {
  const TeamMap& map = member.map();
  const TeamMap::Part* const own = map.Find(member.self());
  const Time now =
      own == nullptr ? local : own->contents.now + std::max(local - own->sent_at, Duration::zero());
  fusion->Update(map);
  TeamView view;
  view.objects = fusion->standing();
  for (MappedObject& object : view.objects) {
    object.first_seen = Time::max();
    object.last_seen = Time::min();
  }
  std::vector<MappedObject> moving;
  for (const auto& [uav, part] : map.parts()) {
    if (part.objects.empty()) continue;
    const WorldAlignment& alignment = fusion->CommonFromWorld(uav);
    if (fusion->IsPlaced(uav)) view.common_from_world.emplace(uav, alignment);
    const ObjectMapOptions& options = fusion->options();
    const Duration shift = ShiftOf(part, local, now);
    std::vector<std::size_t> indices =
        FuseObjects(MovingObjects(part, shift, now, options.motion(), alignment), &moving);
    for (std::size_t& index : indices) index += fusion->standing().size();
    Index(uav, part, shift, fusion->IndicesOf(uav), indices, &view);
  }
  view.objects.insert(view.objects.end(), moving.begin(), moving.end());
  const auto common_from_own = view.common_from_world.find(member.self());
  if (common_from_own != view.common_from_world.end()) {
    WorldAlignment own_from_common = common_from_own->second.Inverse();
    own_from_common.covariance.setZero();  // errors of both ways are the same
    for (MappedObject& object : view.objects) MoveToWorld(own_from_common, &object);
  }
  for (std::size_t i = 0; i < view.objects.size(); ++i) {
    view.objects[i].id = static_cast<std::int64_t>(i) + 1;
    view.objects[i].time = now;
  }
  FindHolders(member, local, &view);
  FindGone(member, local, now, &view);
  return view;
}

std::vector<TeamObject> OwnMap(const TeamView& view) {
  std::vector<TeamObject> objects(view.objects.size());
  for (std::size_t i = 0; i < objects.size(); ++i) {
    objects[i].object = view.objects[i];
    if (view.holders[i]) objects[i].holder = view.holders[i]->name;
  }
  for (const auto& [ref, i] : view.index) {
    // Two runs of one UAV have the same name.
    std::vector<std::string>& uavs = objects[i].uavs;
    if (uavs.empty() || uavs.back() != ref.uav.name) uavs.push_back(ref.uav.name);
  }
  return objects;
}

std::vector<TeamObject> CommonMap(const TeamMember& member, const TeamView& view,
                                  const TeamFusion& fusion) {
  std::vector<TeamObject> objects = OwnMap(view);
  const std::vector<MappedObject>& standing = fusion.standing();
  for (std::size_t i = 0; i < standing.size(); ++i) objects[i].object = standing[i];
  std::vector<bool> is_found(objects.size());  // for objects that move
  for (const auto& [ref, i] : view.index) {
    if (i < standing.size()) continue;
    const MappedObject& reported = member.map().Find(ref.uav)->objects.at(ref.id).object;
    if (is_found[i] && reported.sigma_m() >= objects[i].object.sigma_m()) continue;
    is_found[i] = true;
    objects[i].object = reported;
    MoveToWorld(fusion.CommonFromWorld(ref.uav), &objects[i].object);
  }
  for (std::size_t i = 0; i < objects.size(); ++i) {
    objects[i].object.id = static_cast<std::int64_t>(i) + 1;
  }
  return objects;
}

std::optional<std::size_t> ChooseObject(const TeamView& view, const Eigen::Vector3d& position,
                                        const ObjectModel& model, Time local, TeamMember* member,
                                        const ObjectFilter& may_choose) {
  const UavKey& self = member->self();
  if (const auto claim = member->ClaimOf(self, local)) {
    const auto held = view.index.find(claim->object);
    if (held != view.index.end() && view.holders[held->second] == self &&
        !view.is_gone[held->second] && may_choose(held->second)) {
      return held->second;
    }
  }
  std::optional<Claim> best;
  std::optional<std::size_t> chosen;
  for (const auto& [ref, i] : view.index) {
    if (view.holders[i] && view.holders[i] != self) continue;
    if (view.is_gone[i] || !may_choose(i)) continue;
    // The metre limits the weight of distance: among near objects the value decides.
    const double bid =
        ScoreOf(view.objects[i], model) / (1 + (view.objects[i].position() - position).norm());
    if (!(bid > 0) || (best && best->bid >= bid)) continue;
    best = Claim{ref, bid};
    chosen = i;
  }
  member->SetClaim(best);
  return chosen;
}

}  // namespace kestrel
