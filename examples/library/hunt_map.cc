// SPDX-License-Identifier: BSD-3-Clause
// Maps the coloured objects of a recording with poses, and prints the map.
//
//   hunt_map flight
#include <iostream>
#include <variant>

#include "kestrel/event_source.h"
#include "kestrel/hunt_pipeline.h"
#include "kestrel/open_source.h"

int main(int argc, char** argv) {
  if (argc != 2) {
    std::cerr << "usage: hunt_map flight\n";
    return 2;
  }
  try {
    const auto source = kestrel::OpenSource({argv[1]}, kestrel::PixelFormat::kBgr);
    const kestrel::CameraCalibration calibration = source->calibration().value();
    const kestrel::ObjectModel model = kestrel::DefaultObjectModel();
    kestrel::HuntPipeline pipeline(calibration, model, {});
    const kestrel::Duration lead = calibration.clock_offset.value_or(kestrel::Duration::zero());
    kestrel::RecordingEvents events(source.get(), source->poses(), lead);
    for (kestrel::Event event = events.Next(); !std::holds_alternative<kestrel::EndOfStream>(event);
         event = events.Next()) {
      if (const auto* pose = std::get_if<kestrel::PoseSample>(&event)) pipeline.AddPose(*pose);
      if (const auto* frame = std::get_if<kestrel::Frame>(&event)) {
        pipeline.Process(frame->image, frame->time);
      }
    }
    const std::vector<kestrel::MappedObject> objects = pipeline.map().Confirmed();
    for (const kestrel::MappedObject& object : objects) {
      const auto index = kestrel::ClassOf(object, model);
      std::cout << (index ? model.classes[*index].name : "unknown") << ": "
                << object.position().transpose() << " m, sigma " << object.sigma_m() << " m, seen "
                << object.detections << " times\n";
    }
    return objects.empty() ? 1 : 0;
  } catch (const kestrel::InputError& error) {
    std::cerr << error.what() << "\n";
    return 1;
  }
}
