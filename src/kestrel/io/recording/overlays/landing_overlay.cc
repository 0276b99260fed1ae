// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/io/recording/overlays/landing_overlay.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <opencv2/imgproc.hpp>

#include "kestrel/vision/target/plane_warp.h"

namespace kestrel {
namespace {

using Polyline = std::vector<Eigen::Vector3d>;  // in the pattern's frame, m
// Projects a point in the pattern's frame to a pixel; false when it has none.
using Projection = std::function<bool(const Eigen::Vector3d& point, Eigen::Vector2d* pixel)>;

const cv::Scalar kRed(40, 40, 255);
const cv::Scalar kGreen(60, 220, 60);
const cv::Scalar kBlue(255, 120, 40);
const cv::Scalar kYellow(0, 230, 255);
const cv::Scalar kMagenta(255, 90, 255);
const cv::Scalar kCyan(255, 220, 0);
const cv::Scalar kOutline(0, 0, 0);

// A lens bends lines; therefore an edge is drawn in this number of pieces.
constexpr int kPiecesPerEdge = 12;

Polyline LineBetween(const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
  Polyline points;
  for (int i = 0; i <= kPiecesPerEdge; ++i) {
    points.push_back(from + (to - from) * i / kPiecesPerEdge);
  }
  return points;
}

class Canvas {
 public:
  explicit Canvas(const cv::Mat& image) : image_(image.clone()) {
    if (image.channels() == 1) cv::cvtColor(image, image_, cv::COLOR_GRAY2BGR);
    scale_ = std::clamp(image.cols / 900.0, 0.4, 4.0);
  }

  void DrawLine(const Polyline& line, const Projection& project, const cv::Scalar& color) {
    Eigen::Vector2d last;
    bool has_last = false;
    for (const Eigen::Vector3d& point : line) {
      Eigen::Vector2d pixel;
      const bool is_drawable = project(point, &pixel) && IsNear(pixel);
      if (has_last && is_drawable) {
        cv::line(image_, Fixed(last), Fixed(pixel), color, Thickness(), cv::LINE_AA, kFixedBits);
      }
      last = pixel;
      has_last = is_drawable;
    }
  }

  void DrawDot(const Eigen::Vector3d& point, const Projection& project, const cv::Scalar& color) {
    Eigen::Vector2d pixel;
    if (!project(point, &pixel) || !IsNear(pixel)) return;
    const int radius = static_cast<int>(std::lround(2.5 * scale_ * kFixedOne));
    cv::circle(image_, Fixed(pixel), radius, color, cv::FILLED, cv::LINE_AA, kFixedBits);
  }

  void DrawCenter(const Eigen::Vector2d& pixel) {
    if (!IsNear(pixel)) return;
    const int radius = static_cast<int>(std::lround(4 * scale_ * kFixedOne));
    cv::circle(image_, Fixed(pixel), radius, kYellow, Thickness(), cv::LINE_AA, kFixedBits);
  }

  // 'row': line of the text, from the top; negative: from the bottom, -1 is the last.
  void Write(const std::string& text, const cv::Scalar& color, int row = 0) {
    const double font_scale = 0.6 * std::max(scale_, 0.7);
    const double line_height_px = 34 * font_scale;
    const double first_px = row >= 0 ? 8 + 22 * font_scale : image_.rows - 8 + line_height_px;
    const cv::Point origin(static_cast<int>(8 * scale_),
                           static_cast<int>(first_px + row * line_height_px));
    for (const auto& [thickness, ink] : {std::pair(3, kOutline), std::pair(1, color)}) {
      cv::putText(image_, text, origin, cv::FONT_HERSHEY_SIMPLEX, font_scale, ink,
                  thickness * Thickness(), cv::LINE_AA);
    }
  }

  const cv::Mat& image() const { return image_; }

 private:
  static constexpr int kFixedBits = 4;  // fraction of a pixel, for OpenCV's drawing
  static constexpr int kFixedOne = 1 << kFixedBits;

  // OpenCV's integers overflow far outside of the image.
  static bool IsNear(const Eigen::Vector2d& pixel) { return pixel.cwiseAbs().maxCoeff() < 1e5; }
  static cv::Point Fixed(const Eigen::Vector2d& pixel) {
    return {static_cast<int>(std::lround(pixel.x() * kFixedOne)),
            static_cast<int>(std::lround(pixel.y() * kFixedOne))};
  }
  int Thickness() const { return std::max(1, static_cast<int>(scale_)); }

