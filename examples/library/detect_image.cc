// SPDX-License-Identifier: BSD-3-Clause
// Detects the landing pattern in one image.
//
//   detect_image camera.yaml image.png
#include <iostream>

#include "kestrel/calibration_reader.h"
#include "kestrel/landing_pattern_detector.h"
#include "kestrel/open_source.h"

int main(int argc, char** argv) {
  if (argc != 3) {
    std::cerr << "usage: detect_image camera.yaml image.png\n";
    return 2;
  }
  try {
    const kestrel::CameraModel camera(kestrel::ReadCalibration(argv[1]).intrinsics);
    const kestrel::LandingPatternDetector detector(camera, {});
    kestrel::Frame frame;
    if (!kestrel::OpenSource({argv[2]})->Next(&frame)) return 1;
    const kestrel::TargetReport report = detector.Detect(frame.image);
    if (!report.detection) {
      std::cout << "no pattern: " << report.reason << "\n";
      return 1;
    }
    std::cout << "seen at " << report.detection->center_px.transpose() << " px, "
              << report.detection->camera_from_target.translation.transpose()
              << " m in the camera frame, quality " << report.detection->quality << "\n";
  } catch (const kestrel::InputError& error) {
    std::cerr << error.what() << "\n";
    return 1;
  }
  return 0;
}
