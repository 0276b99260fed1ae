// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/comms/team/team_goal.h"

#include <algorithm>
#include <utility>

namespace kestrel {
namespace {

bool HaveCommon(const std::vector<ObjectRef>& a, const std::vector<ObjectRef>& b) {
  return std::ranges::any_of(
      a, [&](const ObjectRef& ref) { return std::ranges::find(b, ref) != b.end(); });
}

// The objects of all maps that are this one of the view.
std::vector<ObjectRef> NamesOf(const TeamView& view, std::size_t index) {
  std::vector<ObjectRef> names;
  for (const auto& [ref, i] : view.index) {
    if (i == index) names.push_back(ref);
  }
  return names;
}

// Returns the transform from the world of a UAV to the own one; as far as it is not known the two
// are one.
WorldAlignment OwnFromWorld(const TeamView& view, const UavKey& self, const UavKey& uav) {
  const auto own = view.common_from_world.find(self);
  const auto other = view.common_from_world.find(uav);
  if (own == view.common_from_world.end() || other == view.common_from_world.end()) return {};
  return own->second.Inverse() * other->second;
}

}  // namespace

const TeamGoal& GoalChooser::Update(const TeamView& view, const FlightToObjects& flight, Time local,
                                    TeamMember* member) {
  const bool is_at_work = flight.at && flight.at->is_at_work;
  FindMates(view, flight, local, *member);
  if (!flight.at) left_.clear();
  if (!names_.empty() && flight.ended == numbers_) Leave(flight.has_taken, local, member);
  if (!flight.at || !flight.wants_object) {
    member->SetClaim(std::nullopt);
    goal_.number = 0;
    return goal_;
  }
  // Near by the camera sees an object hardly, and the map may lose it for a moment.
  const auto claim = member->ClaimOf(member->self(), local);
  if (is_at_work && claim && !view.index.contains(claim->object)) return goal_;
  const auto chosen =
      ChooseObject(view, flight.at->position, model_, local, member,
                   [&](std::size_t i) { return MayChoose(view, i, member->self()); });
  if (chosen) {
    Take(view, *chosen, member->self());
  } else {
    goal_.number = 0;
  }
  return goal_;
}

void GoalChooser::Take(const TeamView& view, std::size_t index, const UavKey& self) {
  std::vector<ObjectRef> names = NamesOf(view, index);
  if (!HaveCommon(names, names_)) ++numbers_;
  goal_.number = numbers_;
  names_ = std::move(names);
  goal_.object = view.objects[index];
  goal_.own_id = 0;
  for (const ObjectRef& ref : names_) {
    if (ref.uav == self) goal_.own_id = ref.id;
  }
}

bool GoalChooser::MayChoose(const TeamView& view, std::size_t index, const UavKey& self) const {
  const MappedObject& object = view.objects[index];
  const auto class_index = ClassOf(object, model_);
  if (!class_index || model_.classes[*class_index].name != class_name_) return false;
  if (object.sigma_m() > kMostSoughtSigma_m) return false;
  if (!left_.empty() && HaveCommon(NamesOf(view, index), left_)) return false;
  // Two UAVs may have chosen at once: the first by its key keeps its object.
  const bool is_own = view.holders[index] == self;
  for (std::size_t i = 0; i < view.objects.size(); ++i) {
    const std::optional<UavKey>& holder = view.holders[i];
    if (!holder || holder == self || (is_own && self < *holder)) continue;
    if (i == index || (view.objects[i].position() - object.position()).norm() < kObjectsApart_m) {
      return false;
    }
  }
  return true;
}

void GoalChooser::FindMates(const TeamView& view, const FlightToObjects& flight, Time local,
                            const TeamMember& member) {
  const bool is_at_work = flight.at && flight.at->is_at_work;
  int rank = 0;
  goal_.time = local;
  goal_.mates.clear();
  for (const UavKey& uav : member.Known()) {
    const auto other = uav == member.self() ? std::nullopt : member.FlightOf(uav, local);
    if (!other) continue;
    const bool is_before = uav < member.self();
    if (is_before) ++rank;
    const WorldAlignment own_from_world = OwnFromWorld(view, member.self(), uav);
    TeamMate& mate = goal_.mates.emplace_back();
    mate.position = own_from_world * other->position;
    mate.velocity = own_from_world * (other->position + other->velocity) - mate.position;
    mate.goes_first = other->is_at_work == is_at_work ? is_before : other->is_at_work;
  }
  // Those that are not heard any more are still there.
  goal_.rank = flight.at ? std::max(goal_.rank, rank) : rank;
}

void GoalChooser::Leave(bool is_taken, Time local, TeamMember* member) {
  for (const ObjectRef& ref : names_) {
    if (is_taken) member->SetGone(ref, local);
    if (!is_taken) left_.push_back(ref);
  }
  names_.clear();
  goal_.number = 0;
  member->SetClaim(std::nullopt);
}

}  // namespace kestrel
