// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/simulation/labelled_images/scene_renderer.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <optional>
#include <vector>

#include <Eigen/Geometry>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kestrel/core/base/error.h"
#include "kestrel/core/camera/paper_camera.h"
#include "kestrel/core/geometry/angles.h"
#include "kestrel/simulation/labelled_images/landing_stills.h"
#include "kestrel/simulation/scene/landing_drawings.h"

namespace kestrel {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using ::testing::HasSubstr;

Scene PatternScene() {
  Scene scene;
  scene.ground_texture = 0;
  scene.layers.push_back({SquareBoard({0, 0}, 3, 0), 0.9});
  scene.layers.push_back({LandingPatternInk(LandingPattern()), 0.1});
  return scene;
}

ImagingOptions CleanImaging() {
  ImagingOptions imaging;
  imaging.black_level = 0;
  imaging.white_level = 250;
  return imaging;
}

LensOptions ClearLens() {
  LensOptions lens;
  lens.vignette = 0;
  return lens;
}

// Returns a pose of the pattern 'range_m' away in direction 'ray', tilted by 'tilt' (rad) from
// facing the camera.
RigidTransform FacingPose(const Vector3d& ray, double range_m, double tilt) {
  const Eigen::Quaterniond facing =
      Eigen::Quaterniond::FromTwoVectors(Vector3d::UnitZ(), -ray.normalized());
  return {facing * Eigen::AngleAxisd(tilt, Vector3d(0.6, 0.8, 0)), range_m * ray.normalized()};
}

RigidTransform NadirPose(double altitude_m) { return FacingPose(Vector3d::UnitZ(), altitude_m, 0); }

double Interpolate(const cv::Mat& image, const Vector2d& pixel) {
  const int u = static_cast<int>(std::floor(pixel.x()));
  const int v = static_cast<int>(std::floor(pixel.y()));
  const double x = pixel.x() - u;
  const double y = pixel.y() - v;
  const auto at = [&image](int column, int row) {
    return static_cast<double>(image.at<std::uint8_t>(row, column));
  };
  return (1 - y) * ((1 - x) * at(u, v) + x * at(u + 1, v)) +
         y * ((1 - x) * at(u, v + 1) + x * at(u + 1, v + 1));
}

// Returns the place at which the profile through 'pixel' along 'normal' changes from its first to
// its last level, computed from the area under it; px from 'pixel'.
double EdgeOffset(const cv::Mat& image, const Vector2d& pixel, const Vector2d& normal) {
  constexpr double kReach = 3.5;
  constexpr int kSteps = 141;
  std::vector<double> profile;
  for (int i = 0; i < kSteps; ++i) {
    profile.push_back(Interpolate(image, pixel + kReach * (2.0 * i / (kSteps - 1) - 1) * normal));
  }
  double area = 0;
  for (const double value : profile) {
    area += (value - profile.back()) / (profile.front() - profile.back()) - 0.5;
  }
  return area * 2 * kReach / (kSteps - 1);
}

struct EdgeErrors {
  int count = 0;
  double mean = 0;
  double max_abs = 0;
};

// Returns the pixel of a point of the pattern's plane; nothing outside of the lens.
using ShownAt = std::function<std::optional<Vector2d>(const Vector2d& point)>;

// Returns the errors of the ring's two edges in the image.
EdgeErrors MeasureRing(const ShownAt& shown_at, const cv::Mat& image) {
  const LandingPattern pattern;
  EdgeErrors errors;
  for (const double radius : {pattern.outer_radius_m(), pattern.inner_radius_m()}) {
    for (double angle = 0.02; angle < 2 * kPi; angle += 0.05) {
      const double from_arm = std::remainder(angle, kPi / 2) * radius;
      if (radius < 0.45 && std::abs(from_arm) < 0.1) continue;  // the arms end near the inner edge
      constexpr double kStep = 1e-4;
      const Vector2d outward(std::cos(angle), std::sin(angle));
      const Vector2d tangent(-outward.y(), outward.x());
      const auto pixel = shown_at(radius * outward);
      const auto beyond = shown_at((radius + kStep) * outward);
      const auto next = shown_at(radius * outward + kStep * tangent);
      if (!pixel || !beyond || !next) continue;
      const Vector2d margin = pixel->cwiseMin(Vector2d(751, 479) - *pixel);
      if (margin.minCoeff() < 6) continue;
      // The edge's normal in the image is perpendicular to the image of the tangent.
      const Vector2d along = (*next - *pixel).normalized();
      Vector2d normal(-along.y(), along.x());
      if (normal.dot(*beyond - *pixel) < 0) normal = -normal;
      const double error = EdgeOffset(image, *pixel, normal);
      ++errors.count;
      errors.mean += error;
      errors.max_abs = std::max(errors.max_abs, std::abs(error));
    }
  }
  errors.mean /= errors.count;
  return errors;
}

// The same for a flat print that stands still.
EdgeErrors MeasureRing(const CameraModel& camera, const RigidTransform& camera_from_target,
                       const cv::Mat& image) {
  return MeasureRing(
      [&](const Vector2d& point) -> std::optional<Vector2d> {
        Vector2d pixel;
        const Vector3d on_plane(point.x(), point.y(), 0);
        if (camera.Project(camera_from_target * on_plane, &pixel) != ProjectionStatus::kOk) {
          return std::nullopt;
        }
        return pixel;
      },
      image);
}

TEST(SceneRendererTest, EdgesLieAtTheirProjection) {
  const CameraModel camera(PaperCamera());
  const SceneRenderer renderer(camera, ClearLens());
  for (const double tilt : {0.0, 0.5, 0.9}) {
    const RigidTransform pose = FacingPose(Vector3d(0.1, -0.05, 1), 1.3, tilt);
    const EdgeErrors errors =
        MeasureRing(camera, pose, renderer.Render(PatternScene(), pose, CleanImaging()));
    EXPECT_GT(errors.count, 200);
    EXPECT_LT(std::abs(errors.mean), 0.01) << "tilt " << tilt;
    EXPECT_LT(errors.max_abs, 0.05) << "tilt " << tilt;
  }
}

TEST(SceneRendererTest, EdgesLieRightPast80Degrees) {
  const CameraModel camera(PaperCamera());
  const SceneRenderer renderer(camera, ClearLens());
  const double angle = 82 * kPi / 180;  // the image's corner is at 89 degrees
  const Vector3d ray(0.85 * std::sin(angle), 0.5268 * std::sin(angle), std::cos(angle));
  const RigidTransform pose = FacingPose(ray, 3.2, 0.4);
  const EdgeErrors errors =
      MeasureRing(camera, pose, renderer.Render(PatternScene(), pose, CleanImaging()));
  EXPECT_GE(errors.count, 100);
  EXPECT_LT(std::abs(errors.mean), 0.01);
  EXPECT_LT(errors.max_abs, 0.06);
}

TEST(SceneRendererTest, MotionBlursWithoutMovingEdges) {
  const CameraModel camera(PaperCamera());
  const SceneRenderer renderer(camera, ClearLens());
  const RigidTransform pose = NadirPose(1.3);
  ImagingOptions imaging = CleanImaging();
  const cv::Mat sharp = renderer.Render(PatternScene(), pose, imaging);
  imaging.velocity_in_camera = Vector3d(2, 1, 0);  // 2.2 px in 5 ms
  const cv::Mat moved = renderer.Render(PatternScene(), pose, imaging);
  const EdgeErrors errors = MeasureRing(camera, pose, moved);
  EXPECT_LT(std::abs(errors.mean), 0.02);
  EXPECT_LT(errors.max_abs, 0.1);
  EXPECT_GT(cv::norm(sharp, moved, cv::NORM_INF), 15);
}

TEST(SceneRendererTest, SheetFollowsItsRelief) {
  const CameraModel camera(PaperCamera());
  const SceneRenderer renderer(camera, ClearLens());
  const RigidTransform pose = FacingPose(Vector3d(0.1, -0.05, 1), 1.1, 0.6);
  for (const Relief& relief :
       {Relief{1.5, 0.045, 0}, Relief{1.5, -0.045, 0}, Relief{1.5, 0, 0.03}}) {
    Scene scene = PatternScene();
    scene.relief = relief;
    const cv::Mat image = renderer.Render(scene, pose, CleanImaging());
    const EdgeErrors errors = MeasureRing(
        [&](const Vector2d& point) {
          Vector2d pixel;
          camera.Project(pose * Vector3d(point.x(), point.y(), relief.HeightAt(point)), &pixel);
          return pixel;
        },
        image);
    EXPECT_GT(errors.count, 200);
    EXPECT_LT(std::abs(errors.mean), 0.02);
    EXPECT_LT(errors.max_abs, 0.12);
    EXPECT_GT(MeasureRing(camera, pose, image).max_abs, 1) << "it is not where a flat one would be";
  }
}

// The view moves during the read-out: by 5 % of the number of rows from the first to the last.
TEST(SceneRendererTest, RollingShutterSkewsMovingScene) {
  const CameraModel camera(PaperCamera());
  const SceneRenderer renderer(camera, ClearLens());
  const RigidTransform pose = NadirPose(1.3);
  constexpr double kSkew = 0.05;
  ImagingOptions imaging = CleanImaging();
  imaging.exposure_s = 0;
  imaging.readout_s = 0.03;
  const double shift_m = kSkew * 480 / 261 * 1.3;  // while all rows are read out
  imaging.velocity_in_camera = Vector3d(shift_m / imaging.readout_s, 0, 0);
  const cv::Mat image = renderer.Render(PatternScene(), pose, imaging);
  Vector2d center;
  camera.Project(pose.translation, &center);
  const auto skewed = [&](const Vector2d& point) {
    Vector2d pixel;
    camera.Project(pose * Vector3d(point.x(), point.y(), 0), &pixel);
    pixel.x() += kSkew * (pixel.y() - center.y());
    return pixel;
  };
  // A shift of the plane shifts the image, except for the lens's distortion.
  const EdgeErrors errors = MeasureRing(skewed, image);
  EXPECT_GT(errors.count, 200);
  EXPECT_LT(errors.max_abs, 0.5);
  EXPECT_GT(MeasureRing(camera, pose, image).max_abs, 1.5) << "half of the shift, across the ring";
}

TEST(SceneRendererTest, SameInputGivesSameBytes) {
  const SceneRenderer renderer{CameraModel(PaperCamera())};
  Scene scene = PatternScene();
  scene.ground_texture = 0.5;
  ImagingOptions imaging;
  imaging.read_noise = 2;
  const cv::Mat first = renderer.Render(scene, NadirPose(2), imaging);
  EXPECT_EQ(cv::norm(first, renderer.Render(scene, NadirPose(2), imaging), cv::NORM_INF), 0);
  scene.texture_seed = 2;
  EXPECT_GT(cv::norm(first, renderer.Render(scene, NadirPose(2), imaging), cv::NORM_INF), 10);
}

struct Level {
  double mean;
  double sigma;
};

Level LevelIn(const cv::Mat& image, const cv::Rect& area) {
  cv::Scalar mean;
  cv::Scalar sigma;
  cv::meanStdDev(image(area), mean, sigma);
  return {mean[0], sigma[0]};
}

// Ground of one level in the whole image.
Scene FlatScene(double reflectance) {
  Scene scene;
  scene.ground_reflectance = reflectance;
  scene.ground_texture = 0;
  return scene;
}

TEST(SceneRendererTest, NoiseHasRequestedSpread) {
  const SceneRenderer renderer(CameraModel(PaperCamera()), ClearLens());
  const cv::Rect middle(276, 140, 200, 200);
  ImagingOptions imaging;
  imaging.black_level = 20;
  imaging.white_level = 220;
  imaging.read_noise = 4;
  Level level = LevelIn(renderer.Render(FlatScene(0.5), NadirPose(2), imaging), middle);
  EXPECT_NEAR(level.mean, 120, 0.1);
  EXPECT_NEAR(level.sigma, 4, 0.1);
  imaging.read_noise = 0;
  imaging.shot_noise = 3;
  level = LevelIn(renderer.Render(FlatScene(0.5), NadirPose(2), imaging), middle);
  EXPECT_NEAR(level.sigma, 3, 0.1);
  level = LevelIn(renderer.Render(FlatScene(0.125), NadirPose(2), imaging), middle);
  EXPECT_NEAR(level.mean, 45, 0.1);
  EXPECT_NEAR(level.sigma, 1.5, 0.1);
}

TEST(SceneRendererTest, LightShadowHazeAndGlareSetLevel) {
  const SceneRenderer renderer(CameraModel(PaperCamera()), ClearLens());
  const RigidTransform pose = NadirPose(2);  // y of the pattern points up in the image
  const auto at = [&](const Scene& scene, const ImagingOptions& imaging, int u, int v) {
    return static_cast<int>(renderer.Render(scene, pose, imaging).at<std::uint8_t>(v, u));
  };
  ImagingOptions imaging = CleanImaging();
  Scene scene = FlatScene(0.8);
  EXPECT_EQ(at(scene, imaging, 376, 100), 200);

  Vector2d lit;
  Vector2d dark;
  renderer.camera().Project(pose * Vector3d(0.02, 0, 0), &lit);
  renderer.camera().Project(pose * Vector3d(-0.02, 0, 0), &dark);
  ASSERT_GT((lit - dark).norm(), 4);
  scene.shadows.push_back({Drawing().Add(Drawing::Bar{{-50, 0}, {1, 0}, 50, 50}), 0.25});
  EXPECT_NEAR(at(scene, imaging, std::lround(lit.x()), std::lround(lit.y())), 200, 1);
  EXPECT_NEAR(at(scene, imaging, std::lround(dark.x()), std::lround(dark.y())), 50, 1);
  scene.shadows.clear();

  imaging.haze = 0.5;
  imaging.haze_radiance = 0.4;
  EXPECT_EQ(at(scene, imaging, 376, 240), 150);
  imaging.haze = 0;
  imaging.gradient = {1, 0};
  EXPECT_NEAR(at(scene, imaging, 751 - 188, 240), 250, 1);
  EXPECT_NEAR(at(scene, imaging, 188, 240), 150, 1);
  imaging.gradient = {0, 0};
  scene.ground_reflectance = 0.2;
  scene.glares.push_back({{0, 0}, 0.2, 0.6});
  EXPECT_NEAR(at(scene, imaging, 376, 240), 200, 1);
  EXPECT_NEAR(at(scene, imaging, 100, 240), 50, 1);
}

TEST(SceneRendererTest, SkyIsAboveHorizonAndLensEdgeIsDark) {
  LensOptions lens = ClearLens();
  lens.half_angle_deg = 60;  // 265 px
  const SceneRenderer renderer(CameraModel(PaperCamera()), lens);
  // The optical axis on the horizon, the sky in the upper half of the image.
  const RigidTransform level = {Eigen::Quaterniond(Eigen::AngleAxisd(kPi / 2, Vector3d::UnitX())),
                                Vector3d(0, 2, 0)};
  Scene scene = FlatScene(0.2);
  scene.sky_radiance = 0.8;
  const cv::Mat image = renderer.Render(scene, level, CleanImaging());
  EXPECT_EQ(image.at<std::uint8_t>(200, 376), 200);
  EXPECT_EQ(image.at<std::uint8_t>(280, 376), 50);
  EXPECT_EQ(image.at<std::uint8_t>(200, 376 - 260), 200);
  EXPECT_EQ(image.at<std::uint8_t>(200, 376 - 275), 0);
}

TEST(SceneRendererTest, AirframeCoversScene) {
  LensOptions lens = ClearLens();
  lens.airframe.Add(Drawing::Ring{{300, 400}, 20});
  lens.airframe_radiance = 0.4;
  const SceneRenderer renderer(CameraModel(PaperCamera()), lens);
  const cv::Mat image = renderer.Render(FlatScene(0.8), NadirPose(3), CleanImaging());
  EXPECT_EQ(image.at<std::uint8_t>(400, 315), 100);
  EXPECT_EQ(image.at<std::uint8_t>(400, 325), 200);
}

template <class Action>
std::string ErrorOf(Action action) {
  try {
    action();
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(SceneRendererTest, RefusesInvalidInput) {
  const CameraModel camera(PaperCamera());
  LensOptions lens;
  lens.vignette = -1;
  lens.half_angle_deg = std::nan("");
  const std::string lens_error = ErrorOf([&] { SceneRenderer renderer(camera, lens); });
  EXPECT_THAT(lens_error, HasSubstr("vignette is -1, expected 0 to 1"));
  EXPECT_THAT(lens_error, HasSubstr("half_angle_deg is nan"));

  const SceneRenderer renderer(camera);
  ImagingOptions imaging;
  imaging.white_level = 3;
  EXPECT_THAT(ErrorOf([&] { renderer.Render(Scene(), NadirPose(1), imaging); }),
              HasSubstr("white_level is 3, expected more than black_level, 5"));
  Scene scene = PatternScene();
  scene.layers[1].reflectance = 1.5;
  EXPECT_THAT(ErrorOf([&] { renderer.Render(scene, NadirPose(1), ImagingOptions()); }),
              HasSubstr("layers[1].reflectance is 1.5"));
  const RigidTransform from_below = {Eigen::Quaterniond::Identity(), Vector3d(0, 0, 1)};
  EXPECT_THAT(ErrorOf([&] { renderer.Render(Scene(), from_below, ImagingOptions()); }),
              HasSubstr("above the pattern's plane"));
}

}  // namespace
}  // namespace kestrel
