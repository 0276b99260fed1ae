// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/core/camera/camera_model.h"

#include <cmath>
#include <limits>
#include <random>

#include <Eigen/SVD>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/calib3d.hpp>

#include "kestrel/core/base/error.h"
#include "kestrel/core/camera/test_cameras.h"
#include "kestrel/core/geometry/angles.h"

namespace kestrel {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

class EveryCamera : public ::testing::TestWithParam<TestCamera> {
 protected:
  const CameraModel camera_{GetParam().intrinsics};
};
INSTANTIATE_TEST_SUITE_P(, EveryCamera, ::testing::ValuesIn(TestCameras()),
                         [](const auto& info) { return info.param.name; });

// Angles that cover a lens up to its limit, with the last one very near to it.
std::vector<double> AnglesTo(double limit) {
  std::vector<double> angles;
  for (int i = 0; i <= 200; ++i) angles.push_back(limit * 0.999 * i / 200);
  return angles;
}

TEST_P(EveryCamera, UnprojectInvertsProjectUpToRim) {
  for (const double angle : AnglesTo(camera_.max_angle())) {
    for (int step = 0; step < 24; ++step) {
      const Eigen::Vector3d ray = RayAt(angle, step * kPi / 12 + 0.01);
      Eigen::Vector2d pixel;
      Eigen::Matrix<double, 2, 3> jacobian;
      ASSERT_NE(camera_.Project(3.5 * ray, &pixel, &jacobian), ProjectionStatus::kOutsideModel);
      Eigen::Vector3d back;
      ASSERT_NE(camera_.Unproject(pixel, &back), ProjectionStatus::kOutsideModel) << angle;
      EXPECT_NEAR(back.norm(), 1, 1e-14);
      // A pixel is a double: its last bit is an angle that grows where the image hardly moves.
      const double smallest = jacobian.jacobiSvd().singularValues()(1) / camera_.intrinsics().fx_px;
      EXPECT_LT(AngleBetween(back, ray), 1e-12 / std::min(1.0, 3.5 * smallest)) << angle;
    }
  }
}

TEST_P(EveryCamera, JacobianMatchesNumericalDerivative) {
  for (const double angle : AnglesTo(camera_.max_angle() * 0.98)) {
    const Eigen::Vector3d point = 2.0 * RayAt(angle, 1 + 7 * angle);
    Eigen::Vector2d pixel;
    Eigen::Matrix<double, 2, 3> jacobian;
    ASSERT_NE(camera_.Project(point, &pixel, &jacobian), ProjectionStatus::kOutsideModel);
    // Finite differences are accurate only where the image does not move by thousands of pixels.
    if (jacobian.norm() > 1e5) continue;
    constexpr double kStep = 1e-5;
    for (int axis = 0; axis < 3; ++axis) {
      const Eigen::Vector3d step = kStep * Eigen::Vector3d::Unit(axis);
      Eigen::Vector2d ahead, behind;
      camera_.Project(point + step, &ahead);
      camera_.Project(point - step, &behind);
      const Eigen::Vector2d difference = (ahead - behind) / (2 * kStep);
      EXPECT_LT((jacobian.col(axis) - difference).norm(), 1e-6 * (1 + jacobian.norm())) << angle;
    }
  }
}

TEST_P(EveryCamera, JacobianOnAxisEqualsPinhole) {
  Eigen::Vector2d pixel;
  Eigen::Matrix<double, 2, 3> jacobian;
  ASSERT_EQ(camera_.Project({0, 0, 2}, &pixel, &jacobian), ProjectionStatus::kOk);
  Eigen::Matrix<double, 2, 3> expected;
  expected << camera_.intrinsics().fx_px / 2, 0, 0, 0, camera_.intrinsics().fy_px / 2, 0;
  EXPECT_LT((jacobian - expected).norm(), 1e-9);
  EXPECT_EQ(pixel.x(), camera_.intrinsics().cx_px);
}

TEST_P(EveryCamera, AgreesWithOpenCv) {
  const CameraIntrinsics& c = camera_.intrinsics();
  const cv::Matx33d matrix(c.fx_px, 0, c.cx_px, 0, c.fy_px, c.cy_px, 0, 0, 1);
  std::vector<cv::Point3d> points;
  // OpenCV divides by z: it has no rays past 90 degrees, and no limit where the lens folds back.
  for (const double angle : AnglesTo(std::min(camera_.max_angle(), 80 * kDegree))) {
    const Eigen::Vector3d point = 1.7 * RayAt(angle, 5 * angle);
    points.emplace_back(point.x(), point.y(), point.z());
  }
  std::vector<cv::Point2d> expected;
  if (c.distortion_model == DistortionModel::kEquidistant) {
    cv::fisheye::projectPoints(points, expected, cv::Vec3d(), cv::Vec3d(), matrix,
                               cv::Vec4d(c.distortion.data()));
  } else {
    cv::projectPoints(points, cv::Vec3d(), cv::Vec3d(), matrix, c.distortion, expected);
  }
  for (std::size_t i = 0; i < points.size(); ++i) {
    Eigen::Vector2d pixel;
    ASSERT_NE(camera_.Project({points[i].x, points[i].y, points[i].z}, &pixel),
              ProjectionStatus::kOutsideModel);
    EXPECT_NEAR(pixel.x(), expected[i].x, 1e-8 * (1 + std::abs(expected[i].x)));
    EXPECT_NEAR(pixel.y(), expected[i].y, 1e-8 * (1 + std::abs(expected[i].y)));
  }
}

TEST_P(EveryCamera, ReportsRaysBeyondLimitAsOutside) {
  Eigen::Vector2d pixel(-7, -7);
  for (int step = 0; step < 24 && camera_.max_angle() < kPi; ++step) {
    EXPECT_EQ(camera_.Project(RayAt(camera_.max_angle() + 1e-4, step * kPi / 12), &pixel),
              ProjectionStatus::kOutsideModel);
  }
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  for (const Eigen::Vector3d& point :
       {Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(0, 0, -1), Eigen::Vector3d(nan, 0, 1),
        Eigen::Vector3d(0, 0, nan), Eigen::Vector3d(infinity, 0, 1)}) {
    EXPECT_EQ(camera_.Project(point, &pixel), ProjectionStatus::kOutsideModel);
  }
  EXPECT_EQ(pixel, Eigen::Vector2d(-7, -7));
  Eigen::Vector3d ray(-7, -7, -7);
  for (const Eigen::Vector2d& bad : {Eigen::Vector2d(nan, 0), Eigen::Vector2d(0, infinity)}) {
    EXPECT_EQ(camera_.Unproject(bad, &ray), ProjectionStatus::kOutsideModel);
  }
  EXPECT_EQ(ray, Eigen::Vector3d(-7, -7, -7));
}

TEST(CameraModel, PaperLensIsMonotonicBeyondItsImage) {
  const CameraModel camera(PaperCamera());
  EXPECT_DOUBLE_EQ(camera.max_angle(), kPi);
  // 92.5 degrees, half of the lens's field of view, projects outside of the image's corner.
  Eigen::Vector2d pixel;
  EXPECT_EQ(camera.Project(RayAt(92.5 * kDegree, 0), &pixel), ProjectionStatus::kOutsideImage);
  EXPECT_NEAR(pixel.x() - 376, 554.57, 0.01);
  Eigen::Vector3d ray;
  EXPECT_EQ(camera.Unproject(pixel, &ray), ProjectionStatus::kOutsideImage);
  EXPECT_LT(ray.z(), 0);
}

TEST(CameraModel, LimitIsTurningPointOfPolynomial) {
  CameraIntrinsics fisheye = PaperCamera();
  fisheye.distortion = {-0.1, 0, 0, 0};  // 1 - 0.3 theta^2 = 0
  EXPECT_NEAR(CameraModel(fisheye).max_angle(), std::sqrt(1 / 0.3), 1e-12);

  CameraIntrinsics radial = EurocCamera();
  radial.distortion = {-0.3, 0, 0, 0};  // 1 - 0.9 tan^2 = 0
  EXPECT_NEAR(CameraModel(radial).max_angle(), std::atan(std::sqrt(1 / 0.9)), 1e-12);

  radial.distortion = {0, 0, 0, 0, 0, -1.0, 0, 0};  // a pole at tan = 1
  EXPECT_NEAR(CameraModel(radial).max_angle(), kPi / 4, 1e-12);
}

// Two turning points in a narrow range of angles, which a coarse search would miss.
TEST(CameraModel, LimitIsFoundBetweenTwoNearTurns) {
  CameraIntrinsics fisheye = PaperCamera();
  const double a = 1.50, b = 1.501;  // theta^2 of the turns: slope (1 - s / a) (1 - s / b)
  fisheye.distortion = {-(1 / a + 1 / b) / 3, 1 / (a * b) / 5, 0, 0};
  EXPECT_NEAR(CameraModel(fisheye).max_angle(), std::sqrt(a), 1e-9);
}

TEST(CameraModel, UnprojectRefusesPixelsBeyondFold) {
  for (const TestCamera& test : TestCameras()) {
    if (!test.name.starts_with("folding")) continue;
    const CameraModel camera(test.intrinsics);
    Eigen::Vector2d rim;
    const double azimuth = 0.7;
    camera.Project(RayAt(camera.max_angle() * (1 - 1e-9), azimuth), &rim);
    const Eigen::Vector2d center(test.intrinsics.cx_px, test.intrinsics.cy_px);
    Eigen::Vector3d ray;
    EXPECT_EQ(camera.Unproject(center + 1.001 * (rim - center), &ray),
              ProjectionStatus::kOutsideModel);
    EXPECT_NE(camera.Unproject(center + 0.999 * (rim - center), &ray),
              ProjectionStatus::kOutsideModel);
    EXPECT_NEAR(AngleBetween(ray, {0, 0, 1}), camera.max_angle(), 0.1);
  }
}

TEST(CameraModel, ImageIncludesWholeBorderPixels) {
  const CameraModel camera({640, 360, 370, 370, 319.5, 179.5, DistortionModel::kNone, {}});
  Eigen::Vector3d ray;
  EXPECT_EQ(camera.Unproject({-0.5, 0}, &ray), ProjectionStatus::kOk);
  EXPECT_EQ(camera.Unproject({639.4, 359.4}, &ray), ProjectionStatus::kOk);
  EXPECT_EQ(camera.Unproject({639.6, 10}, &ray), ProjectionStatus::kOutsideImage);
  EXPECT_EQ(camera.Unproject({10, -0.6}, &ray), ProjectionStatus::kOutsideImage);
}

TEST(CameraModel, RefusesImageOfAnotherSize) {
  const CameraIntrinsics camera = PaperCamera();
  EXPECT_NO_THROW(CheckImageSize(camera, 752, 480, "a.png"));
  try {
    CheckImageSize(camera, 640, 480, "a.png");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(),
                 "a.png: the image is 640x480 px, expected 752x480 px as in the calibration");
  }
}

