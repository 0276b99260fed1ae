// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "kestrel/comms/team/team_link.h"
#include "kestrel/flight/session/observation_sink.h"
#include "kestrel/io/recording/output_folder.h"
#include "kestrel/vision/mapping/object_map.h"

namespace kestrel {

// A sink that shares the map of a hunt over a recording with its team, and passes the team's map on
// to the other sinks.
class TeamSharing : public ObservationSink {
 public:
  // 'origin': latitude and longitude (degrees) of the world's origin, or empty. 'folder': for the
  // team's map; null: no file is written. 'is_stopped' ends the wait for the others. The objects
  // that pointers name must outlive this.
  TeamSharing(std::unique_ptr<TeamLink> team, const ObjectMap* map, std::vector<double> origin,
              const OutputFolder* folder, ObservationSink* others,
              std::function<bool()> is_stopped);

  void Take(const Observation& observation) override;
  // Waits until all UAVs of the team have everything, or for what TeamLink::Finish says.
  void Finish() override;

  std::string Found() { return team_->Found(); }

 private:
  void Publish();

  std::unique_ptr<TeamLink> team_;
  const ObjectMap* map_;
  std::vector<double> origin_;
  const OutputFolder* folder_;
  ObservationSink* others_;
  std::function<bool()> is_stopped_;
  Time seen_{};  // time of the last frame
};

}  // namespace kestrel
