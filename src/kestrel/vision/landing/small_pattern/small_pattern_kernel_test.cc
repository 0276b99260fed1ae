// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/landing/small_pattern/small_pattern_kernel.h"

#include <array>
#include <cmath>
#include <vector>

#include <Eigen/Core>
#include <gtest/gtest.h>

#include "kestrel/core/base/test_targets.h"
#include "kestrel/vision/landing/location/pattern_pose.h"
#include "kestrel/vision/landing/small_pattern/small_pattern_model.h"
#include "kestrel/vision/landing/test_prints.h"

namespace kestrel {
namespace {

// Pixels of a camera of focal length 'kFocalPx', on a grid around the axis. Their number is not a
// multiple of the vector length.
constexpr double kFocalPx = 220;
constexpr int kSide = 23;
void FillPixels(SmallPatternWorkspace* workspace) {
  const auto ray_at = [](double u, double v) {
    return Eigen::Vector3d(u / kFocalPx, v / kFocalPx, 1).normalized();
  };
  workspace->count = 0;
  for (int v = 0; v < kSide; ++v) {
    for (int u = 0; u < kSide; ++u, ++workspace->count) {
      const double x = u - kSide / 2, y = v - kSide / 2;
      const Eigen::Vector3d ray = ray_at(x, y);
      const Eigen::Vector3d by_u = ray_at(x + 0.5, y) - ray_at(x - 0.5, y);
      const Eigen::Vector3d by_v = ray_at(x, y + 0.5) - ray_at(x, y - 0.5);
      for (int k = 0; k < 3; ++k) {
        workspace->pixels.ray[k][workspace->count] = static_cast<float>(ray(k));
        workspace->pixels.ray_by_u[k][workspace->count] = static_cast<float>(by_u(k));
        workspace->pixels.ray_by_v[k][workspace->count] = static_cast<float>(by_v(k));
      }
      workspace->pixels.gray[workspace->count] = 100;
    }
  }
}

class SmallPatternKernelTest : public ::testing::Test {
 protected:
  SmallPatternKernelTest() { FillPixels(&workspace_); }

  const LandingPattern pattern_{};
  const RigidTransform pose_ = PrintPose({0.1, -0.2, 11}, 0.3, 0.7, 0.4);
  SmallPatternWorkspace workspace_;
};

TEST_F(SmallPatternKernelTest, PrintIsDarkAtItsStrokes) {
  ForEveryTarget([&] {
    constexpr double kSharp = 0.05;  // px
    EvaluatePrint(ModelOf(pattern_, pose_, kSharp), &workspace_);
    const SmallPatternWorkspace::Points& points = workspace_.points;
    const Print print = SpokedPrint(pattern_, 4);
    int dark = 0, compared = 0;
    for (std::size_t i = 0; i < workspace_.count; ++i) {
      const double x = points.x[i], y = points.y[i];
      // Compares only where the print is uniform all around.
      constexpr double kStep = 0.02;
      const bool is_dark = print(x, y);
      bool is_even = true;
      for (const double dx : {-kStep, kStep}) {
        for (const double dy : {-kStep, kStep}) is_even &= print(x + dx, y + dy) == is_dark;
      }
      if (!is_even) continue;
      EXPECT_NEAR(points.dark[i], is_dark ? 1 : 0, 0.01) << x << " " << y;
      dark += is_dark;
      ++compared;
    }
    EXPECT_GT(dark, 30);
    EXPECT_GT(compared - dark, 100);
  });
}

TEST_F(SmallPatternKernelTest, DerivativesMatchGrayValues) {
  ForEveryTarget([&] {
    using Unknowns = Eigen::Matrix<double, SmallPatternWorkspace::kUnknowns, 1>;
    const auto expected_at = [&](const Unknowns& change) {
      const RigidTransform pose = Moved(pose_, change.head<3>(), change.segment<3>(3));
      EvaluatePrint(ModelOf(pattern_, pose, 0.8 * std::exp(change(6))), &workspace_);
      const PrintLight light{.white = static_cast<float>(180 + change(7)),
                             .slope_x = static_cast<float>(10 + change(9)),
                             .slope_y = static_cast<float>(-20 + change(10)),
                             .contrast = static_cast<float>(120 + change(8)),
                             .highlight = 1000,
                             .saturated = 254};
      CompareGrays(light, 1e6f, &workspace_);
      return std::vector<float>(
          workspace_.points.expected.begin(),
          workspace_.points.expected.begin() + static_cast<std::ptrdiff_t>(workspace_.count));
    };
    for (int k = 0; k < Unknowns::RowsAtCompileTime; ++k) {
      const double step = k < 3 ? 0.01 : k < 7 ? 0.02 : 1;
      const auto after = expected_at(step * Unknowns::Unit(k));
      const auto before = expected_at(-step * Unknowns::Unit(k));
      expected_at(Unknowns::Zero());
      const Eigen::Matrix3f rotation = pose_.rotation.toRotationMatrix().cast<float>();
      const auto axis = [&rotation](int column) {
        return std::array<float, 3>{rotation(0, column), rotation(1, column), rotation(2, column)};
      };
      Differentiate({axis(0), axis(1), axis(2)}, 120, &workspace_);
      double squares = 0, differences = 0;
      for (std::size_t i = 0; i < workspace_.count; ++i) {
        const double numeric = (after[i] - before[i]) / (2 * step);
        squares += numeric * numeric;
        differences += std::pow(workspace_.jacobian[k][i] - numeric, 2);
      }
      EXPECT_GT(squares, 0) << k;
      // The derivative ignores the change of the blur's width in the plane with the pose.
      EXPECT_LT(std::sqrt(differences / squares), k < 6 ? 0.2 : 0.01) << k;
    }
  });
}

TEST_F(SmallPatternKernelTest, ReducesWeightOfOutliersAndSaturation) {
  ForEveryTarget([&] {
    EvaluatePrint(ModelOf(pattern_, pose_, 0.8), &workspace_);
    const PrintLight light{.white = 300,
                           .slope_x = 0,
                           .slope_y = 0,
                           .contrast = 120,
                           .highlight = 12,
                           .saturated = 254};
    workspace_.pixels.gray[0] = 255;  // saturated: white is expected to be brighter
    workspace_.pixels.gray[1] = 240;  // 60 darker than white
    CompareGrays(light, 30, &workspace_);
    EXPECT_EQ(workspace_.points.residual[0], 0);
    EXPECT_EQ(workspace_.points.root_weight[0], 0);
    EXPECT_FLOAT_EQ(workspace_.points.weight[1], 0.5f);
    EXPECT_FLOAT_EQ(workspace_.points.root_weight[1], std::sqrt(0.5f));
  });
}

}  // namespace
}  // namespace kestrel