TEST(CameraIntrinsics, ValidCamerasHaveNoViolations) {
  for (const TestCamera& test : TestCameras()) {
    EXPECT_THAT(test.intrinsics.Validate(), IsEmpty()) << test.name;
  }
}

TEST(CameraIntrinsics, ReportsEveryViolation) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto violations_of = [](auto change) {
    CameraIntrinsics camera = PaperCamera();
    change(camera);
    return camera.Validate();
  };
  EXPECT_THAT(violations_of([](auto& c) { c.width_px = 0; }),
              ElementsAre("image width is 0 px, expected 1 to 65535"));
  EXPECT_THAT(violations_of([](auto& c) { c.height_px = 70000; }),
              ElementsAre("image height is 70000 px, expected 1 to 65535"));
  // No other value is judged by a size that cannot be.
  EXPECT_THAT(violations_of([](auto& c) {
                c.width_px = std::numeric_limits<int>::max();
                c.cx_px = -800;
              }),
              ElementsAre("image width is 2147483647 px, expected 1 to 65535"));
  EXPECT_THAT(violations_of([](auto& c) { c.fx_px = 0; }),
              ElementsAre(HasSubstr("focal length fx is 0 px, expected 37.6")));
  EXPECT_THAT(violations_of([](auto& c) { c.fy_px = -261; }),
              ElementsAre(HasSubstr("focal length fy is -261 px")));
  EXPECT_THAT(violations_of([&](auto& c) { c.fx_px = nan; }),
              ElementsAre(HasSubstr("focal length fx is nan px")));
  EXPECT_THAT(violations_of([](auto& c) { c.fx_px = 1e6; }),
              ElementsAre(HasSubstr("focal length fx is 1000000 px")));
  EXPECT_THAT(violations_of([](auto& c) { c.cx_px = -800; }),
              ElementsAre("principal point cx is -800 px, expected -752 to 1504"));
  EXPECT_THAT(violations_of([&](auto& c) { c.cy_px = nan; }),
              ElementsAre("principal point cy is nan px, expected -480 to 960"));
  EXPECT_THAT(violations_of([](auto& c) { c.distortion.pop_back(); }),
              ElementsAre("3 distortion coefficients, expected 4"));
  EXPECT_THAT(violations_of([&](auto& c) { c.distortion[2] = nan; }),
              ElementsAre("distortion coefficient 3 is nan, expected -10000 to 10000"));
  EXPECT_THAT(violations_of([](auto& c) { c.distortion[0] = -500; }),
              ElementsAre(HasSubstr("fold the image back")));
  EXPECT_THAT(violations_of([](auto& c) {
                c.distortion_model = DistortionModel::kRadialTangential;
                c.distortion.resize(6);
              }),
              ElementsAre("6 distortion coefficients, expected 4, 5, 8"));
  EXPECT_THAT(violations_of([](auto& c) { c.distortion_model = DistortionModel::kNone; }),
              ElementsAre("4 distortion coefficients, expected 0"));
}

