// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <Eigen/Core>

#include "kestrel/comms/dds/team_topic.h"
#include "kestrel/comms/team/team_fusion.h"
#include "kestrel/comms/team/team_member.h"
#include "kestrel/comms/team/team_options.h"
#include "kestrel/comms/team/team_view.h"
#include "kestrel/core/base/time.h"
#include "kestrel/io/recording/output_folder.h"
#include "kestrel/vision/mapping/object_map.h"
#include "kestrel/vision/objects/object_model.h"

namespace kestrel {

// The options of a UAV in its team.
struct TeamLinkOptions {
  std::string uav;     // its name; empty: that of the computer
  std::string key;     // file with the key that the team shares; empty: messages are not signed
  bool claim = false;  // go for an object
  TeamOptions team;

  template <class Self, class Visitor>
  static void Visit(Self& self, Visitor&& visitor) {
    visitor("uav", self.uav, "", "name of this UAV in its team, empty for the computer's");
    visitor(
        "key", self.key, "",
        "file with the team's key (32 bytes or 64 hexadecimal digits): sign, and refuse what is "
        "not signed; empty for none");
    visitor("claim", self.claim, "",
            "claim the object with the most value for its distance that nobody else goes for");
    TeamOptions::Visit(self.team, visitor);
  }
  std::vector<std::string> Validate() const;
};

// --team. Must live until the command line is parsed.
struct TeamArguments {
  std::string team;  // empty: none

  // The option.
  CLI::Option* AddTo(CLI::App* command);
};

// A UAV's part in its team, by DDS: tells the map that it makes, hears those of the others, goes
// for an object where the options say so, writes what all know together. One thread at a time.
class TeamLink {
 public:
  using Say = std::function<void(const std::string&)>;

  // Throws InputError when arguments or options are at fault, the key cannot be read, there is no
  // network, or DDS is not part of this build. 'domain': of DDS. 'map': how the UAVs' maps are
  // fused. 'model': of the objects. 'say': gets what a person should know, a line each.
  TeamLink(const TeamArguments& arguments, int domain, const TeamLinkOptions& options,
           const ObjectMapOptions& map, const ObjectModel& model, Say say);

  // Whether the map should be told again.
  bool IsTimeToTell() const;

  // Tells the objects of this UAV's map.
  void Tell(std::vector<MappedObject> objects);

  // Where the UAV is now, in its own world: claims are by the distance from there.
  void SetPosition(const Eigen::Vector3d& position) { position_ = position; }

  // Sends what there is to be sent, and hears; call it often.
  void Exchange();

  // Tells the objects, which are this UAV's last, and waits until those that are heard have told
  // their last, all have all and nobody claims another object, or until Ctrl-C. Who hears nobody
  // waits for silence_s.
  void Finish(std::vector<MappedObject> objects);

  // What the team knows, in this UAV's own world.
  std::vector<TeamObject> Map() { return OwnMap(View()); }

  // Writes team_map.csv and, with the 'origin' of this UAV's world (latitude and longitude,
  // degrees; or empty), team_map.geojson. Throws InputError when that is not possible.
  void WriteMap(const std::vector<double>& origin, const OutputFolder& folder);

  // For the line at the end: "team: 3 UAVs, 27 objects".
  std::string Found();

 private:
  TeamView View() { return ViewTeam(member_, Now(), &fusion_); }
  void ChooseAgain();
  std::vector<std::optional<Claim>> Claims() const;
  void SayWhoIsAwaited() const;

  TeamLinkOptions options_;
  TeamMember member_;
  TeamTopic topic_;
  TeamFusion fusion_;
  ObjectModel model_;
  Say say_;
  Time map_time_ = Time::min();  // of the map told last, on its own clock
  std::optional<Time> told_;
  std::optional<Eigen::Vector3d> position_;
  Time next_claim_ = Time::min();
  std::optional<ObjectRef> claimed_;  // as it was said
};

}  // namespace kestrel
