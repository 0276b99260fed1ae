// SPDX-License-Identifier: BSD-3-Clause
// Follows the landing pattern in a video or a recording, and says where it will be half a second
// later. Poses of the UAV, where the source has some, place it in the world.
//
//   follow_video camera.yaml flight.mp4
#include <chrono>
#include <iostream>
#include <variant>

#include "kestrel/calibration_reader.h"
#include "kestrel/event_source.h"
#include "kestrel/landing_pipeline.h"
#include "kestrel/open_source.h"

namespace {

void Show(const kestrel::Frame& frame, kestrel::LandingPipeline* pipeline) {
  const kestrel::LandingObservation seen = pipeline->Process(frame.image, frame.time);
  std::cout << frame.name << ": ";
  if (!seen.report.detection) {
    std::cout << seen.report.reason;
  } else if (seen.center_in_world) {
    std::cout << seen.center_in_world->transpose() << " m in the world";
  } else {
    std::cout << seen.report.detection->camera_from_target.translation.transpose()
              << " m in the camera frame";
  }
  if (const auto soon = pipeline->tracker().Predict(frame.time + std::chrono::milliseconds(500))) {
    std::cout << ", soon at " << soon->motion.position().transpose();
  }
  std::cout << "\n";
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) {
    std::cerr << "usage: follow_video camera.yaml flight.mp4\n";
    return 2;
  }
  try {
    const kestrel::CameraCalibration calibration = kestrel::ReadCalibration(argv[1]);
    kestrel::LandingPipeline pipeline(calibration, {});
    const auto source = kestrel::OpenSource({argv[2]});
    const kestrel::Duration lead = calibration.clock_offset.value_or(kestrel::Duration::zero());
    kestrel::RecordingEvents events(source.get(), source->poses(), lead);
    for (kestrel::Event event = events.Next(); !std::holds_alternative<kestrel::EndOfStream>(event);
         event = events.Next()) {
      if (const auto* pose = std::get_if<kestrel::PoseSample>(&event)) pipeline.AddPose(*pose);
      if (const auto* frame = std::get_if<kestrel::Frame>(&event)) Show(*frame, &pipeline);
    }
  } catch (const kestrel::InputError& error) {
    std::cerr << error.what() << "\n";
    return 1;
  }
  return 0;
}