TEST(CameraIntrinsics, ErrorListsAllViolations) {
  CameraIntrinsics camera = PaperCamera();
  camera.width_px = -1;
  camera.height_px = 0;
  try {
    CameraModel model(camera);
    FAIL();
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(),
                 "camera calibration: image width is -1 px, expected 1 to 65535; image height is "
                 "0 px, expected 1 to 65535");
  }
}

// Every lens that passes Validate() is usable: construction and inverses end for all coefficients,
// and unprojected rays are unit vectors that project back.
TEST(CameraModel, RandomLensesInvertOrRefuse) {
  std::mt19937 generator(11);
  std::uniform_real_distribution<double> mantissa(-1, 1);
  std::uniform_int_distribution<int> exponent(-4, 4);
  int usable = 0;
  for (int trial = 0; trial < 300; ++trial) {
    CameraIntrinsics intrinsics = trial % 2 == 0 ? PaperCamera() : EurocCamera();
    intrinsics.distortion.resize(trial % 4 == 1 ? 8 : 4);
    const double scale = std::pow(10.0, exponent(generator));
    for (double& k : intrinsics.distortion) k = scale * mantissa(generator);
    if (!intrinsics.Validate().empty()) continue;
    const CameraModel camera(intrinsics);
    ++usable;
    for (int i = 0; i < 50; ++i) {
      const Eigen::Vector2d pixel(376 + 376 * mantissa(generator), 240 + 240 * mantissa(generator));
      Eigen::Vector3d ray;
      if (camera.Unproject(pixel, &ray) == ProjectionStatus::kOutsideModel) continue;
      ASSERT_NEAR(ray.norm(), 1, 1e-12);
      Eigen::Vector2d back;
      if (AngleBetween(ray, {0, 0, 1}) > camera.max_angle() * (1 - 1e-9)) continue;
      ASSERT_NE(camera.Project(ray, &back), ProjectionStatus::kOutsideModel);
      EXPECT_LT((back - pixel).norm(), 1e-6) << trial;
    }
  }
  EXPECT_GT(usable, 100);
}

}  // namespace
}  // namespace kestrel
