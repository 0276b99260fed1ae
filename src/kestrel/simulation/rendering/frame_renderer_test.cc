// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/simulation/rendering/frame_renderer.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "kestrel/core/base/options.h"
#include "kestrel/core/geometry/angles.h"
#include "kestrel/simulation/rendering/flight_camera.h"
#include "kestrel/simulation/rendering/test_worlds.h"

namespace kestrel {
namespace {

using Eigen::AngleAxisd;
using Eigen::Vector2d;
using Eigen::Vector3d;

double Bilinear(const cv::Mat& image, const Vector2d& pixel) {
  const int u = static_cast<int>(std::floor(pixel.x()));
  const int v = static_cast<int>(std::floor(pixel.y()));
  const double x = pixel.x() - u;
  const double y = pixel.y() - v;
  return (1 - y) * ((1 - x) * image.at<float>(v, u) + x * image.at<float>(v, u + 1)) +
         y * ((1 - x) * image.at<float>(v + 1, u) + x * image.at<float>(v + 1, u + 1));
}

// Returns the place along 'direction' at which the image is halfway between its values 3 px before
// and 3 px after 'expected', in px from 'expected': computed from the area under the step.
double EdgeOffset(const cv::Mat& image, const Vector2d& expected, const Vector2d& direction) {
  constexpr double kReach_px = 3;
  constexpr int kSteps = 120;
  const double before = Bilinear(image, expected - kReach_px * direction);
  const double after = Bilinear(image, expected + kReach_px * direction);
  double sum = 0;
  for (int i = 0; i < kSteps; ++i) {
    const double way = kReach_px * (2 * (i + 0.5) / kSteps - 1);
    sum += (Bilinear(image, expected + way * direction) - before) / (after - before);
  }
  return kReach_px - 2 * kReach_px * sum / kSteps;
}

// Returns the centre of the pixels darker than 'white' within 20 px of 'near', weighted by the
// difference.
Vector2d DarkCenter(const cv::Mat& image, const Vector2d& near, double white) {
  constexpr double kReach_px = 20;
  Vector2d sum(0, 0);
  double weights = 0;
  for (int v = 0; v < image.rows; ++v) {
    for (int u = 0; u < image.cols; ++u) {
      const double weight = std::max(white - image.at<float>(v, u), 0.0);
      if ((Vector2d(u, v) - near).norm() > kReach_px) continue;
      sum += weight * Vector2d(u, v);
      weights += weight;
    }
  }
  return sum / weights;
}

ShutterOptions Quick(double exposure_s, int rays = 8) {
  return {.exposure_s = exposure_s, .readout_s = 0, .rays_per_pixel = rays};
}

TEST(FrameRendererTest, RingLiesAtProjectedOutline) {
  const double radius = 0.5;
  World world = PlainWorld(0.3);
  AddInkPlate(Drawing().Add(Drawing::Ring{{0, 0}, radius, 0.3}), 1.5, 0.7, &world);
  const Lens lens{CameraModel(SmallFisheye())};
  RigidTransform pose{
      LookingDown({0, 0, 0}).rotation * AngleAxisd(0.3, Vector3d(1, 2, 0).normalized()),
      {0.35, -0.3, 1.9}};
  const cv::Mat image = FrameRenderer(lens, world, Quick(0.001))
                            .Render(
                                0, [&](double) { return pose; }, 1);
  double squares = 0;
  double sum = 0;
  constexpr int kPoints = 180;
  for (int i = 0; i < kPoints; ++i) {
    const double angle = 2 * kPi * i / kPoints;
    const Vector3d out(std::cos(angle), std::sin(angle), 0);
    const RigidTransform camera_from_world = pose.Inverse();
    Vector2d inner;
    Vector2d outer;
    Vector2d edge;
    const Vector3d center(0, 0, 0.7);
    lens.camera().Project(camera_from_world * (center + 0.49 * out), &inner);
    lens.camera().Project(camera_from_world * (center + 0.51 * out), &outer);
    ASSERT_EQ(lens.camera().Project(camera_from_world * (center + radius * out), &edge),
              ProjectionStatus::kOk);
    const double offset = EdgeOffset(image, edge, (outer - inner).normalized());
    sum += offset;
    squares += offset * offset;
  }
  EXPECT_LT(std::sqrt(squares / kPoints), 0.1);
  EXPECT_LT(std::abs(sum / kPoints), 0.02);
}

TEST(FrameRendererTest, FrameTimeIsMiddleOfExposure) {
  World world = PlainWorld(0.8);
  AddInkPlate(Drawing().Add(Drawing::Ring{{0, 0}, 0.25}), 1.5, 0.01, &world);
  const Lens lens{CameraModel(SmallFisheye())};
  // 20 ms at 5 m/s from 2 m: 4 px of motion.
  const Motion moving = [](double time_s) { return LookingDown({5 * time_s, 0.2, 2}); };
  const cv::Mat blurred = FrameRenderer(lens, world, Quick(0.02, 32)).Render(0.004, moving, 1);
  const cv::Mat sharp = FrameRenderer(lens, world, Quick(1e-5, 32)).Render(0.004, moving, 2);
  Vector2d near;
  lens.camera().Project(moving(0.004).Inverse() * Vector3d(0, 0, 0), &near);
  const Vector2d offset = DarkCenter(blurred, near, 0.78) - DarkCenter(sharp, near, 0.78);
  EXPECT_LT(offset.norm(), 0.06) << offset.transpose();
}

TEST(FrameRendererTest, RollingShutterShowsEveryRowAtItsTime) {
  World world = PlainWorld(0.8);
  AddInkPlate(Drawing().Add(Drawing::Ring{{0, 0}, 0.1}), 1.2, 0.01, &world);
  const ShutterOptions rolling{.exposure_s = 0.002, .readout_s = 0.03, .rays_per_pixel = 16};
  // The camera turns about its axis and moves: the upper rows are exposed earlier.
  const Motion moving = [](double time_s) {
    RigidTransform pose = LookingDown({-0.9 + 2 * time_s, 0.5, 2});
    pose.rotation = pose.rotation * AngleAxisd(5 * time_s, Vector3d::UnitZ());
    return pose;
  };
  const FlightCamera camera(
      CameraModel(SmallFisheye()), {}, rolling,
      {.white_level = 250, .read_noise = 0, .shot_noise = 0, .blur_sigma_px = 0}, world, moving);
  cv::Mat image;
  camera.Capture(0, 1, 1).convertTo(image, CV_32F, 1.0 / 250);
  const auto center = camera.Project(0, [](double) { return Vector3d(0, 0, 0.01); });
  ASSERT_TRUE(center);
  EXPECT_LT((DarkCenter(image, *center, 0.75) - *center).norm(), 0.1);
  Vector2d still;
  camera.lens().camera().Project(moving(0).Inverse() * Vector3d(0, 0, 0.01), &still);
  EXPECT_GT((still - *center).norm(), 0.5) << "the test needs a shutter that can be seen";
}

TEST(FrameRendererTest, SunCastsSoftShadowsAtRightPlace) {
  World world = PlainWorld(0.8);
  world.light.direct = 1;
  world.light.to_sun = Vector3d(1, 0, 1).normalized();
  world.light.sun_radius = 0.05;
  // A square metre, 1 m up: its shadow lies 1 m further in -x.
  AddPlate(0, {0, 0, 1}, 0.5, 0.5, 0, PlainPaint(Gray(0.8), 1), &world).visible = false;
  const Lens lens{CameraModel(SmallFisheye())};
  RigidTransform pose = LookingDown({-1, 0, 3});
  const cv::Mat image = FrameRenderer(lens, world, Quick(0.001, 32))
                            .Render(
                                0, [&](double) { return pose; }, 1);
  const auto light = [&](double x, double y) {
    Vector2d pixel;
    lens.camera().Project(pose.Inverse() * Vector3d(x, y, 0), &pixel);
    return Bilinear(image, pixel);
  };
  EXPECT_NEAR(light(-1, 0), 0, 0.01);
  EXPECT_NEAR(light(-1, 0.35), 0, 0.01);
  EXPECT_NEAR(light(-1, 0.7), 0.8, 0.02);
  EXPECT_NEAR(light(-1.7, 0), 0.8, 0.02);
  // At the edge half of the sun is visible.
  EXPECT_NEAR(light(-1, 0.5), 0.4, 0.08);
}

TEST(FrameRendererTest, DrawsSkyHazeAndDarknessOutsideLens) {
  World world = PlainWorld(0.5);
  world.light.sky_radiance = 0.9;
  const Lens lens(CameraModel(SmallFisheye()), {.half_angle_deg = 70, .airframe = {}});
  RigidTransform pose = LookingDown({0, 0, 2});
  // Half of the image looks above the horizon.
  pose.rotation = pose.rotation * AngleAxisd(kPi / 2, Vector3d::UnitX());
  const FrameRenderer renderer(lens, world, Quick(0.001));
  const cv::Mat image = renderer.Render(
      0, [&](double) { return pose; }, 1);
  EXPECT_EQ(image.at<float>(2, 2), 0) << "outside of the lens circle";
  const float low = image.at<float>(100, 120);
  const float high = image.at<float>(60, 120);
  EXPECT_NEAR(std::min(low, high), 0.5, 0.02);
  EXPECT_GT(std::max(low, high), 0.6);

  world.light.haze_per_m = 1;
  world.light.haze_radiance = 0.3;
  const cv::Mat hazy = renderer.Render(
      0,
      [&](double) {
        return LookingDown({0, 0, 2});
      },
      1);
  EXPECT_NEAR(hazy.at<float>(80, 120), 0.5 * std::exp(-2) + 0.3 * (1 - std::exp(-2)), 0.01);
}

TEST(FrameRendererTest, RefusesInvalidOptions) {
  ShutterOptions options{.exposure_s = 0, .readout_s = -1, .rays_per_pixel = 65};
  const auto violations = ViolationsOf(options);
  ASSERT_EQ(violations.size(), 3u);
  EXPECT_EQ(violations[1], "readout_s is -1, expected 0 to 1");
}

}  // namespace
}  // namespace kestrel
