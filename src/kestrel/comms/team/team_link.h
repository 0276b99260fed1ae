// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "kestrel/comms/dds/team_topic.h"
#include "kestrel/comms/team/team_fusion.h"
#include "kestrel/comms/team/team_goal.h"
#include "kestrel/comms/team/team_member.h"
#include "kestrel/comms/team/team_options.h"
#include "kestrel/comms/team/team_view.h"
#include "kestrel/core/base/time.h"
#include "kestrel/io/recording/output_folder.h"
#include "kestrel/vision/mapping/object_map.h"
#include "kestrel/vision/objects/object_model.h"

namespace kestrel {

// Options of a UAV in a team.
struct TeamLinkOptions {
  std::string uav;
  std::string key;
  bool claim = false;
  TeamOptions team;

  static void Visit(auto& self, auto&& visit) {
    visit("uav", self.uav, "name of this UAV in its team; empty: the computer's name");
    visit("key", self.key,
          "file with the team's key (32 bytes or 64 hexadecimal digits): messages are signed, "
          "and unsigned ones refused; empty: none");
    visit("claim", self.claim,
          "the UAV claims the unclaimed object with the most value for its distance");
    visit.Group(self.team);
  }
  std::vector<std::string> Validate() const;
};

// A UAV's part in its team, by DDS: it sends its map, receives those of the others, claims an
// object if the options request it, and writes the map of the whole team. One thread at a time.
class TeamLink {
 public:
  using Report = std::function<void(const std::string&)>;

  // 'team': name of the team. 'domain': DDS domain. 'map': how the UAVs' maps are fused. 'model':
  // of the objects. 'report': receives messages for a person, one line each. Throws InputError when
  // name or options are not valid, the key cannot be read, there is no network, or this build has
  // no DDS.
  TeamLink(const std::string& team, int domain, const TeamLinkOptions& options,
           const ObjectMapOptions& map, const ObjectModel& model, Report report);

  // True when it is time to send the map again.
  bool IsTimeToSend() const;

  // Sends the objects of this UAV's map.
  void Share(std::vector<MappedObject> objects);

  // Sets the position of the UAV in its own world; claims depend on the distance from it.
  void SetPosition(const Eigen::Vector3d& position) { position_ = position; }

  // From now on the UAV goes to objects of a class, one after the other: it claims them whatever
  // the options say. 'class_name': as of GoalChooser.
  void Seek(const std::string& class_name) { goals_.emplace(model_, class_name); }
  // Sets the UAV's state for the next choice of a goal, and its place for the next digest.
  void SetFlight(const FlightToObjects& flight) {
    flight_ = flight;
    member_.SetFlight(flight.at);
  }
  // Its goal; null: it does not seek.
  const TeamGoal* goal() const { return goals_ ? &goals_->goal() : nullptr; }

  // Sends and receives what is due; call it often.
  void Exchange();

  // Sends the objects as this UAV's last. Then waits until all UAVs that are heard have sent their
  // last, all have everything, and no claim changes any more; or until 'is_stopped'. Without
  // another UAV it waits for silence_s.
  void Finish(std::vector<MappedObject> objects, const std::function<bool()>& is_stopped);

  // Returns the team's map in this UAV's own world.
  std::vector<TeamObject> Map() { return OwnMap(View()); }

  // Writes team_map.csv and, if 'origin' is not empty, team_map.geojson. 'origin': latitude and
  // longitude of this UAV's world, degrees. Throws InputError when it cannot write.
  void WriteMap(const std::vector<double>& origin, const OutputFolder& folder);

  // Returns a text for the last line: "team: 3 UAVs, 27 objects".
  std::string Found();

 private:
  TeamView View() { return ViewTeam(member_, Now(), &fusion_); }
  void ChooseAgain();
  std::optional<MappedObject> Choose();
  std::vector<std::optional<Claim>> Claims() const;
  void ReportAwaited() const;

  TeamLinkOptions options_;
  TeamMember member_;
  TeamTopic topic_;
  TeamFusion fusion_;
  ObjectModel model_;
  Report report_;
  Time map_time_ = Time::min();  // time of the map that was sent last, on its own clock
  std::optional<Time> reported_;
  std::optional<Eigen::Vector3d> position_;
  Time next_claim_ = Time::min();
  std::optional<ObjectRef> claimed_;  // as it was reported
  std::optional<GoalChooser> goals_;
  FlightToObjects flight_;
};

}  // namespace kestrel
