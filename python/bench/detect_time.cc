// SPDX-License-Identifier: BSD-3-Clause
// Prints the time (us) of a detection of the landing pattern in an image, for python_benchmark.py.
//
//   detect_time camera.yaml image.pgm
#include <chrono>
#include <iostream>

#include "kestrel/calibration_reader.h"
#include "kestrel/landing_pattern_detector.h"
#include "kestrel/open_source.h"

int main(int argc, char** argv) {
  using namespace kestrel;
  constexpr int kCount = 100;
  if (argc != 3) return 2;
  const LandingPatternDetector detector(CameraModel(ReadCalibration(argv[1]).intrinsics), {});
  Frame frame;
  if (!OpenSource({argv[2]})->Next(&frame)) return 1;
  LandingWorkspace workspace;
  detector.Detect(frame.image, {}, workspace);
  const auto begin = std::chrono::steady_clock::now();
  for (int i = 0; i < kCount; ++i) detector.Detect(frame.image, {}, workspace);
  const std::chrono::duration<double, std::micro> taken = std::chrono::steady_clock::now() - begin;
  std::cout << taken.count() / kCount << "\n";
}
