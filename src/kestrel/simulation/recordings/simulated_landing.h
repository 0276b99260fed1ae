// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "kestrel/simulation/recordings/simulated_flight.h"
#include "kestrel/simulation/scene/landing_scene.h"
#include "kestrel/simulation/scene/motion.h"

namespace kestrel {

// A flight over a landing scene, with the truth of the pattern. Thread-safe.
class SimulatedLanding {
 public:
  // 'camera' has a mount, the nominal one.
  SimulatedLanding(const FlightRecordingOptions& options, const SurroundingsOptions& surroundings,
                   const CameraCalibration& camera, LandingScene scene,
                   const Motion& world_from_uav, std::uint64_t seed);

  const SimulatedFlight& flight() const { return flight_; }
  const TargetPrint& print() const { return print_; }  // print of the pad, as drawn
  const Motion& world_from_pattern() const { return world_from_pattern_; }

  // Leaves out the images from 'index' on: the flight has ended.
  void EndBefore(std::size_t index) { flight_.EndBefore(index); }

  // Text of scene.yaml; 'options': all of them, as YAML.
  std::string SceneText(const std::string& kind, const std::string& options) const;

  // The files of every flight and landing_pattern0.
  std::vector<RecordingFile> Files() const;

 private:
  TargetPrint print_;
  std::string drawn_;  // what chance has drawn of it, a line of YAML
  Motion world_from_pattern_;
  SimulatedFlight flight_;
};

}  // namespace kestrel
