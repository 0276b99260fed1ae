// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "kestrel/comms/team/team_link.h"
#include "kestrel/core/base/bounded_queue.h"
#include "kestrel/flight/session/observation_sink.h"
#include "kestrel/io/recording/output_folder.h"
#include "kestrel/vision/mapping/object_map.h"

namespace kestrel {

// The map of a hunt after a frame.
struct MapCopy {
  std::vector<MappedObject> objects;
  Time captured;                            // capture time of that frame
  std::optional<Eigen::Vector3d> position;  // the camera then, in the world, if it is known
};

// Copies the map every 'period' for another thread, as it changes with the next frame.
class MapCopies : public ObservationSink {
 public:
  // 'map' outlives this.
  MapCopies(const ObjectMap* map, Duration period) : map_(map), period_(period) {}

  void Take(const Observation& observation) override {
    const Time now = Now();
    if (now < next_) return;
    next_ = now + period_;
    MapCopy copy{map_->Confirmed(), observation.frame.time, {}};
    if (const auto pose = WorldFromCamera(observation)) copy.position = pose->translation;
    copies_.Push(std::move(copy));
  }

  // Returns the newest copy, if it was not taken yet. Called by any thread.
  std::optional<MapCopy> TakeNewest() { return copies_.TryPop(); }

 private:
  const ObjectMap* map_;
  Duration period_;
  BoundedQueue<MapCopy> copies_{1};
  Time next_ = Time::min();
};

// A sink that shares the map of a hunt over a recording with its team, and passes the team's map on
// to the other sinks.
class TeamSharing : public ObservationSink {
 public:
  // 'origin': latitude and longitude (degrees) of the world's origin, or empty. 'folder': for the
  // team's map; nothing: no file is written. 'is_stopped' ends the wait for the others. The objects
  // that pointers name must outlive this.
  TeamSharing(std::unique_ptr<TeamLink> team, const ObjectMap* map, std::vector<double> origin,
              std::optional<OutputFolder> folder, ObservationSink* others,
              std::function<bool()> is_stopped);

  void Take(const Observation& observation) override;
  // Waits until all UAVs of the team have everything, or for what TeamLink::Finish says.
  void Finish() override;

  std::string Found() { return team_->Found(); }

 protected:
  TeamLink& team() { return *team_; }
  // Passes the team's map on; 'seen': time of the newest frame that is in it.
  void Publish(Time seen);

 private:
  std::unique_ptr<TeamLink> team_;
  const ObjectMap* map_;
  std::vector<double> origin_;
  std::optional<OutputFolder> folder_;
  ObservationSink* others_;
  std::function<bool()> is_stopped_;
  Time seen_{};  // time of the last frame
};

// The same in flight, where the vision's thread does not wait for the network.
class LiveTeamSharing : public TeamSharing {
 public:
  // As of TeamSharing.
  LiveTeamSharing(std::unique_ptr<TeamLink> team, const ObjectMap* map,
                  std::optional<OutputFolder> folder, ObservationSink* others,
                  std::function<bool()> is_stopped);

  void Take(const Observation& observation) override { copies_.Take(observation); }

  // The team, for the flight of this UAV. Used by the thread that calls Share.
  using TeamSharing::team;

  // Shares what is new, and exchanges messages. Called often, by the thread of Session::Run.
  void Share();

 private:
  MapCopies copies_;
};

}  // namespace kestrel
