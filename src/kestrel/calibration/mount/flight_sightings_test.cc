// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/calibration/mount/flight_sightings.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kestrel/core/base/error.h"
#include "kestrel/vision/pipeline/test_pattern.h"

namespace kestrel {
namespace {

using ::testing::HasSubstr;

TEST(FlightSightings, KeepsImagesThatShowPattern) {
  const CameraIntrinsics camera{640, 480, 400, 400, 319.5, 239.5, DistortionModel::kNone, {}};
  // The camera looks straight down from 3 m.
  const RigidTransform camera_from_target{Eigen::Quaterniond(0, 1, 0, 0), {0.3, 0.15, 3}};
  FlightSightings flight(camera, LandingPipelineOptions());
  flight.Add(DrawPattern(CameraModel(camera), LandingPattern(), camera_from_target),
             TimeFromNanoseconds(7));
  flight.Add(cv::Mat(480, 640, CV_8UC1, 90.0), TimeFromNanoseconds(8));
  ASSERT_EQ(flight.sightings().size(), 1u);
  const TargetSighting& sighting = flight.sightings()[0];
  EXPECT_EQ(sighting.time, TimeFromNanoseconds(7));
  EXPECT_LT((sighting.center_in_camera - camera_from_target.translation).norm(), 0.03);
  EXPECT_GT(sighting.sigma_m, 0);
  ASSERT_EQ(flight.places().size(), 1u);
  EXPECT_NEAR(flight.places()[0].pixel.x, 319.5 + 40, 0.5);
  EXPECT_NEAR(flight.places()[0].pixel.y, 239.5 + 20, 0.5);
  EXPECT_NEAR(flight.places()[0].height_m, 3, 0.03);
}

TEST(MountAndClock, AreTakenFromCalibration) {
  CameraCalibration calibration;
  try {
    GivenMountAndClock(calibration, "camera.yaml");
    FAIL() << "expected an InputError";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("camera.yaml: the calibration has no mount"));
  }
  const MountAndClock estimate{{Eigen::Quaterniond(0, 1, 0, 0), {0.1, 0, 0}}, 0.25};
  SetMountAndClock(estimate, &calibration);
  const MountAndClock given = GivenMountAndClock(calibration, "camera.yaml");
  EXPECT_TRUE(given.body_from_camera.rotation.isApprox(estimate.body_from_camera.rotation));
  EXPECT_EQ(given.body_from_camera.translation, estimate.body_from_camera.translation);
  EXPECT_DOUBLE_EQ(given.clock_offset_s, 0.25);
}

}  // namespace
}  // namespace kestrel
