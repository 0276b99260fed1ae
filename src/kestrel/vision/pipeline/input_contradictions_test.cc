// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/pipeline/input_contradictions.h"

#include <gtest/gtest.h>

#include "kestrel/core/base/random.h"
#include "kestrel/core/geometry/angles.h"
#include "kestrel/core/geometry/test_rotation.h"

namespace kestrel {
namespace {

// Detections of a level pattern from a camera that looks down, tilted by up to 20 degrees, at 5 m.
class InputContradictionsTest : public ::testing::Test {
 protected:
  struct View {
    TargetDetection seen;
    Eigen::Vector3d up_in_camera;
  };

  View See() {
    const Eigen::Quaterniond camera_from_world =
        Rotation(random_.Uniform(-0.35, 0.35), {random_.Normal(), random_.Normal(), 0.1}) *
        Rotation(kPi, Eigen::Vector3d::UnitX());
    View view;
    view.up_in_camera = camera_from_world * Eigen::Vector3d::UnitZ();
    const Eigen::Vector3d center =
        camera_from_world * Eigen::Vector3d(random_.Uniform(-1, 1), 0.5, -5);
    const Eigen::Quaterniond turn = Rotation(0.02 * random_.Normal(), Eigen::Vector3d::UnitY());
    view.seen.camera_from_target = {turn * camera_from_world,
                                    center * (1 + 0.02 * random_.Normal())};
    view.seen.covariance.setZero();
    view.seen.covariance.diagonal() << 1e-4, 1e-4, 1e-2, 4e-4, 4e-4, 1e-5;
    return view;
  }

  // Returns the contradictions after 'views' views with an altitude that is 'excess_m' too large.
  InputContradictions Fly(int views, double excess_m, const Eigen::Quaterniond& mount_error) {
    InputContradictions contradictions;
    for (int i = 0; i < views; ++i) {
      const View view = See();
      contradictions.Add({5 + excess_m, mount_error * view.up_in_camera}, view.seen);
    }
    return contradictions;
  }
  InputContradictions FlyWithAltitude(int views, double excess_m) {
    return Fly(views, excess_m, Eigen::Quaterniond::Identity());
  }

  Random random_{7};
};

TEST_F(InputContradictionsTest, ReportsAltitudeAboveSeaLevel) {
  for (const double excess_m : {10.0, 500.0, -10.0, -3.0}) {
    const InputContradictions contradictions = FlyWithAltitude(20, excess_m);
    ASSERT_TRUE(contradictions.Altitude()) << excess_m;
    EXPECT_NEAR(contradictions.Altitude()->difference, excess_m, 0.1);
    EXPECT_LT(contradictions.Altitude()->sigma, 0.5);
    EXPECT_EQ(contradictions.Altitude()->detections, 20);
    EXPECT_FALSE(contradictions.Attitude());
  }
}

TEST_F(InputContradictionsTest, AcceptsAltitudesThatAgreeOrFitVehicle) {
  for (const double excess_m : {0.0, 0.5, -0.5, 3.0}) {
    EXPECT_FALSE(FlyWithAltitude(100, excess_m).Altitude()) << excess_m;
  }
}

TEST_F(InputContradictionsTest, RequiresTenDetections) {
  EXPECT_FALSE(FlyWithAltitude(9, 10).Altitude());
  EXPECT_TRUE(FlyWithAltitude(10, 10).Altitude());
}

TEST_F(InputContradictionsTest, ToleratesThirdOfWrongDetections) {
  InputContradictions contradictions;
  for (int i = 0; i < 60; ++i) {
    const View view = See();
    contradictions.Add({i % 3 == 0 ? 100.0 : 5.0, view.up_in_camera}, view.seen);
  }
  EXPECT_FALSE(contradictions.Altitude());
}

TEST_F(InputContradictionsTest, ReportsDriftAfterLongAgreement) {
  InputContradictions contradictions = FlyWithAltitude(1000, 0);
  for (int i = 0; i < 64; ++i) {
    const View view = See();
    contradictions.Add({15, view.up_in_camera}, view.seen);
  }
  ASSERT_TRUE(contradictions.Altitude());
  EXPECT_NEAR(contradictions.Altitude()->difference, 10, 0.1);
}

TEST_F(InputContradictionsTest, AltitudeWithoutAttitudeIsAbovePattern) {
  for (const double excess_m : {14.0, -2.5, 0.5}) {
    InputContradictions contradictions;
    for (int i = 0; i < 20; ++i) contradictions.Add({5 + excess_m, {}}, See().seen);
    ASSERT_EQ(contradictions.Altitude().has_value(), excess_m != 0.5) << excess_m;
    if (excess_m == 0.5) continue;
    EXPECT_NEAR(contradictions.Altitude()->difference, excess_m, 0.1);
  }
}

TEST_F(InputContradictionsTest, ReportsUpsideDownMountButNotAltitude) {
  const InputContradictions contradictions = Fly(20, 10, Rotation(kPi, Eigen::Vector3d::UnitX()));
  ASSERT_TRUE(contradictions.Attitude());
  // The mount error turns 'up' over by half a turn, and the camera is tilted by up to 20 degrees:
  // at least 140 degrees.
  EXPECT_GT(contradictions.Attitude()->difference, 140 * kPi / 180);
  EXPECT_FALSE(contradictions.Altitude());
}

TEST_F(InputContradictionsTest, ReportsMountTurnedByFortyDegreesButNotTen) {
  const Eigen::Vector3d axis = Eigen::Vector3d::UnitY();
  const InputContradictions wrong = Fly(20, 0, Rotation(40 * kPi / 180, axis));
  ASSERT_TRUE(wrong.Attitude());
  EXPECT_NEAR(wrong.Attitude()->difference, 40 * kPi / 180, 0.05);
  EXPECT_FALSE(Fly(20, 0, Rotation(10 * kPi / 180, axis)).Attitude());
}

TEST_F(InputContradictionsTest, MirrorPoseMayAgree) {
  InputContradictions contradictions;
  for (int i = 0; i < 20; ++i) {
    View view = See();
    view.seen.diagnostics.mirror_camera_from_target = view.seen.camera_from_target;
    RigidTransform& given_first = view.seen.camera_from_target;
    given_first.rotation = Rotation(0.9, Eigen::Vector3d::UnitX()) * given_first.rotation;
    contradictions.Add({5, view.up_in_camera}, view.seen);
  }
  EXPECT_FALSE(contradictions.Attitude());
  EXPECT_FALSE(contradictions.Altitude());
}

}  // namespace
}  // namespace kestrel
