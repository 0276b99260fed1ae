// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/core/camera/projection_kernel.h"

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "kestrel/core/base/test_targets.h"
#include "kestrel/core/camera/test_cameras.h"

namespace kestrel {
namespace {

// Points at many angles to the axis, on it and behind, near and far. Their number is not a multiple
// of the vector length.
std::vector<Eigen::Vector3d> TestPoints() {
  std::vector<Eigen::Vector3d> points{{0, 0, 2}, {0, 0, -2}, {0, 0, 0}, {1e-7, 0, 1}};
  for (int i = 0; i < 180; ++i) {
    for (int k = 0; k < 7; ++k) {
      const double distance = std::pow(10.0, k - 2);
      points.emplace_back(distance * RayAt(i * kDegree, 2.4 * k + i));
    }
  }
  return points;
}

// Pixels and derivatives of many points.
struct Columns {
  explicit Columns(std::size_t count) {
    for (std::vector<float>* column : {&x_px, &y_px}) column->resize(count);
    for (std::vector<float>& column : by_point) column.resize(count);
  }
  Eigen::Vector2d Pixel(std::size_t i) const { return {x_px[i], y_px[i]}; }
  Eigen::Matrix<double, 2, 3> Derivative(std::size_t i) const {
    Eigen::Matrix<double, 2, 3> derivative;
    for (int k = 0; k < 6; ++k) derivative(k / 3, k % 3) = by_point[k][i];
    return derivative;
  }
  std::vector<float> x_px, y_px;
  std::array<std::vector<float>, 6> by_point;
};

Columns ProjectAll(const CameraModel& camera, const std::vector<Eigen::Vector3f>& points) {
  std::array<std::vector<float>, 3> in;
  for (const Eigen::Vector3f& point : points) {
    for (int k = 0; k < 3; ++k) in[k].push_back(point(k));
  }
  Columns out(points.size());
  std::array<float*, 6> derivatives;
  for (int k = 0; k < 6; ++k) derivatives[k] = out.by_point[k].data();
  camera.ProjectMany({in[0].data(), in[1].data(), in[2].data()}, points.size(), out.x_px.data(),
                     out.y_px.data(), &derivatives);
  return out;
}

class ProjectionKernelTest : public ::testing::TestWithParam<TestCamera> {};

TEST_P(ProjectionKernelTest, AgreesWithModel) {
  const CameraModel camera(GetParam().intrinsics);
  std::vector<Eigen::Vector3f> points;
  for (const Eigen::Vector3d& point : TestPoints()) points.push_back(point.cast<float>());
  ForEveryTarget([&] {
    const Columns many = ProjectAll(camera, points);
    int compared = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Eigen::Vector3d point = points[i].cast<double>();
      const double angle = std::atan2(point.head<2>().norm(), point.z());
      if (std::abs(angle - camera.max_angle()) < 1e-5) continue;  // either result is right
      Eigen::Vector2d pixel;
      Eigen::Matrix<double, 2, 3> derivative;
      const ProjectionStatus status = camera.Project(point, &pixel, &derivative);
      if (status == ProjectionStatus::kOutsideModel) {
        EXPECT_TRUE(std::isnan(many.x_px[i]) && std::isnan(many.y_px[i])) << point.transpose();
        continue;
      }
      ++compared;
      const double out_of_image = status == ProjectionStatus::kOk ? 0 : pixel.norm();
      EXPECT_LT((many.Pixel(i) - pixel).norm(), 1e-3 + 2e-6 * out_of_image) << point.transpose();
      EXPECT_LT((many.Derivative(i) - derivative).norm(), 1e-4 * derivative.norm())
          << point.transpose();
    }
    EXPECT_GT(compared, 200);
  });
}

TEST_P(ProjectionKernelTest, GivesSameResultForFewAndManyPoints) {
  const CameraModel camera(GetParam().intrinsics);
  const std::vector<Eigen::Vector3f> points{{0.1f, -0.2f, 1}, {0, 0, 3}, {0.2f, 0.3f, 2}};
  const Columns many = ProjectAll(camera, points);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Columns one = ProjectAll(camera, {points[i]});
    EXPECT_LT((one.Pixel(0) - many.Pixel(i)).norm(), 1e-4);
  }
}

INSTANTIATE_TEST_SUITE_P(Cameras, ProjectionKernelTest, ::testing::ValuesIn(TestCameras()),
                         [](const auto& info) { return info.param.name; });

}  // namespace
}  // namespace kestrel
