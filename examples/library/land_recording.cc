// SPDX-License-Identifier: BSD-3-Clause
// Looks for a landing pad in the frames of a recorded landing, with options of its own, and prints
// where the pad is in the world.
//
//   land_recording flight
#include <iostream>
#include <variant>

#include "kestrel/event_source.h"
#include "kestrel/landing_pipeline.h"
#include "kestrel/open_source.h"

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

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::cerr << "usage: land_recording flight\n";
    return 2;
  }
  try {
    const auto source = kestrel::OpenSource({argv[1]});
    const kestrel::CameraCalibration calibration = source->calibration().value();
    kestrel::LandingPipeline pipeline(calibration, Options());
    const kestrel::Duration lead = calibration.clock_offset.value_or(kestrel::Duration::zero());
    kestrel::RecordingEvents events(source.get(), source->poses(), lead);
    kestrel::LandingObservation last;
    int frames = 0, found = 0;
    for (kestrel::Event event = events.Next(); !std::holds_alternative<kestrel::EndOfStream>(event);
         event = events.Next()) {
      if (const auto* pose = std::get_if<kestrel::PoseSample>(&event)) pipeline.AddPose(*pose);
      if (const auto* frame = std::get_if<kestrel::Frame>(&event)) {
        last = pipeline.Process(frame->image, frame->time);
        ++frames;
        found += last.report.detection.has_value();
      }
    }
    std::cout << "found in " << found << " of " << frames << " frames\n";
    if (!last.target) return 1;
    std::cout << "the pad is at " << last.target->motion.position().transpose() << " m, drives at "
              << last.target->speed() << " m/s\n";
  } catch (const kestrel::InputError& error) {
    std::cerr << error.what() << "\n";
    return 1;
  }
  return 0;
}
