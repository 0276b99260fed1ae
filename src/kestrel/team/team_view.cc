// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/team/team_view.h"

#include <algorithm>
#include <utility>

#include "kestrel/geometry/angles.h"
#include "kestrel/mapping/object_fusion.h"

namespace kestrel {
namespace {

// The objects of a part at 'local', on a clock that says 'now' then.
std::vector<MappedObject> ObjectsAt(const TeamMap::Part& part, const ObjectMapOptions& options,
                                    Time local, Time now) {
  const Duration since_told = std::max(local - part.told_at, Duration::zero());
  const Duration shift = now - since_told - part.contents.now;
  std::vector<MappedObject> objects;
  for (const auto& [id, entry] : part.objects) {
    MappedObject object = entry.object;
    for (Time* time : {&object.time, &object.first_seen, &object.last_seen}) *time += shift;
    PredictObject(now, options.motion(), &object);
    objects.push_back(object);
  }
  return objects;
}

// Fuses the parts one after the other, those first whose world is known by what is there already.
class Fusion {
 public:
  Fusion(const TeamMember& member, const ObjectMapOptions& options, TeamView* view)
      : options_(options),
        prior_{member.options().world_sigma_m, Radians(member.options().world_yaw_sigma_deg)},
        view_(view) {}

  void Add(const UavKey& uav, const TeamMap::Part& part, std::vector<MappedObject> objects) {
    waiting_.push_back({uav, &part, std::move(objects)});
  }

  void Run() {
    bool is_first = true;
    while (!waiting_.empty()) {
      std::vector<Part> left;
      for (Part& part : waiting_) {
        const std::optional<WorldAlignment> alignment =
            is_first ? WorldAlignment{} : EstimateAlignment(part.objects, view_->objects, prior_);
        is_first = false;
        if (alignment) {
          view_->common_from_world[part.uav] = *alignment;
          Fuse(*alignment, &part);
        } else {
          left.push_back(std::move(part));
        }
      }
      const bool is_done = left.size() == waiting_.size();
      waiting_ = std::move(left);
      if (is_done) break;
    }
    for (Part& part : waiting_) Fuse(UnknownAlignment(part.objects, prior_), &part);
  }

 private:
  struct Part {
    UavKey uav;
    const TeamMap::Part* told;
    std::vector<MappedObject> objects;  // in the order of their ids
  };

  void Fuse(const WorldAlignment& alignment, Part* part) {
    for (MappedObject& object : part->objects) MoveToWorld(alignment, &object);
    const auto indices = FuseObjects(part->objects, options_, &view_->objects);
    std::size_t i = 0;
    for (const auto& [id, entry] : part->told->objects) {
      view_->index[{part->uav, id}] = indices[i++];
    }
  }

  ObjectMapOptions options_;
  WorldPrior prior_;
  TeamView* view_;
  std::vector<Part> waiting_;
};

// To each claimed object the one who has it.
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

}  // namespace

TeamView ViewTeam(const TeamMember& member, const ObjectMapOptions& options, Time local) {
  const TeamMap::Part* const own = member.map().Find(member.self());
  const Time now =
      own == nullptr ? local : own->contents.now + std::max(local - own->told_at, Duration::zero());
  TeamView view;
  Fusion fusion(member, options, &view);
  for (const auto& [uav, part] : member.map().parts()) {
    if (!part.objects.empty()) fusion.Add(uav, part, ObjectsAt(part, options, local, now));
  }
  fusion.Run();
  const auto common_from_own = view.common_from_world.find(member.self());
  if (common_from_own != view.common_from_world.end()) {
    WorldAlignment own_from_common = common_from_own->second.Inverse();
    own_from_common.covariance.setZero();  // errors of both ways are the same
    for (MappedObject& object : view.objects) MoveToWorld(own_from_common, &object);
  }
  for (std::size_t i = 0; i < view.objects.size(); ++i) {
    view.objects[i].id = static_cast<std::int64_t>(i) + 1;
  }
  FindHolders(member, local, &view);
  return view;
}

std::optional<std::size_t> ChooseObject(const TeamView& view, const Eigen::Vector3d& position,
                                        const ObjectModel& model, Time local, TeamMember* member) {
  if (const auto claim = member->ClaimOf(member->self(), local)) {
    const auto held = view.index.find(claim->object);
    if (held != view.index.end() && view.holders[held->second] == member->self()) {
      return held->second;
    }
  }
  std::optional<Claim> best;
  std::optional<std::size_t> chosen;
  for (const auto& [ref, i] : view.index) {
    if (view.holders[i] && view.holders[i] != member->self()) continue;
    // A metre is as good as nothing: of objects that are near the value decides.
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