  cv::Mat image_;
  double scale_;  // scale of lines and letters, by the width of the image
};

void DrawOutlines(const TargetShape& shape, const Projection& project, const cv::Scalar& color,
                  Canvas* canvas) {
  for (Polyline outline : shape.outlines) {
    outline.push_back(outline.front());
    canvas->DrawLine(outline, project, color);
  }
}

// Draws the print at its edges in the image, and as pose and lens project it.
void DrawMisfit(const TargetDetection& detection, const CameraModel& camera,
                const TargetShape& shape, Canvas* canvas) {
  const PlaneWarp seen = detection.diagnostics.seen->Warp(camera);
  const auto project = [&](const Eigen::Vector3d& point, Eigen::Vector2d* pixel) {
    return seen.Project(point.head<2>(), pixel);
  };
  DrawOutlines(shape, project, kMagenta, canvas);
  canvas->Write("magenta: where it is seen", kMagenta, 1);
  canvas->Write(fmt::format("yellow: where pose and calibration have it, {:.1f} px beside",
                            detection.diagnostics.misfit_px),
                kYellow, 2);
}

// Name of a find for people who do not know how it was made.
const char* InWords(DetectionMethod method) {
  switch (method) {
    case DetectionMethod::kRing:
      return "ring and cross";
    case DetectionMethod::kPartial:
      return "a part of the pattern";
    case DetectionMethod::kTags:
      return "tag";
    case DetectionMethod::kLetter:
      return "helipad";
    case DetectionMethod::kFollowed:
      return "followed from the last image";
    case DetectionMethod::kOther:
      return "pad";
  }
  return "";
}

// Draws the path of the track, with a dot at each place.
void DrawPath(const Polyline& path_in_world, const RigidTransform& world_from_camera,
              const CameraModel& camera, Canvas* canvas) {
  const RigidTransform camera_from_world = world_from_camera.Inverse();
  const Projection project = [&](const Eigen::Vector3d& point, Eigen::Vector2d* pixel) {
    return camera.Project(camera_from_world * point, pixel) != ProjectionStatus::kOutsideModel;
  };
  canvas->DrawLine(path_in_world, project, kCyan);
  for (const Eigen::Vector3d& place : path_in_world) canvas->DrawDot(place, project, kCyan);
}

void DrawDetection(const TargetDetection& detection, const CameraModel& camera,
                   const TargetShape& shape, bool only_in_image, Canvas* canvas) {
  const RigidTransform& pose = detection.camera_from_target;
  const auto project = [&](const Eigen::Vector3d& point, Eigen::Vector2d* pixel) {
    return camera.Project(pose * point, pixel) != ProjectionStatus::kOutsideModel;
  };
  DrawOutlines(shape, project, kYellow, canvas);
  const std::array<cv::Scalar, 3> colors = {kRed, kGreen, kBlue};
  for (int axis = 0; axis < 3; ++axis) {
    const Eigen::Vector3d end = shape.radius_m() * Eigen::Vector3d::Unit(axis);
    canvas->DrawLine(LineBetween(Eigen::Vector3d::Zero(), end), project, colors[axis]);
  }
  if (!only_in_image && detection.diagnostics.is_misfit() && detection.diagnostics.seen) {
    DrawMisfit(detection, camera, shape, canvas);
  }
  canvas->DrawCenter(detection.center_px);
  const std::string id = detection.id ? fmt::format(" {}", *detection.id) : "";
  const std::string distance =
      only_in_image ? "" : fmt::format(", {:.1f} m", pose.translation.norm());
  canvas->Write(fmt::format("{}{}{}, {:.0f} %", InWords(detection.method), id, distance,
                            100 * detection.quality),
                kGreen);
}

}  // namespace

cv::Mat DrawLandingOverlay(const cv::Mat& image, const CameraModel& camera,
                           const TargetShape& shape, const LandingObservation& observation,
                           const LandingOverlayOptions& options) {
  Canvas canvas(image);
  const TargetReport& report = observation.report;
  const bool has_path = observation.world_from_camera && !options.path_in_world.empty();
  if (has_path) DrawPath(options.path_in_world, *observation.world_from_camera, camera, &canvas);
  if (has_path) canvas.Write("cyan: where the track goes", kCyan, -1);
  if (report.detection) {
    DrawDetection(*report.detection, camera, shape, options.only_in_image, &canvas);
    if (!report.detection->diagnostics.is_misfit())
      canvas.Write("yellow: the pad", kYellow, has_path ? -2 : -1);
  } else {
    canvas.Write("not found: " + MissInWords(observation), kRed);
  }
  return canvas.image();
}

}  // namespace kestrel
