// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/calibration/lens/lens_calibration.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kestrel/calibration/lens/lens_difference.h"
#include "kestrel/calibration/lens/lens_projection.h"
#include "kestrel/calibration/lens/test_lens_views.h"
#include "kestrel/calibration/lens/unlike_views.h"
#include "kestrel/core/base/error.h"
#include "kestrel/core/base/random.h"
#include "kestrel/core/base/robust_statistics.h"
#include "kestrel/core/camera/test_cameras.h"
#include "kestrel/core/geometry/angles.h"
#include "kestrel/vision/landing/test_prints.h"

namespace kestrel {
namespace {

using ::testing::HasSubstr;

double MedianDifferencePx(const CameraIntrinsics& truth, const CameraIntrinsics& estimate,
                          double max_angle_deg) {
  return MedianInPlace(
      LensDifferencePx(CameraModel(truth), CameraModel(estimate), max_angle_deg * kPi / 180));
}

// A guess that is wrong in all parameters.
CameraIntrinsics Guess(CameraIntrinsics camera, double zoom) {
  camera.fx_px *= zoom;
  camera.fy_px = camera.fx_px;
  camera.cx_px = 0.5 * (camera.width_px - 1);
  camera.cy_px = 0.5 * (camera.height_px - 1);
  std::fill(camera.distortion.begin(), camera.distortion.end(), 0.0);
  return camera;
}

CameraIntrinsics Pinhole() { return {640, 480, 400, 400, 325, 236, DistortionModel::kNone, {}}; }

// Message of EstimateLens when it refuses; empty when it does not.
std::string Refusal(const std::vector<LensView>& views, const CameraIntrinsics& start) {
  try {
    EstimateLens(views, start);
    return "";
  } catch (const InputError& error) {
    return error.what();
  }
}

TEST(EstimateLensTest, EstimatesFisheyeLens) {
  const CameraIntrinsics truth = PaperCamera();
  const auto views = MakeLensViews(truth, {.count = 60, .seed = 1, .noise_px = 0.05});
  const LensCalibration lens = EstimateLens(views, Guess(truth, 1.2));
  EXPECT_EQ(lens.intrinsics.distortion_model, DistortionModel::kEquidistant);
  EXPECT_NEAR(lens.intrinsics.fx_px / truth.fx_px, 1, 0.003);
  EXPECT_LT(MedianDifferencePx(truth, lens.intrinsics, 80), 0.1);
  EXPECT_GT(lens.coverage.max_angle_deg, 70);
  EXPECT_EQ(lens.outliers, 0);
}

TEST(EstimateLensTest, EstimatesRadialTangentialLensFromPinholeStart) {
  const CameraIntrinsics truth = EurocCamera();
  const auto views = MakeLensViews(truth, {.count = 40, .seed = 2});
  CameraIntrinsics start = Guess(truth, 0.8);
  start.distortion_model = DistortionModel::kNone;
  start.distortion.clear();
  const LensCalibration lens = EstimateLens(views, start);
  EXPECT_EQ(lens.intrinsics.distortion_model, DistortionModel::kRadialTangential);
  EXPECT_NEAR(lens.intrinsics.fx_px / truth.fx_px, 1, 0.003);
  EXPECT_LT(MedianDifferencePx(truth, lens.intrinsics, 45), 0.1);
}

// A model other than the lens's own is a good approximation at best.
TEST(EstimateLensTest, EstimatesRequestedDistortionModel) {
  const auto views = MakeLensViews(EurocCamera(), {.count = 30, .seed = 3});
  const LensCalibration lens =
      EstimateLens(views, Guess(EurocCamera(), 1), DistortionModel::kEquidistant);
  EXPECT_EQ(lens.intrinsics.distortion_model, DistortionModel::kEquidistant);
  EXPECT_LT(MedianDifferencePx(EurocCamera(), lens.intrinsics, 40), 0.6);
}

TEST(EstimateLensTest, EstimatesPinholeWithoutDistortion) {
  const auto views = MakeLensViews(Pinhole(), {.count = 40, .seed = 4});
  const LensCalibration lens = EstimateLens(views, Guess(Pinhole(), 1.2));
  EXPECT_EQ(lens.intrinsics.distortion_model, DistortionModel::kNone);
  EXPECT_EQ(lens.intrinsics.fx_px, lens.intrinsics.fy_px);
  EXPECT_LT(MedianDifferencePx(Pinhole(), lens.intrinsics, 45), 0.15);
}

TEST(EstimateLensTest, EstimatesDifferentFocalLengths) {
  CameraIntrinsics truth = Pinhole();
  truth.fy_px = 1.02 * truth.fx_px;
  const auto views = MakeLensViews(truth, {.count = 40, .seed = 5});
  const LensCalibration lens = EstimateLens(views, Guess(truth, 1));
  EXPECT_NEAR(lens.intrinsics.fy_px / lens.intrinsics.fx_px, 1.02, 0.002);
}

TEST(EstimateLensTest, ErrorsMatchStandardDeviations) {
  constexpr int kSets = 12;
  double squares = 0;
  for (int seed = 0; seed < kSets; ++seed) {
    const auto views = MakeLensViews(Pinhole(), {.count = 24, .seed = 100 + seed});
    const LensCalibration lens = EstimateLens(views, Guess(Pinhole(), 1), DistortionModel::kNone);
    const double error = (lens.intrinsics.fx_px - Pinhole().fx_px) / lens.fit.sigmas(kFocal);
    squares += error * error;
  }
  // 99.8 % of a chi-square variable with 12 degrees of freedom lie between 2.2 and 32.9.
  EXPECT_GT(squares, 2.2);
  EXPECT_LT(squares, 32.9);
}

TEST(EstimateLensTest, RejectsOutlierView) {
  auto views = MakeLensViews(Pinhole(), {.count = 30, .seed = 6});
  Random random(7);
  for (LensEdge& edge : views[9].edges) edge.pixel += 8 * random.Normal() * edge.across;
  const LensCalibration lens = EstimateLens(views, Guess(Pinhole(), 1));
  EXPECT_EQ(lens.outliers, 1);
  for (const LensView& view : lens.views) EXPECT_NE(view.name, views[9].name);
  EXPECT_NEAR(lens.intrinsics.fx_px / Pinhole().fx_px, 1, 0.005);
}

TEST(EstimateLensTest, RefusesLevelViewsAndAdvisesToTilt) {
  const auto views = MakeLensViews(Pinhole(), {.count = 40, .seed = 8, .max_tilt_deg = 1});
  EXPECT_THAT(Refusal(views, Guess(Pinhole(), 1)), HasSubstr("tilt the camera"));
}

TEST(EstimateLensTest, WarnsOfFewViews) {
  const auto few = MakeLensViews(Pinhole(), {.count = 12, .seed = 16});
  EXPECT_THAT(EstimateLens(few, Guess(Pinhole(), 1), DistortionModel::kNone).warnings,
              ::testing::Contains(HasSubstr("12 views are few")));
  const auto many = MakeLensViews(Pinhole(), {.count = 40, .seed = 16});
  EXPECT_THAT(EstimateLens(many, Guess(Pinhole(), 1), DistortionModel::kNone).warnings,
              ::testing::IsEmpty());
}

TEST(EstimateLensTest, RefusesTooFewViews) {
  const auto views = MakeLensViews(Pinhole(), {.count = 7, .seed = 9});
  EXPECT_THAT(Refusal(views, Guess(Pinhole(), 1)), HasSubstr("in 7 of them"));
}

TEST(EstimateLensTest, RefusesViewsInMiddleOnly) {
  const auto views = MakeLensViews(Pinhole(), {.count = 40, .seed = 10, .share_of_image = 0.05});
  EXPECT_THAT(Refusal(views, Guess(Pinhole(), 1)), HasSubstr("only in the middle of the image"));
}

TEST(EstimateLensTest, StartsFromRationalLens) {
  const CameraIntrinsics truth = Pinhole();
  const auto views = MakeLensViews(truth, {.count = 40, .seed = 14});
  CameraIntrinsics start = Guess(truth, 1.1);
  start.distortion_model = DistortionModel::kRadialTangential;
  start.distortion = {0.1, 0, 0, 0, 0, 0.12, 0, 0};
  const LensCalibration lens = EstimateLens(views, start);
  EXPECT_LT(MedianDifferencePx(truth, lens.intrinsics, 45), 0.2);
}

TEST(UnlikeViewsTest, SelectsDifferentViews) {
  // A hovering camera, and three views from elsewhere.
  std::vector<LensView> views = MakeLensViews(Pinhole(), {.count = 4, .seed = 15});
  const LensView hovering = views[0];
  views.insert(views.begin() + 2, 20, hovering);
  const std::vector<LensView> unlike = UnlikeViews(views, 4, 640);
  std::vector<std::string> names;
  for (const LensView& view : unlike) names.push_back(view.name);
  EXPECT_THAT(names, ::testing::ElementsAre("view 0", "view 1", "view 2", "view 3"));
  EXPECT_EQ(UnlikeViews(views, 100, 640).size(), 24u);
}

TEST(LensCoverageTest, DescribesFieldsWithoutEdges) {
  LensCoverage coverage;
  coverage.edges.fill(5);
  coverage.max_angle_deg = 62.3;
  EXPECT_EQ(coverage.InWords(),
            "edges lie in 48 of 48 fields of the image, to 62 degrees from the optical axis");
  coverage.edges[0] = 0;
  EXPECT_THAT(coverage.InWords(),
              HasSubstr("47 of 48 fields of the image, to 62 degrees from the optical axis; the "
                        "upper left corner of the image holds no edges: distortion beyond 62 "
                        "degrees is extrapolated"));
  for (const int field : {7, 40, 47}) coverage.edges[field] = 0;
  for (int column = 1; column < 7; ++column) coverage.edges[column] = 0;
  EXPECT_THAT(coverage.InWords(), HasSubstr("the corners and the top of the image hold no edges"));
}

TEST(LensCoverageTest, CountsEdgesPerField) {
  LensView view;
  for (const Eigen::Vector2d& pixel :
       std::vector<Eigen::Vector2d>{{0, 0}, {639, 479}, {325, 236}}) {
    view.edges.push_back({{0, 0}, pixel, {1, 0}});
  }
  const LensCoverage coverage = CoverageOf({&view, 1}, CameraModel(Pinhole()));
  EXPECT_EQ(coverage.fields(), 3);
  EXPECT_EQ(coverage.EdgesAt(0, 0), 1);
  EXPECT_EQ(coverage.EdgesAt(7, 5), 1);
  EXPECT_EQ(coverage.EdgesAt(4, 2), 1);
}

TEST(ProjectThroughLensTest, AgreesWithCameraModel) {
  Random random(12);
  for (const TestCamera& test : TestCameras()) {
    CameraIntrinsics camera = test.intrinsics;
    if (camera.distortion.size() > 5) continue;
    std::array<double, kLensParameters> parameters{camera.fx_px, camera.fy_px / camera.fx_px,
                                                   camera.cx_px, camera.cy_px};
    std::copy(camera.distortion.begin(), camera.distortion.end(), parameters.begin() + kDistortion);
    const CameraModel model(camera);
    for (int i = 0; i < 100; ++i) {
      const Eigen::Vector3d ray =
          RayAt(random.Uniform(0, std::min(1.3, model.max_angle())), random.Uniform(0, 2 * kPi));
      Eigen::Vector2d expected, pixel;
      ASSERT_NE(model.Project(ray, &expected), ProjectionStatus::kOutsideModel);
      ASSERT_TRUE(
          ProjectThroughLens(camera.distortion_model, parameters.data(), ray.data(), pixel.data()));
      EXPECT_LT((pixel - expected).norm(), 1e-6) << test.name;
    }
  }
}

TEST(LensDifferenceTest, IgnoresRotationOfLens) {
  const CameraIntrinsics truth = Pinhole();
  EXPECT_LT(MedianDifferencePx(truth, truth, 45), 1e-9);
  CameraIntrinsics zoomed = truth;
  zoomed.fx_px = zoomed.fy_px = 1.01 * truth.fx_px;
  EXPECT_GT(MedianDifferencePx(truth, zoomed, 45), 1);
  // A shift of the principal point is nearly a rotation, here by 2 px of 400.
  CameraIntrinsics shifted = truth;
  shifted.cx_px += 2;
  EXPECT_LT(MedianDifferencePx(truth, shifted, 45), 0.6);
}

std::vector<LensImage> DrawViews(int count, std::uint64_t seed) {
  const CameraModel camera = TestPrintCamera();
  const LandingPattern pattern;
  Random random(seed);
  std::vector<LensImage> images;
  for (int i = 0; i < count; ++i) {
    Eigen::Vector3d ray;
    camera.Unproject({random.Uniform(70, 250), random.Uniform(60, 180)}, &ray);
    const RigidTransform pose =
        PrintPose(random.Uniform(1.6, 2.4) / ray.z() * ray, random.Uniform(0.3, 0.8),
                  random.Uniform(0, 2 * kPi), random.Uniform(0, 2 * kPi));
    const cv::Mat image = DrawPrint(camera, pattern, SpokedPrint(pattern, 4), pose);
    images.push_back({"view", AddNoise(image, 2, &random)});
  }
  return images;
}

TEST(CalibrateLensTest, CalibratesFromImagesAlone) {
  const LensCalibration lens = CalibrateLens(DrawViews(24, 13), {});
  EXPECT_GE(lens.views.size(), 20u);
  EXPECT_NEAR(lens.intrinsics.fx_px / TestPrintCamera().intrinsics().fx_px, 1, 0.01);
  EXPECT_LT(lens.fit.RootMeanSquare(), 0.15);
}

TEST(CalibrateLensTest, StopsWhenCallbackThrows) {
  struct Cancelled {};
  const std::vector<LensImage> images(10, LensImage{"gray", cv::Mat(240, 320, CV_8UC1, 90)});
  int looked_at = 0;
  LensCalibrationOptions options;
  options.before_image = [&] {
    if (++looked_at == 5) throw Cancelled();
  };
  EXPECT_THROW(CalibrateLens(images, options), Cancelled);
  EXPECT_EQ(looked_at, 5);
}

TEST(CalibrateLensTest, RefusesUnusableImages) {
  EXPECT_THROW(CalibrateLens({}, {}), InputError);
  const std::vector<LensImage> empty(10, LensImage{"gray", cv::Mat(240, 320, CV_8UC1, 90)});
  EXPECT_THROW(CalibrateLens(empty, {}), InputError);
  LensCalibrationOptions large_start;
  large_start.start = Pinhole();
  EXPECT_THROW(CalibrateLens(empty, large_start), InputError);
  std::vector<LensImage> mixed = empty;
  mixed[3] = {"large.png", cv::Mat(480, 640, CV_8UC1, 90)};
  try {
    CalibrateLens(mixed, {});
    FAIL();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("large.png: the image has 640 x 480 px"));
  }
}

}  // namespace
}  // namespace kestrel
