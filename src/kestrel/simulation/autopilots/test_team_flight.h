// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstddef>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "kestrel/comms/team/team_fusion.h"
#include "kestrel/comms/team/team_goal.h"
#include "kestrel/comms/team/team_view.h"
#include "kestrel/comms/team/test_team.h"
#include "kestrel/flight/onboard/team_in_flight.h"
#include "kestrel/simulation/autopilots/test_go_flight.h"

namespace kestrel {

// A flight of a UAV of a team to the objects of a class.
class TeamGoFlight : public SightedGoFlight {
 public:
  TeamGoFlight(const GoFlightSetup& setup, SimulatedTeam* team, std::size_t index)
      : SightedGoFlight(setup),
        team_(*team),
        index_(index),
        goals_(DefaultObjectModel(), setup.class_name) {}

  // Shares the map and chooses, as `kestrel fly` does.
  void Share() {
    TeamMember& member = *team_.uavs[index_].member;
    const Time local = team_.LocalTime(index_);
    if (now >= share_due_) {
      share_due_ = now + DurationFromSeconds(TeamOptions::kSendPeriod_s);
      if (track_.captured > Time()) member.Share(map_.Confirmed(), track_.captured);
    }
    flight_ = ToObjects(*flown_->by_position(), poses_, now, flight_);
    member.SetFlight(flight_.at);
    if (now < choose_due_) return;
    choose_due_ = now + DurationFromSeconds(TeamOptions::kDigestPeriod_s);
    const TeamGoal& goal =
        goals_.Update(ViewTeam(member, local, &fusion_), flight_, local, &member);
    sought_.Assign({goal.number, goal.own_id, goal.object});
    TeamInFlight team = InFlight(goal);
    team.time = now;  // the radio has another clock
    flown_->by_position()->Take(std::move(team));
  }

  const Eigen::Vector3d& place() const { return model.truth().world_from_body.translation; }

 private:
  void LeaveEnded() override {}

  SimulatedTeam& team_;
  std::size_t index_;
  TeamFusion fusion_{{}, {}};
  GoalChooser goals_;
  FlightToObjects flight_;
  Time share_due_{}, choose_due_{};
};

// UAVs of a team in one world, by a radio, in simulated time.
class TeamGoFlights {
 public:
  // 'setups': of the UAVs, which have names in this order.
  explicit TeamGoFlights(const std::vector<GoFlightSetup>& setups)
      : field_(MakeField(setups.front().field, setups.front().seed)), team_(setups.front().seed) {
    for (std::size_t i = 0; i < setups.size(); ++i) {
      GoFlightSetup setup = setups[i];
      setup.world = field_.get();
      setup.seed += 1000 * i;
      team_.Add({std::string(1, static_cast<char>('a' + i)), 1});
      uavs.push_back(std::make_unique<TeamGoFlight>(setup, &team_, i));
    }
  }

  void Fly(double seconds) {
    const Time end = uavs.front()->now + DurationFromSeconds(seconds);
    while (uavs.front()->now < end) {
      for (const auto& uav : uavs) {
        uav->Fly(TestAutopilot::kStep_s);
        uav->Share();
      }
      team_.Run(TestAutopilot::kStep_s);
      Measure();
    }
  }

  double seconds() const { return ToSeconds(uavs.front()->now - kTestStart); }
  // Numbers of objects that were taken, and put down within 'radius_m' of a place.
  int CountTaken() const {
    const ObjectField& field = field_->field();
    int taken = 0;
    for (std::size_t i = 0; i < field.objects().size(); ++i) taken += field.is_taken(i) ? 1 : 0;
    return taken;
  }
  int CountDelivered(const Eigen::Vector2d& place, double radius_m) const {
    int delivered = 0;
    for (const auto& uav : uavs) {
      for (const Eigen::Vector3d& at : uav->model.result().put_down) {
        delivered += (at.head<2>() - place).norm() <= radius_m ? 1 : 0;
      }
    }
    return delivered;
  }
  SimulatedTeam& radio() { return team_; }

 private:
  std::unique_ptr<VehicleWorld> field_;
  SimulatedTeam team_;

  void Measure() {
    for (std::size_t i = 0; i < uavs.size(); ++i) {
      for (std::size_t k = i + 1; k < uavs.size(); ++k) {
        const Eigen::Vector3d way = uavs[i]->place() - uavs[k]->place();
        if (way.head<2>().norm() < nearest_m) nearest_s = seconds();
        nearest_m = std::min(nearest_m, way.head<2>().norm());
      }
    }
  }

 public:
  std::vector<std::unique_ptr<TeamGoFlight>> uavs;
  double nearest_m = std::numeric_limits<double>::infinity();  // horizontal, of any two so far
  double nearest_s = 0;                                        // when that was
};

}  // namespace kestrel
