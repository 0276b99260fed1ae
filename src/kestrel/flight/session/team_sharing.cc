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
    Publish();
  }
  team_->Exchange();
}

void TeamSharing::Finish() {
  team_->Finish(map_->Confirmed(), is_stopped_);
  Publish();
  if (folder_) team_->WriteMap(origin_, *folder_);
}

void TeamSharing::Publish() { others_->Take(TeamReport{seen_, team_->Map()}); }

}  // namespace kestrel
