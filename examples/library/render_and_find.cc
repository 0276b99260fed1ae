// SPDX-License-Identifier: BSD-3-Clause
// Renders one view of a simulated flight and finds the landing pattern in it.
#include <iostream>

#include "kestrel/landing_pattern_detector.h"
#include "kestrel/recording_plan.h"

int main() {
  const kestrel::CameraCalibration calibration = kestrel::PaperCalibration();
  const kestrel::RecordingPlan plan =
      kestrel::PlanLandingScenario("calm", {}, calibration, /*seed=*/1);
  const cv::Mat view = plan.render(0);
  const kestrel::LandingPatternDetector detector(kestrel::CameraModel(calibration.intrinsics), {});
  const kestrel::TargetReport report = detector.Detect(view);
  if (!report.detection) {
    std::cout << "no pattern: " << report.reason << "\n";
    return 1;
  }
  std::cout << "found " << report.detection->camera_from_target.translation.norm() << " m away\n";
  return 0;
}
