// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/pipeline/image_turn.h"

#include <Eigen/Geometry>
#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include "kestrel/core/base/random.h"
#include "kestrel/core/geometry/angles.h"

namespace kestrel {
namespace {

CameraIntrinsics TurningCamera() {
  return {.width_px = 640,
          .height_px = 480,
          .fx_px = 500,
          .fy_px = 500,
          .cx_px = 319.5,
          .cy_px = 239.5,
          .distortion = {}};
}

// Draws a far texture as a camera sees it: 'world_from_camera' is its attitude.
cv::Mat View(const Eigen::Matrix3d& world_from_camera, Random* random) {
  // The texture has fine and coarse patches, as ground has.
  static const cv::Mat texture = [] {
    Random random_of_texture(3);
    cv::Mat sum(1600, 1600, CV_8UC1, cv::Scalar(0));
    for (const int patches : {160, 40}) {
      cv::Mat noise(patches, patches, CV_8UC1);
      for (int i = 0; i < patches * patches; ++i) {
        noise.data[i] = static_cast<std::uint8_t>(random_of_texture.Integer(20, 105));
      }
      cv::resize(noise, noise, sum.size(), 0, 0, cv::INTER_CUBIC);
      sum += noise;
    }
    return sum;
  }();
  const Eigen::Matrix3d of_camera =
      (Eigen::Matrix3d() << 500, 0, 319.5, 0, 500, 239.5, 0, 0, 1).finished();
  const Eigen::Matrix3d of_texture =
      (Eigen::Matrix3d() << 500, 0, 799.5, 0, 500, 799.5, 0, 0, 1).finished();
  const Eigen::Matrix3d map = of_texture * world_from_camera * of_camera.inverse();
  cv::Matx33d warp;
  for (int i = 0; i < 9; ++i) warp(i / 3, i % 3) = map(i / 3, i % 3);
  cv::Mat view;
  cv::warpPerspective(texture, view, warp, {640, 480}, cv::INTER_LINEAR | cv::WARP_INVERSE_MAP);
  for (int i = 0; i < view.rows * view.cols; ++i) {
    view.data[i] = cv::saturate_cast<std::uint8_t>(view.data[i] + 4 * random->Normal());
  }
  return view;
}

Eigen::Matrix3d TurnedBy(const Eigen::Vector3d& turn) {
  return Eigen::AngleAxisd(turn.norm(), turn.normalized()).toRotationMatrix();
}

TEST(ImageTurnTest, RotationIsThatOfCamera) {
  constexpr double kLargest = Radians(2);  // about each axis: 60 deg/s, 30 images/s
  Random random(1);
  ImageTurn turns(TurningCamera());
  Eigen::Matrix3d attitude = Eigen::Matrix3d::Identity();
  EXPECT_FALSE(turns.Add(View(attitude, &random)));
  for (int i = 0; i < 20; ++i) {
    const Eigen::Vector3d turn =
        Eigen::Vector3d(random.Uniform(-1, 1), random.Uniform(-1, 1), random.Uniform(-1, 1)) *
        kLargest;
    const Eigen::Matrix3d before = attitude;
    attitude.setIdentity();
    if (i % 2 == 0) attitude = before * TurnedBy(turn);
    const Eigen::AngleAxisd truth(before.transpose() * attitude);
    const auto seen = turns.Add(View(attitude, &random));
    ASSERT_TRUE(seen);
    const Eigen::Vector3d error = *seen - truth.angle() * truth.axis();
    EXPECT_LT(error.head<2>().norm(), Radians(0.1)) << error;
    EXPECT_LT(std::abs(error.z()), Radians(0.1)) << error;
  }
}

TEST(ImageTurnTest, ImagesWithoutTextureHaveNoRotation) {
  Random random(2);
  ImageTurn turns(TurningCamera());
  turns.Add(View(Eigen::Matrix3d::Identity(), &random));
  EXPECT_FALSE(turns.Add(cv::Mat(480, 640, CV_8UC1, cv::Scalar(90))));
  EXPECT_FALSE(turns.Add(View(Eigen::Matrix3d::Identity(), &random)));
  turns.Restart();
  EXPECT_FALSE(turns.Add(View(Eigen::Matrix3d::Identity(), &random)));
  EXPECT_TRUE(turns.Add(View(Eigen::Matrix3d::Identity(), &random)));
}

}  // namespace
}  // namespace kestrel
