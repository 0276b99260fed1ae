// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/pipeline/follow_pipeline.h"

#include <chrono>
#include <cmath>
#include <cstdint>

#include <gtest/gtest.h>

#include "kestrel/core/base/random.h"
#include "kestrel/core/geometry/angles.h"
#include "kestrel/vision/pipeline/measurement_noise.h"
#include "kestrel/vision/pipeline/test_follow_scene.h"

namespace kestrel {
namespace {

constexpr double kRate_hz = 20;
constexpr double kSpeed_mps = 6;

CameraCalibration FollowCalibration() {
  CameraCalibration calibration;
  calibration.intrinsics = FollowScene::Camera();
  calibration.body_from_camera = RigidTransform();  // the body is the camera
  calibration.clock_offset = Duration::zero();
  return calibration;
}

Time TimeOf(int frame) { return Time(DurationFromSeconds(1 + frame / kRate_hz)); }

Eigen::Vector3d CarAt(int frame) { return {kSpeed_mps * frame / kRate_hz - 10, 3, 0}; }

// A UAV that flies beside the car and looks down on it by 'depression', past it by a changing
// offset.
RigidTransform CameraAt(int frame, double depression_deg) {
  const double range_m = 25, down = Radians(depression_deg);
  const Eigen::Vector3d away(0.001, -range_m * std::cos(down), range_m * std::sin(down));
  const double t = frame / kRate_hz;
  const Eigen::Vector3d past(2 * std::sin(t), 1.5 * std::cos(1.3 * t), 0);
  return LookingFrom(CarAt(frame) + away, CarAt(frame) + past);
}

// Sums over the frames of several flights.
struct Errors {
  double nees = 0, position2 = 0, velocity2 = 0;
  int frames = 0;
};

// A flight whose navigation has the errors that the pipeline expects, over ground of another height
// than it is given.
void Follow(int seed, double depression_deg, Errors* errors) {
  constexpr int kFrames = 60, kSettled = 40;
  constexpr double kGroundSigma_m = 0.1;
  const MeasurementNoise noise;
  Random random(static_cast<std::uint64_t>(seed));
  const auto turn = [&](double sigma_deg) {
    const Eigen::Vector3d axis(random.Normal(), random.Normal(), random.Normal());
    return RotationBy(Radians(sigma_deg) * axis);
  };
  FollowScene scene(static_cast<std::uint64_t>(10 * seed));
  FollowPipeline pipeline(FollowCalibration(), {.ground_height_m = kGroundSigma_m * random.Normal(),
                                                .ground_sigma_m = kGroundSigma_m});
  const Eigen::Quaterniond bias = turn(noise.attitude_bias_deg);
  for (int i = 0; i < kFrames; ++i) {
    const RigidTransform camera = CameraAt(i, depression_deg);
    RigidTransform reported = camera;
    reported.rotation = bias * turn(noise.attitude_sigma_deg) * camera.rotation;
    pipeline.AddPose({TimeOf(i), reported});
    const cv::Mat image = scene.Take(camera, CarAt(i));
    const FollowObservation seen =
        i == 0 ? pipeline.Mark(image, TimeOf(i), scene.BoxOf(camera, CarAt(i)))
               : pipeline.Process(image, TimeOf(i));
    ASSERT_EQ(seen.region->state, RegionState::kFollowing) << i;
    ASSERT_TRUE(seen.place) << i;
    if (i < kSettled) continue;
    ASSERT_TRUE(seen.target) << i;
    const TurnState& motion = seen.target->motion;
    const Eigen::Vector2d error = (motion.position() - CarAt(i)).head<2>();
    errors->nees += error.dot(motion.covariance.topLeftCorner<2, 2>().inverse() * error);
    errors->position2 += error.squaredNorm();
    errors->velocity2 += (motion.velocity() - Eigen::Vector3d(kSpeed_mps, 0, 0)).squaredNorm();
    ++errors->frames;
  }
}

class FollowPipelineDepression : public testing::TestWithParam<double> {};
INSTANTIATE_TEST_SUITE_P(Degrees, FollowPipelineDepression, testing::Values(75, 45, 25));

TEST_P(FollowPipelineDepression, LocatesCarOnTheGround) {
  Errors errors;
  for (int seed = 1; seed <= 4; ++seed) {
    ASSERT_NO_FATAL_FAILURE(Follow(seed, GetParam(), &errors)) << "seed " << seed;
  }
  EXPECT_LT(std::sqrt(errors.position2 / errors.frames), 1) << "m, of a car of 4 m";
  EXPECT_LT(std::sqrt(errors.velocity2 / errors.frames), 0.6) << "m/s";
  EXPECT_LT(errors.nees / errors.frames, 4) << "2 is right";
  EXPECT_GT(errors.nees / errors.frames, 0.2);
}

TEST(FollowPipelineTest, NothingIsFollowedBeforeTheMark) {
  FollowPipeline pipeline(FollowCalibration(), {});
  FollowScene scene(1);
  const RigidTransform camera = CameraAt(0, 45);
  pipeline.AddPose({TimeOf(0), camera});
  const FollowObservation seen = pipeline.Process(scene.Take(camera, CarAt(0)), TimeOf(0));
  EXPECT_FALSE(seen.region);
  EXPECT_TRUE(seen.world_from_camera);
  EXPECT_EQ(seen.track_state, TrackState::kSearching);
}

// From 1.2 m above the ground what stands 65 m away is seen 1.06 degrees below the horizon.
TEST(FollowPipelineTest, NearTheHorizonOnlyTheBearingIsKnown) {
  FollowPipeline pipeline(FollowCalibration(), {});
  FollowScene scene(2);
  const Eigen::Vector3d car(0, 65, 0);
  const RigidTransform camera = LookingFrom({0, 0, 1.2}, car);
  pipeline.AddPose({TimeOf(0), camera});
  const FollowObservation seen =
      pipeline.Mark(scene.Take(camera, car), TimeOf(0), scene.BoxOf(camera, car));
  ASSERT_TRUE(seen.bearing);
  EXPECT_NEAR(seen.bearing->y(), 1, 0.01);
  EXPECT_FALSE(seen.place);
  EXPECT_FALSE(seen.target);
}

TEST(FollowPipelineTest, HeightOfGroundCountsFromItsZero) {
  FollowPipeline pipeline(FollowCalibration(), {.ground_height_m = 0.5});
  pipeline.SetGroundZero(2);
  FollowScene scene(4);
  const RigidTransform camera = CameraAt(0, 45);
  RigidTransform raised = camera;
  raised.translation.z() += 2.5;
  pipeline.AddPose({TimeOf(0), raised});
  const FollowObservation seen =
      pipeline.Mark(scene.Take(camera, CarAt(0)), TimeOf(0), scene.BoxOf(camera, CarAt(0)));
  ASSERT_TRUE(seen.place);
  EXPECT_NEAR(seen.place->position.z(), 2.5, 1e-9);
  EXPECT_LT((seen.place->position - CarAt(0)).head<2>().norm(), 1);
}

TEST(FollowPipelineTest, WithoutPosesTheRegionIsFollowed) {
  FollowPipeline pipeline(FollowCalibration(), {});
  FollowScene scene(3);
  for (int i = 0; i < 10; ++i) {
    const RigidTransform camera = CameraAt(i, 45);
    const cv::Mat image = scene.Take(camera, CarAt(i));
    const FollowObservation seen =
        i == 0 ? pipeline.Mark(image, TimeOf(i), scene.BoxOf(camera, CarAt(i)))
               : pipeline.Process(image, TimeOf(i));
    ASSERT_EQ(seen.region->state, RegionState::kFollowing) << i;
    EXPECT_FALSE(seen.bearing);
    EXPECT_FALSE(seen.target);
  }
}

}  // namespace
}  // namespace kestrel
