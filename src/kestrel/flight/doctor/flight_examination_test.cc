// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/doctor/flight_examination.h"

#include <chrono>
#include <string>

#include <gtest/gtest.h>
#include <opencv2/core.hpp>

#include "kestrel/flight/doctor/test_setups.h"

namespace kestrel {
namespace {

using std::chrono::milliseconds;

class FlightExaminationTest : public ::testing::Test {
 protected:
  FlightExaminationTest() : calibration_(GoodSetup(AutopilotKind::kPx4).calibration) {}

  // Returns the examination after ten seconds of flight over the pattern, seen with 'true_mount'.
  FlightExamination Fly(const RigidTransform& true_mount) const {
    FlightExamination examination(calibration_, ".", 0);
    const cv::Mat image(calibration_.intrinsics.height_px, calibration_.intrinsics.width_px,
                        CV_8UC1, cv::Scalar(110));
    for (int i = 0; i < kFrames; ++i) {
      examination.AddFrame({FrameTime(i), FrameTime(i) + milliseconds(20)});
      examination.Look(image, FrameTime(i));
      examination.Look(Seen(i, true_mount));
    }
    return examination;
  }

  LandingObservation Seen(int i, const RigidTransform& true_mount) const {
    const RigidTransform world_from_body = HeldPose(kPeriod_s * i, 5);
    LandingObservation observation;
    observation.time = FrameTime(i);
    observation.detect_time = milliseconds(3);
    observation.world_from_camera = world_from_body * *calibration_.body_from_camera;
    observation.camera_from_body = calibration_.body_from_camera->Inverse();
    TargetDetection& detection = observation.report.detection.emplace();
    detection.camera_from_target = (world_from_body * true_mount).Inverse();
    detection.semi_minor_px = 50;
    detection.diagnostics.misfit_px = 0.2;
    return observation;
  }

  static FlightReport Report() {
    FlightReport report;
    report.capture.captured = kFrames;
    report.events.frames = kFrames;
    return report;
  }

  static Verdict VerdictOf(const std::string& check, const FlightExamination& examination,
                           const FlightReport& report = Report()) {
    for (const Finding& finding : examination.Check(report)) {
      if (finding.check == check) return finding.verdict;
    }
    ADD_FAILURE() << "no check " << check;
    return Verdict::kNotChecked;
  }

  CameraCalibration calibration_;
};

TEST_F(FlightExaminationTest, ReportsGoodChecks) {
  const FlightExamination examination = Fly(*calibration_.body_from_camera);
  for (const char* check :
       {"images", "image size", "frame rate", "steadiness", "missed images", "capture clock",
        "calibration by the pattern", "mount against gravity", "detection time"}) {
    EXPECT_EQ(VerdictOf(check, examination), Verdict::kGood) << check;
  }
}

TEST_F(FlightExaminationTest, ReportsWrongMount) {
  const RigidTransform& mount = *calibration_.body_from_camera;
  const RigidTransform tilted = {
      mount.rotation * Eigen::Quaterniond(Eigen::AngleAxisd(0.6, Eigen::Vector3d::UnitX())),
      mount.translation};
  const FlightExamination examination = Fly(tilted);
  EXPECT_EQ(VerdictOf("mount against gravity", examination), Verdict::kWrong);
  EXPECT_EQ(VerdictOf("frozen images", examination), Verdict::kWrong) << "all are the same";
  FlightReport report = Report();
  report.capture.missed = 9 * kFrames;
  EXPECT_EQ(VerdictOf("missed images", examination, report), Verdict::kWrong);
}

TEST_F(FlightExaminationTest, DoesNotJudgeWithoutObservations) {
  const FlightExamination examination(calibration_, ".", 0);
  EXPECT_EQ(VerdictOf("frame rate", examination), Verdict::kNotChecked);
  EXPECT_EQ(VerdictOf("exposure", examination), Verdict::kNotChecked);
  EXPECT_EQ(VerdictOf("mount against gravity", examination), Verdict::kNotChecked);
}

}  // namespace
}  // namespace kestrel
