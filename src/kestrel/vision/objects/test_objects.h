// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/Geometry>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "kestrel/core/camera/camera_model.h"
#include "kestrel/vision/objects/location/ground_plane.h"

namespace kestrel {

inline CameraModel ObjectCamera() {
  return CameraModel({640, 480, 500, 500, 319.5, 239.5, DistortionModel::kNone, {}});
}

// A camera above flat ground that looks nearly straight down, and flat painted figures in its
// image.
class ObjectScene {
 public:
  explicit ObjectScene(double height_m = 4, double tilt = 0.2)
      : camera_(ObjectCamera()),
        height_m_(height_m),
        up_(Eigen::Vector3d(std::sin(tilt), 0, -std::cos(tilt))),
        image_(480 * kFine, 640 * kFine, CV_8UC3, cv::Scalar(95, 100, 105)) {}

  // Intersection of the ray through a pixel with the plane 'above_m' above the ground, camera
  // frame, m.
  Eigen::Vector3d PointUnder(const Eigen::Vector2d& pixel, double above_m) const {
    Eigen::Vector3d ray;
    camera_.Unproject(pixel, &ray);
    return (height_m_ - above_m) / -up_.dot(ray) * ray;
  }

  void DrawDisc(const Eigen::Vector3d& center, double radius_m, const cv::Scalar& color) {
    std::vector<Eigen::Vector3d> outline;
    for (int i = 0; i < 120; ++i) {
      const double t = 2 * 3.141592653589793 * i / 120;
      outline.push_back(center + radius_m * (std::cos(t) * East() + std::sin(t) * North()));
    }
    Fill(outline, color);
  }

  // Draws a horizontal rectangle.
  void DrawRectangle(const Eigen::Vector3d& center, double length_m, double width_m, double yaw,
                     const cv::Scalar& color) {
    const Eigen::Vector3d along = std::cos(yaw) * East() + std::sin(yaw) * North();
    const Eigen::Vector3d across = -std::sin(yaw) * East() + std::cos(yaw) * North();
    Fill({center + 0.5 * (length_m * along + width_m * across),
          center + 0.5 * (-length_m * along + width_m * across),
          center + 0.5 * (-length_m * along - width_m * across),
          center + 0.5 * (length_m * along - width_m * across)},
         color);
  }

  cv::Mat Image() const {
    cv::Mat image;
    cv::resize(image_, image, cv::Size(640, 480), 0, 0, cv::INTER_AREA);
    cv::GaussianBlur(image, image, cv::Size(), 0.7);
    return image;
  }

  const CameraModel& camera() const { return camera_; }
  const Eigen::Vector3d& up() const { return up_; }
  double height_m() const { return height_m_; }

 private:
  static constexpr int kFine = 4;

  Eigen::Vector3d East() const { return up_.cross(Eigen::Vector3d::UnitY()).normalized(); }
  Eigen::Vector3d North() const { return up_.cross(East()); }

  // Paints the pixels whose centres are inside of a convex outline. cv::fillPoly also paints those
  // that the outline crosses, which makes a disc an eighth of a pixel larger.
  void Fill(const std::vector<Eigen::Vector3d>& outline, const cv::Scalar& color) {
    Eigen::Matrix2Xd corners(2, outline.size());
    for (Eigen::Index i = 0; i < corners.cols(); ++i) {
      Eigen::Vector2d pixel;
      camera_.Project(outline[i], &pixel);
      corners.col(i) = kFine * (pixel.array() + 0.5) - 0.5;
    }
    const int first = std::max(0, static_cast<int>(std::ceil(corners.row(1).minCoeff())));
    const int last = std::min(image_.rows - 1, static_cast<int>(corners.row(1).maxCoeff()));
    for (int v = first; v <= last; ++v) {
      const Eigen::Vector2d ends = Crossings(corners, v);
      const int left = std::max(0, static_cast<int>(std::ceil(ends.x())));
      const int right = std::min(image_.cols, static_cast<int>(std::floor(ends.y())) + 1);
      if (left < right) image_(cv::Range(v, v + 1), cv::Range(left, right)).setTo(color);
    }
  }

  // Least and largest u at which a convex outline crosses the row.
  static Eigen::Vector2d Crossings(const Eigen::Matrix2Xd& corners, double v) {
    Eigen::AlignedBox1d extent;
    Eigen::Vector2d a = corners.col(corners.cols() - 1);
    for (const auto& b : corners.colwise()) {
      if ((a.y() <= v) != (b.y() <= v)) {
        extent.extend(
            Eigen::Matrix<double, 1, 1>(a.x() + (v - a.y()) / (b.y() - a.y()) * (b.x() - a.x())));
      }
      a = b;
    }
    return {extent.min()(0), extent.max()(0)};
  }

  CameraModel camera_;
  double height_m_;
  Eigen::Vector3d up_;
  cv::Mat image_;
};

inline const cv::Scalar kRedPaint(45, 40, 200);
inline const cv::Scalar kGreenPaint(55, 165, 95);
inline const cv::Scalar kBluePaint(140, 70, 8);
inline const cv::Scalar kYellowPaint(30, 225, 240);
inline const cv::Scalar kOrangePaint(20, 95, 235);
inline const cv::Scalar kWhitePaint(240, 240, 240);

}  // namespace kestrel
