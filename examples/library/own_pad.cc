// SPDX-License-Identifier: BSD-3-Clause
// A pad of one's own: a detector of a dark disc, given to a LandingPipeline, which tracks the disc
// as it drives by below the UAV.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <iostream>
#include <memory>
#include <numbers>
#include <utility>
#include <vector>

#include <opencv2/imgproc.hpp>

#include "kestrel/landing_pipeline.h"
#include "kestrel/target_detector.h"

namespace {

// Finds a dark disc on bright ground by its outline.
class DiscDetector : public kestrel::TargetDetector {
 public:
  DiscDetector(kestrel::CameraModel camera, double diameter_m) : camera_(std::move(camera)) {
    shape_.diameter_m = shape_.board_size_m = diameter_m;
    auto& circle = shape_.outlines.emplace_back();
    for (int degrees = 0; degrees <= 360; degrees += 5) {
      const double angle = degrees * std::numbers::pi / 180;
      circle.push_back(shape_.radius_m() * Eigen::Vector3d(std::cos(angle), std::sin(angle), 0));
    }
  }

  kestrel::TargetReport Detect(const cv::Mat& image, const kestrel::TargetHint& hint,
                               kestrel::TargetWorkspace& /*workspace*/) const override {
    cv::Mat dark;
    cv::threshold(image, dark, 0, 255, cv::THRESH_BINARY_INV | cv::THRESH_OTSU);
    std::vector<std::vector<cv::Point>> outlines;
    cv::findContours(dark, outlines, cv::RETR_EXTERNAL, cv::CHAIN_APPROX_NONE);
    kestrel::TargetReport report;
    report.reached = kestrel::LandingStage::kAreas;
    report.reason = "nothing dark is an ellipse";
    for (const std::vector<cv::Point>& outline : outlines) {
      if (outline.size() < 30) continue;
      const cv::RotatedRect ellipse = cv::fitEllipse(outline);
      const double area = std::numbers::pi / 4 * ellipse.size.area();
      if (std::abs(cv::contourArea(outline) / area - 1) > 0.1) continue;
      report.detection = Locate(ellipse, hint);
      report.reached = kestrel::LandingStage::kFound;
      report.reason = {};
    }
    return report;
  }

  std::unique_ptr<kestrel::TargetWorkspace> MakeWorkspace() const override {
    return std::make_unique<kestrel::TargetWorkspace>();
  }
  const kestrel::CameraModel& camera() const override { return camera_; }
  const kestrel::TargetShape& shape() const override { return shape_; }

 private:
  // The disc lies level. It is as far away as its longer axis is wide.
  kestrel::TargetDetection Locate(const cv::RotatedRect& ellipse,
                                  const kestrel::TargetHint& hint) const {
    kestrel::TargetDetection found{};
    found.center_px = {ellipse.center.x, ellipse.center.y};
    found.semi_major_px = std::max(ellipse.size.width, ellipse.size.height) / 2;
    found.semi_minor_px = std::min(ellipse.size.width, ellipse.size.height) / 2;
    Eigen::Vector3d ray = Eigen::Vector3d::UnitZ();
    camera_.Unproject(found.center_px, &ray);
    const double distance_m =
        shape_.radius_m() * camera_.intrinsics().fx_px / found.semi_major_px / ray.z();
    const Eigen::Vector3d up = hint.up_in_camera.value_or(-Eigen::Vector3d::UnitZ());
    found.camera_from_target = {Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), up),
                                distance_m * ray};
    const double sigma = 0.5 / found.semi_major_px;  // of half a pixel, relative
    found.covariance.setIdentity();
    found.covariance.topLeftCorner<3, 3>() *= std::pow(sigma * distance_m, 2);
    found.method = kestrel::DetectionMethod::kOther;
    found.quality = 0.9;
    found.heading_symmetry = 0;
    return found;
  }

  kestrel::CameraModel camera_;
  kestrel::TargetShape shape_;
};

}  // namespace

int main() {
  kestrel::CameraCalibration calibration;
  calibration.intrinsics = {
      .width_px = 640, .height_px = 480, .fx_px = 400, .fy_px = 400, .cx_px = 320, .cy_px = 240};
  const kestrel::CameraModel camera(calibration.intrinsics);
  // The camera looks down, its upper edge is forward.
  calibration.body_from_camera = kestrel::RigidTransform{
      Eigen::Quaterniond((Eigen::Matrix3d() << 0, -1, 0, -1, 0, 0, 0, 0, -1).finished()),
      {0, 0, 0}};
  const kestrel::RigidTransform world_from_body = {Eigen::Quaterniond::Identity(), {0, 0, 4}};

  kestrel::LandingPipeline pipeline(calibration, std::make_unique<DiscDetector>(camera, 0.8), {});
  kestrel::LandingObservation seen;
  for (int i = 0; i < 40; ++i) {
    const kestrel::Time time(std::chrono::milliseconds(50 * i));
    const Eigen::Vector3d center_in_world(0.8 * 0.05 * i - 0.8, 0.3, 0);  // 0.8 m/s to the east
    Eigen::Vector2d center_px;
    camera.Project((world_from_body * *calibration.body_from_camera).Inverse() * center_in_world,
                   &center_px);
    cv::Mat image(480, 640, CV_8UC1, cv::Scalar(200));
    cv::circle(image, cv::Point2d(center_px.x(), center_px.y()), 40, 30, cv::FILLED, cv::LINE_AA);
    pipeline.AddPose({time, world_from_body});
    seen = pipeline.Process(image, time);
  }
  if (!seen.target) {
    std::cout << "no track: " << seen.report.reason << "\n";
    return 1;
  }
  std::cout << "the disc is at " << seen.target->motion.position().transpose() << " m, drives at "
            << seen.target->speed() << " m/s\n";
  return 0;
}
