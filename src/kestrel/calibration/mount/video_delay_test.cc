// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/calibration/mount/video_delay.h"

#include <cmath>
#include <numbers>
#include <optional>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "kestrel/core/base/random.h"
#include "kestrel/core/geometry/angles.h"

namespace kestrel {
namespace {

constexpr double kImageRate_hz = 30;
constexpr double kPoseRate_hz = 50;
constexpr double kHeight_m = 8;

CameraCalibration DownCamera() {
  CameraCalibration camera;
  RigidTransform mount;
  mount.rotation = Eigen::AngleAxisd(kPi, Eigen::Vector3d::UnitX());  // looks down
  camera.body_from_camera = mount;
  return camera;
}

// A hovering multicopter: it tilts, and therefore moves, and it turns.
class TurningFlight {
 public:
  TurningFlight(std::uint64_t seed, double turning) : random_(seed), turning_(turning) {
    for (Wave& wave : waves_) {
      wave.frequency_hz = random_.Uniform(0.08, 0.7);
      wave.phase = random_.Uniform(0, 2 * kPi);
      wave.size = random_.Uniform(0.3, 1);
    }
  }

  RigidTransform WorldFromBody(double s) const {
    RigidTransform pose;
    const double roll = turning_ * Radians(6) * Sum(0, s);
    const double pitch = turning_ * Radians(6) * Sum(3, s);
    const double yaw = turning_ * Radians(12) * Sum(6, s);
    pose.rotation = Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()) *
                    Eigen::AngleAxisd(pitch, Eigen::Vector3d::UnitY()) *
                    Eigen::AngleAxisd(roll, Eigen::Vector3d::UnitX());
    // The tilt accelerates the UAV, and gusts do.
    pose.translation = {0.4 * turning_ * Sum(3, s - 0.3) + 0.5 * Sum(9, s),
                        -0.4 * turning_ * Sum(0, s - 0.3) + 0.5 * Sum(9, s + 2), kHeight_m};
    return pose;
  }

  // Flies from 'from_s' to 'to_s' with images whose stamps are 'late_s' after they were taken.
  void Fly(double from_s, double to_s, double late_s, VideoDelay* delay) {
    const RigidTransform mount = *DownCamera().body_from_camera;
    double image_s = from_s;
    for (double s = from_s; s < to_s; s += 1 / kPoseRate_hz) {
      PoseSample pose{.time = TimeAt(s), .world_from_body = WorldFromBody(s)};
      pose.world_from_body.rotation =
          pose.world_from_body.rotation *
          Eigen::AngleAxisd(Radians(0.05) * random_.Normal(), Eigen::Vector3d::UnitX());
      delay->Add(pose);
      for (; image_s < s - late_s; image_s += 1 / kImageRate_hz) {
        if (random_.Chance(0.1)) continue;  // it was lost
        const double before_s = image_s - 1 / kImageRate_hz;
        const RigidTransform step =
            (WorldFromBody(before_s) * mount).Inverse() * (WorldFromBody(image_s) * mount);
        const Eigen::AngleAxisd turned(step.rotation);
        const Eigen::Vector3d past(-step.translation.y(), step.translation.x(), 0);
        const Eigen::Vector3d noise(random_.Normal(), random_.Normal(), 2 * random_.Normal());
        delay->Add(TimeAt(before_s + late_s), TimeAt(image_s + late_s),
                   turned.angle() * turned.axis() + past / kHeight_m + Radians(0.05) * noise);
      }
    }
  }

 private:
  struct Wave {
    double frequency_hz, phase, size;
  };
  static Time TimeAt(double s) { return Time(std::chrono::seconds(100)) + DurationFromSeconds(s); }
  double Sum(int first, double s) const {
    double sum = 0;
    for (int i = first; i < first + 3; ++i) {
      const Wave& wave = waves_[i];
      sum += wave.size * std::sin(2 * kPi * wave.frequency_hz * s + wave.phase);
    }
    return sum;
  }

  Random random_;
  double turning_;
  Wave waves_[12];
};

TEST(VideoDelayTest, OffsetIsThatOfImages) {
  double squares = 0;
  int flights = 0;
  for (const double late_s : {0.02, 0.1, 0.2, 0.3, 0.6}) {
    for (std::uint64_t seed = 0; seed < 10; ++seed, ++flights) {
      VideoDelay delay(DownCamera());
      TurningFlight(seed, 1).Fly(0, 20, late_s, &delay);
      const auto estimate = delay.Estimate();
      ASSERT_TRUE(estimate) << late_s << " " << seed;
      EXPECT_NEAR(estimate->offset_s, -late_s, 0.01) << seed;
      squares += std::pow((estimate->offset_s + late_s) / estimate->sigma_s, 2);
    }
  }
  EXPECT_LT(squares / flights, 2);
  EXPECT_GT(squares / flights, 0.1);
}

TEST(VideoDelayTest, NothingIsKnownWithoutTurns) {
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    VideoDelay delay(DownCamera());
    EXPECT_FALSE(delay.Estimate());
    TurningFlight(seed, 0).Fly(0, 20, 0.2, &delay);
    EXPECT_FALSE(delay.Estimate()) << seed;
  }
}

TEST(VideoDelayTest, AnotherDelayIsKnownFromImagesAfterIt) {
  VideoDelay delay(DownCamera());
  TurningFlight flight(4, 1);
  flight.Fly(0, 20, 0.2, &delay);
  flight.Fly(20, 32, 0.35, &delay);
  const Time change = Time(std::chrono::seconds(120));
  const auto estimate = delay.Estimate(change);
  ASSERT_TRUE(estimate);
  EXPECT_NEAR(estimate->offset_s, -0.35, 0.01);
  delay.ForgetBefore(change);
  EXPECT_NEAR(delay.Estimate().value().offset_s, -0.35, 0.01);
}

}  // namespace
}  // namespace kestrel
