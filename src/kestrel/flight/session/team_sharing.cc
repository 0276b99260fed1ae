// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/session/team_sharing.h"

#include <utility>

namespace kestrel {

TeamSharing::TeamSharing(std::unique_ptr<TeamLink> team, const ObjectMap* map,
                         std::vector<double> origin, std::optional<OutputFolder> folder,
                         ObservationSink* others, std::function<bool()> is_stopped)
    : team_(std::move(team)),
      map_(map),
      origin_(std::move(origin)),
      folder_(std::move(folder)),
      others_(others),
      is_stopped_(std::move(is_stopped)) {}

void TeamSharing::Take(const Observation& observation) {
  if (const auto pose = WorldFromCamera(observation)) team_->SetPosition(pose->translation);
  seen_ = observation.frame.time;
  if (team_->IsTimeToSend()) {
    team_->Share(map_->Confirmed());
    Publish(seen_);
  }
  team_->Exchange();
}

void TeamSharing::Finish() {
  team_->Finish(map_->Confirmed(), is_stopped_);
  Publish(seen_);
  if (folder_) team_->WriteMap(origin_, *folder_);
}

void TeamSharing::Publish(Time seen) {
  seen_ = seen;
  others_->Take(TeamReport{seen, team_->Map()});
}

LiveTeamSharing::LiveTeamSharing(std::unique_ptr<TeamLink> team, const ObjectMap* map,
                                 std::optional<OutputFolder> folder, ObservationSink* others,
                                 std::function<bool()> is_stopped)
    : TeamSharing(std::move(team), map, /*origin=*/{}, std::move(folder), others,
                  std::move(is_stopped)),
      copies_(map, DurationFromSeconds(TeamOptions::kSendPeriod_s)) {}

void LiveTeamSharing::Share() {
  if (auto map = copies_.TakeNewest()) {
    if (map->position) team().SetPosition(*map->position);
    team().Share(std::move(map->objects));
    Publish(map->captured);
  }
  team().Exchange();
}

}  // namespace kestrel
