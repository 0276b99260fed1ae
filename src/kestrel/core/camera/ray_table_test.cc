// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/core/camera/ray_table.h"

#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

#include "kestrel/core/base/test_targets.h"
#include "kestrel/core/camera/test_cameras.h"

namespace kestrel {
namespace {

class EveryRayTable : public ::testing::TestWithParam<TestCamera> {
 protected:
  const CameraModel camera_{GetParam().intrinsics};
  const RayTable table_{camera_};
};
INSTANTIATE_TEST_SUITE_P(, EveryRayTable, ::testing::ValuesIn(TestCameras()),
                         [](const auto& info) { return info.param.name; });

// Largest distance in the image between a pixel and the projection of the table's ray through it,
// for angles in (low, high].
double MaxErrorPx(const CameraModel& camera, const RayTable& table, double low, double high) {
  double max_error_px = 0;
  for (int i = 1; i <= 300; ++i) {
    for (int step = 0; step < 16; ++step) {
      const double angle = low + (high - low) * i / 300;
      Eigen::Vector2d pixel;
      Eigen::Matrix<double, 2, 3> jacobian;
      const Eigen::Vector3d ray = RayAt(angle, step * std::numbers::pi / 8);
      if (camera.Project(ray, &pixel, &jacobian) != ProjectionStatus::kOk) continue;
      const Eigen::Vector2f rounded = pixel.cast<float>();
      const Eigen::Vector3d found = table.Ray(rounded.x(), rounded.y()).cast<double>();
      max_error_px = std::max(max_error_px, (jacobian * (found - ray)).norm());
    }
  }
  return max_error_px;
}

TEST_P(EveryRayTable, MatchesExactInverseWithinHundredthOfPixel) {
  for (int decade = 0; decade < 9; ++decade) {
    const double high = std::min(10 * (decade + 1) * kDegree, 0.99 * camera_.max_angle());
    const double low = std::min(10 * decade * kDegree, high);
    EXPECT_LT(MaxErrorPx(camera_, table_, low, high), 0.01) << 10 * decade << " degrees";
  }
}

void ExpectRaysAreRay(const CameraModel& camera, const RayTable& table) {
  std::mt19937 generator(5);
  std::uniform_real_distribution<float> u(-0.1f * camera.width_px(), 1.1f * camera.width_px());
  std::uniform_real_distribution<float> v(-0.1f * camera.height_px(), 1.1f * camera.height_px());
  for (const std::size_t count : {0, 1, 3, 7, 8, 15, 16, 17, 31, 33, 100, 1001}) {
    std::vector<float> u_px(count), v_px(count);
    constexpr float kUntouched = 77;
    std::vector<float> x(count + 1, kUntouched), y = x, z = x;
    for (std::size_t i = 0; i < count; ++i) {
      u_px[i] = u(generator);
      v_px[i] = v(generator);
    }
    table.Rays(u_px.data(), v_px.data(), count, x.data(), y.data(), z.data());
    for (std::size_t i = 0; i < count; ++i) {
      const Eigen::Vector3f expected = table.Ray(u_px[i], v_px[i]);
      EXPECT_LT((Eigen::Vector3f(x[i], y[i], z[i]) - expected).norm(), 2e-6f)
          << u_px[i] << " " << v_px[i];
    }
    EXPECT_EQ(x[count], kUntouched);
    EXPECT_EQ(z[count], kUntouched);
  }
}

TEST_P(EveryRayTable, RaysEqualsRayForEveryCountAndInstructionSet) {
  ForEveryTarget([this] { ExpectRaysAreRay(camera_, table_); });
}

TEST_P(EveryRayTable, RayHasUnitLengthOrIsZero) {
  for (float v = -200; v < 1000; v += 37) {
    for (float u = -200; u < 1500; u += 41) {
      const float norm = table_.Ray(u, v).norm();
      EXPECT_TRUE(norm == 0 || std::abs(norm - 1) < 1e-6f) << u << " " << v;
    }
  }
}

TEST_P(EveryRayTable, ReturnsZeroForInvalidPixel) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float infinity = std::numeric_limits<float>::infinity();
  std::vector<float> u(33, 100), v(33, 100), x(33), y(33), z(33);
  u[3] = nan;
  v[8] = nan;
  u[17] = infinity;
  v[31] = -infinity;
  u[32] = 1e30f;
  table_.Rays(u.data(), v.data(), u.size(), x.data(), y.data(), z.data());
  for (const int i : {3, 8, 17, 31, 32}) {
    EXPECT_EQ(Eigen::Vector3f(x[i], y[i], z[i]), Eigen::Vector3f::Zero()) << i;
    EXPECT_EQ(table_.Ray(u[i], v[i]), Eigen::Vector3f::Zero()) << i;
  }
}

TEST(RayTable, ReturnsZeroWhereLensFoldsBack) {
  for (const TestCamera& test : TestCameras()) {
    if (!test.name.starts_with("folding")) continue;
    const CameraModel camera(test.intrinsics);
    const RayTable table(camera);
    const Eigen::Vector2d center(test.intrinsics.cx_px, test.intrinsics.cy_px);
    Eigen::Vector2d rim;
    camera.Project(RayAt(camera.max_angle() * (1 - 1e-9), 2), &rim);
    const Eigen::Vector2f inside = (center + 0.999 * (rim - center)).cast<float>();
    const Eigen::Vector2f outside = (center + 1.001 * (rim - center)).cast<float>();
    EXPECT_NEAR(table.Ray(inside.x(), inside.y()).norm(), 1, 1e-6) << test.name;
    EXPECT_EQ(table.Ray(outside.x(), outside.y()), Eigen::Vector3f::Zero()) << test.name;
  }
}

TEST(RayTable, ReachesPastNinetyDegrees) {
  const CameraModel camera(PaperCamera());
  const RayTable table(camera);
  Eigen::Vector2d pixel;
  camera.Project(RayAt(92.5 * kDegree, 0.3), &pixel);
  const Eigen::Vector3f ray =
      table.Ray(static_cast<float>(pixel.x()), static_cast<float>(pixel.y()));
  EXPECT_LT(AngleBetween(ray.cast<double>().normalized(), RayAt(92.5 * kDegree, 0.3)), 1e-5);
}

TEST(RayTable, CopyOutlivesOriginal) {
  auto original = std::make_unique<RayTable>(CameraModel(PaperCamera()));
  const Eigen::Vector3f expected = original->Ray(600, 100);
  const RayTable copy = *original;
  const RayTable moved = std::move(*original);
  original.reset();
  EXPECT_EQ(copy.Ray(600, 100), expected);
  EXPECT_EQ(moved.Ray(600, 100), expected);
}

}  // namespace
}  // namespace kestrel
