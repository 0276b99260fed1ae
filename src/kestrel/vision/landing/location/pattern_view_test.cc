// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/landing/location/pattern_view.h"

#include <array>

#include <gtest/gtest.h>

#include "kestrel/core/base/test_targets.h"
#include "kestrel/core/camera/test_cameras.h"
#include "kestrel/core/image/gray_sampling.h"
#include "kestrel/vision/landing/test_prints.h"

namespace kestrel {
namespace {

TEST(ImageRegion, PixelsOfLevelAreCentredOnTheirSources) {
  const ImageRegion region{{64, 32}, 2};
  EXPECT_EQ(region.FromFull({65.5, 33.5}), Eigen::Vector2d(0, 0));
  EXPECT_EQ(region.ToFull({0, 0}), Eigen::Vector2d(65.5, 33.5));
  const Eigen::Vector2d pixel(123.4, 56.7);
  EXPECT_LT((region.ToFull(region.FromFull(pixel)) - pixel).norm(), 1e-12);
}

TEST(PatternView, AgreesWithProjection) {
  Random random(1);
  for (const CameraIntrinsics& intrinsics : {PaperCamera(), EurocCamera()}) {
    const CameraModel camera(intrinsics);
    for (int trial = 0; trial < 50; ++trial) {
      const RigidTransform pose =
          PrintPose({random.Uniform(-1, 1), random.Uniform(-0.6, 0.6), random.Uniform(2, 6)},
                    random.Uniform(0, 0.6), random.Uniform(0, 6), random.Uniform(0, 6));
      const ImageRegion region{{32, 64}, trial % 3};
      const PatternView view(camera, pose, 0.6, region);
      ASSERT_TRUE(view.valid());
      for (int i = 0; i < 50; ++i) {
        const double x = random.Uniform(-0.6, 0.6), y = random.Uniform(-0.6, 0.6);
        Eigen::Vector2d pixel;
        camera.Project(pose * Eigen::Vector3d(x, y, 0), &pixel);
        const auto x_m = static_cast<float>(x), y_m = static_cast<float>(y);
        Eigen::Vector2f seen;
        view.Project(&x_m, &y_m, 1, &seen.x(), &seen.y());
        EXPECT_LT((seen.cast<double>() - region.FromFull(pixel)).norm(), 0.4 / region.scale());
      }
    }
  }
}

TEST(PatternView, SamplesImageAtItsPoints) {
  const CameraModel camera = TestPrintCamera();
  Random random(2);
  cv::Mat image(camera.height_px(), camera.width_px(), CV_8UC1);
  for (int y = 0; y < image.rows; ++y) {
    for (int x = 0; x < image.cols; ++x) {
      image.at<std::uint8_t>(y, x) = static_cast<std::uint8_t>(random.Uniform(0, 256));
    }
  }
  // Half out of the image, and with more points than are processed at once.
  const PatternView view(camera, PrintPose({1.4, 0, 2}, 0.2, 0.3, 0.4), 0.6, {});
  ASSERT_TRUE(view.valid());
  constexpr std::size_t kPoints = 151;
  std::array<float, kPoints> x_m, y_m, x_px, y_px, gray;
  for (std::size_t i = 0; i < kPoints; ++i) {
    x_m[i] = static_cast<float>(random.Uniform(-0.6, 0.6));
    y_m[i] = static_cast<float>(random.Uniform(-0.6, 0.6));
  }
  ForEveryTarget([&] {
    view.Project(x_m.data(), y_m.data(), kPoints, x_px.data(), y_px.data());
    view.Sample(image, x_m.data(), y_m.data(), kPoints, gray.data());
    int seen = 0;
    for (std::size_t i = 0; i < kPoints; ++i) {
      EXPECT_NEAR(gray[i], SampleGray(image, x_px[i], y_px[i]), 1e-3);
      seen += gray[i] >= 0;
    }
    EXPECT_GT(seen, 30);
    EXPECT_LT(seen, 120);
  });
}

TEST(PatternView, IsInvalidBehindCamera) {
  const CameraModel camera = TestPrintCamera();
  EXPECT_TRUE(PatternView(camera, PrintPose({0, 0, 2}, 0, 0, 0), 0.6, {}).valid());
  EXPECT_FALSE(PatternView(camera, PrintPose({0, 0, -2}, 0, 0, 0), 0.6, {}).valid());
  EXPECT_FALSE(PatternView(camera, PrintPose({0, 0, 0.3}, 1.4, 0, 0), 0.6, {}).valid());
}

}  // namespace
}  // namespace kestrel
