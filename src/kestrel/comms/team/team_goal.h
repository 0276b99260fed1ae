// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "kestrel/comms/team/team_member.h"
#include "kestrel/comms/team/team_view.h"
#include "kestrel/core/base/time.h"
#include "kestrel/vision/mapping/mapped_object.h"
#include "kestrel/vision/objects/object_model.h"

namespace kestrel {

// Another UAV of the team in flight, in the world of this one (m, m/s).
struct TeamMate {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();
  bool goes_first = false;  // this UAV gives way
};

// A UAV's flight to objects, for its team.
struct FlightToObjects {
  std::optional<UavFlight> at;  // nothing: it is on the ground, or its place is not known
  bool wants_object = false;    // false: it does not fly to objects, or carries one
  int ended = 0;                // number of the object at which it ended its job last; 0: of none
  bool has_taken = false;       // that object; false: it will not try again
};

// The object that a UAV goes to, and the others of the team that it keeps away from.
struct TeamGoal {
  int number = 0;           // of its object: each has another one, from 1; 0: there is none
  std::int64_t own_id = 0;  // of that object in the own map; 0: it is not there
  MappedObject object;      // the same in the team's map, in the own world and on the own clock
  int rank = 0;  // number of UAVs that fly and come before it by their keys; in flight the largest
  Time time;     // when the mates were where they are here, on the own clock
  std::vector<TeamMate> mates;
};

// Chooses the objects of one class to which a UAV goes one after the other, so that no two UAVs go
// to one object, or to two that are nearer than kObjectsApart_m to each other. One thread at a
// time.
class GoalChooser {
 public:
  static constexpr double kObjectsApart_m = 7;

  // 'class_name': of one class of the model, or of several.
  GoalChooser(ObjectModel model, std::string class_name)
      : model_(std::move(model)), class_name_(std::move(class_name)) {}

  // Chooses and claims; call it as often as digests are sent. A UAV that wants no object has no
  // claim. The member has the place of the flight from its SetFlight.
  const TeamGoal& Update(const TeamView& view, const FlightToObjects& flight, Time local,
                         TeamMember* member);
  const TeamGoal& goal() const { return goal_; }

 private:
  void Leave(bool is_taken, Time local, TeamMember* member);
  bool MayChoose(const TeamView& view, std::size_t index, const UavKey& self) const;
  void Take(const TeamView& view, std::size_t index, const UavKey& self);
  void FindMates(const TeamView& view, const FlightToObjects& flight, Time local,
                 const TeamMember& member);

  ObjectModel model_;
  std::string class_name_;
  TeamGoal goal_;
  int numbers_ = 0;               // that were given so far
  std::vector<ObjectRef> names_;  // of the newest number's object, in all maps, until it is left
  std::vector<ObjectRef> left_;   // objects that this UAV will not try again in this flight
};

}  // namespace kestrel
