// SPDX-License-Identifier: BSD-3-Clause
// Looks for a landing pad in the frames of a recorded landing, with options of its own, and prints
// where the pad is in the world.
//
//   land_recording flight
#include <iostream>
#include <memory>
#include <optional>
#include <variant>

#include "kestrel/error.h"
#include "kestrel/session.h"

namespace {

// The pad is the contest's; the UAV has a slow computer and a navigation that drifts.
kestrel::LandingPipelineOptions Options() {
  kestrel::LandingPipelineOptions options;
  options.target.kind = "ring-cross";
  options.detector.pattern.outer_diameter_m = 1;
  options.detector.min_quality = 0.8;
  options.hint_sigma_m = 0.4;
  options.pose_gap_s = 0.2;
  return options;
}

struct LastTarget : kestrel::ObservationSink {
  void Take(const kestrel::Observation& observation) override {
    target = std::get<kestrel::LandingObservation>(observation.seen).target;
  }
  std::optional<kestrel::TargetEstimate> target;
};

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::cerr << "usage: land_recording flight\n";
    return 2;
  }
  try {
    const auto recording = kestrel::OpenRecording({.sources = {argv[1]}});
    const auto session = kestrel::MakeSession(recording, kestrel::LandTask(Options()));
    const auto* const last = session->sinks().Add(std::make_unique<LastTarget>());
    session->Run();
    std::cout << session->Summary();
    if (!last->target) return 1;
    std::cout << "the pad is at " << last->target->motion.position().transpose() << " m, drives at "
              << last->target->speed() << " m/s\n";
  } catch (const kestrel::InputError& error) {
    std::cerr << error.what() << "\n";
    return 1;
  }
  return 0;
}
