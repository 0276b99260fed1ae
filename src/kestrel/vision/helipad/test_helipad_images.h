// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <variant>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "kestrel/core/base/hash.h"
#include "kestrel/core/base/random.h"
#include "kestrel/core/camera/camera_model.h"
#include "kestrel/core/camera/ray_table.h"
#include "kestrel/core/geometry/angles.h"
#include "kestrel/core/geometry/rigid_transform.h"
#include "kestrel/vision/target/target_print.h"

namespace kestrel {

// A shadow on the ground.
struct PadShadow {
  enum class Shape { kNone, kHalfPlane, kBar, kFourArms };
  Shape shape = Shape::kNone;
  double light = 0.35;  // share of the light that remains
  Eigen::Vector2d center = Eigen::Vector2d::Zero();
  double turn = 0;       // rad
  double size_m = 0.3;   // half of the bar's width; radius of the body between the arms
  double soft_m = 0.01;  // width of its edge

  // Returns the share of the light at a place.
  double LightAt(const Eigen::Vector2d& place) const {
    if (shape == Shape::kNone) return 1;
    const Eigen::Vector2d local = Eigen::Rotation2Dd(-turn) * (place - center);
    return light + (1 - light) * std::clamp(0.5 + Outside(local) / soft_m, 0.0, 1.0);
  }

 private:
  // Distance from the shadow, about; negative within it.
  double Outside(const Eigen::Vector2d& local) const {
    if (shape == Shape::kHalfPlane) return local.x();
    const Eigen::Vector2d away = local.cwiseAbs();
    if (shape == Shape::kBar) return away.x() - size_m;
    constexpr double kArmLength = 3, kArmWidth = 0.2;  // as shares of the body's radius
    const double arms =
        std::max(away.minCoeff() - kArmWidth * size_m, away.maxCoeff() - kArmLength * size_m);
    return std::min(local.norm() - size_m, arms);
  }
};

// Returns a shadow whose edge runs across the pad's middle, or near it.
inline PadShadow RandomShadow(Random* random) {
  PadShadow shadow = {};
  shadow.shape = static_cast<PadShadow::Shape>(random->Integer(1, 3));
  shadow.light = random->Uniform(0.2, 0.6);
  const double x = random->Uniform(-0.35, 0.35);
  const double y = random->Uniform(-0.35, 0.35);
  shadow.center = {x, y};
  shadow.turn = random->Uniform(0, 2 * kPi);
  shadow.size_m = random->Uniform(0.08, 0.4);
  shadow.soft_m = random->Chance(0.5) ? 0.005 : random->Uniform(0.02, 0.2);
  return shadow;
}

// Light that glossy paint reflects: a highlight that fades out.
struct PadGlare {
  double gray = 0;  // that it adds in its middle
  Eigen::Vector2d center = Eigen::Vector2d::Zero();
  double sigma_m = 1;

  double At(const Eigen::Vector2d& place) const {
    return gray * std::exp(-0.5 * (place - center).squaredNorm() / (sigma_m * sigma_m));
  }
};

// Returns a highlight on the pad, or near it.
inline PadGlare RandomGlare(Random* random) {
  PadGlare glare;
  glare.gray = random->Uniform(60, 200);
  const double x = random->Uniform(-0.5, 0.5);
  const double y = random->Uniform(-0.5, 0.5);
  glare.center = {x, y};
  glare.sigma_m = random->Uniform(0.2, 2);
  return glare;
}

// Conditions under which an image of a pad is taken.
struct PadImageOptions {
  double blur_px = 0.6;  // sigma of the lens
  double motion_px = 0;  // length of the blur by motion, along the rows
  double noise = 3;      // sigma, gray values
  double contrast = 1;   // for all that is seen
  PadShadow shadow = {};
  PadGlare glare = {};
};

// Returns the conditions of a common image.
inline PadImageOptions RandomPadImage(Random* random) {
  PadImageOptions taken;
  taken.noise = random->Uniform(1, 5);
  taken.blur_px = random->Uniform(0.3, 0.9);
  taken.contrast = random->Uniform(0.5, 1);
  return taken;
}

// Renders prints on a textured ground through any lens, by the area at each of 16 places in a
// pixel.
class PadRenderer {
 public:
  explicit PadRenderer(const CameraModel& camera) : camera_(camera), rays_(camera) {}

  cv::Mat Render(const TargetPrint& print, const RigidTransform& camera_from_pad,
                 const PadImageOptions& options, std::uint64_t seed) const {
    const Plane plane{camera_from_pad.rotation.conjugate().toRotationMatrix(),
                      camera_from_pad.Inverse().translation};
    cv::Mat image(camera_.height_px(), camera_.width_px(), CV_32FC1);
    for (int v = 0; v < image.rows; ++v) {
      for (int u = 0; u < image.cols; ++u) {
        const std::optional<Eigen::Vector2d> place = OnPlane(plane, u, v);
        const bool near = place && ReachOnBoard(print, *place) < 0.6 * print.board_size_m;
        const int samples = near ? 4 : 1;
        double sum = 0;
        for (int k = 0; k < samples * samples; ++k) {
          const int row = k / samples;
          const double du = (k % samples + 0.5) / samples - 0.5;
          const double dv = (row + 0.5) / samples - 0.5;
          sum += GrayAt(print, OnPlane(plane, u + du, v + dv), options, seed);
        }
        image.at<float>(v, u) = static_cast<float>(sum / (samples * samples));
      }
    }
    return Taken(image, options, seed);
  }

 private:
  struct Plane {
    Eigen::Matrix3d from_camera;
    Eigen::Vector3d eye;
  };

  std::optional<Eigen::Vector2d> OnPlane(const Plane& plane, double u, double v) const {
    const Eigen::Vector3f seen = rays_.Ray(static_cast<float>(u), static_cast<float>(v));
    const Eigen::Vector3d ray = plane.from_camera * seen.cast<double>();
    const Eigen::Vector3d& eye = plane.eye;
    if (!(ray.z() < -1e-3)) return std::nullopt;
    return Eigen::Vector2d((eye - eye.z() / ray.z() * ray).head<2>());
  }

  static bool IsIn(const PrintRing& ring, const Eigen::Vector2d& place) {
    const double radius = (place - ring.center).norm();
    return radius < ring.outer_radius_m && radius >= ring.inner_radius_m;
  }

  static bool IsIn(const PrintPolygon& polygon, const Eigen::Vector2d& place) {
    bool inside = false;
    for (const auto& loop : polygon.loops) {
      for (std::size_t i = 0; i < loop.size(); ++i) {
        const Eigen::Vector2d a = loop[i] - place, b = loop[(i + 1) % loop.size()] - place;
        if ((a.y() > 0) == (b.y() > 0)) continue;
        if (a.x() - a.y() * (b.x() - a.x()) / (b.y() - a.y()) > 0) inside = !inside;
      }
    }
    return inside;
  }

  static double GrayAt(const TargetPrint& print, const std::optional<Eigen::Vector2d>& place,
                       const PadImageOptions& options, std::uint64_t seed) {
    constexpr double kSky = 200, kWhite = 205, kBlack = 35, kMiddle = 0.5 * (kWhite + kBlack);
    if (!place) return kSky;
    double gray = 0;
    if (ReachOnBoard(print, *place) < 0.5 * print.board_size_m) {
      double ink = print.board_gray;
      for (const PrintShape& shape : print.shapes) {
        if (std::visit([&](const auto& area) { return IsIn(area, *place); }, shape.area)) {
          ink = shape.gray;
        }
      }
      gray = kBlack + ink * (kWhite - kBlack);
    } else {
      gray = Ground(*place, seed);
    }
    gray = kMiddle + options.contrast * (gray - kMiddle);
    return gray * options.shadow.LightAt(*place) + options.glare.At(*place);
  }

  // Blotches of several sizes.
  static double Ground(const Eigen::Vector2d& place, std::uint64_t seed) {
    double gray = 110;
    double scale = 1.5;
    for (int octave = 0; octave < 4; ++octave, scale *= 2.3) {
      const auto x = static_cast<std::int64_t>(std::floor(place.x() * scale));
      const auto y = static_cast<std::int64_t>(std::floor(place.y() * scale));
      const std::uint64_t bits =
          Hash(seed, static_cast<std::uint64_t>(x * 7919 + y * 104729 + octave));
      gray += 36 * (static_cast<double>(bits >> 40) / (1 << 24) - 0.5);
    }
    return gray;
  }

  static cv::Mat Taken(cv::Mat image, const PadImageOptions& options, std::uint64_t seed) {
    if (options.blur_px > 0) cv::GaussianBlur(image, image, cv::Size(), options.blur_px);
    if (options.motion_px >= 1) {
      cv::blur(image, image, cv::Size(static_cast<int>(options.motion_px), 1));
    }
    Random random(seed);
    cv::Mat taken(image.size(), CV_8UC1);
    for (int v = 0; v < image.rows; ++v) {
      for (int u = 0; u < image.cols; ++u) {
        taken.at<std::uint8_t>(v, u) = cv::saturate_cast<std::uint8_t>(
            image.at<float>(v, u) + options.noise * random.Normal());
      }
    }
    return taken;
  }

  const CameraModel& camera_;
  RayTable rays_;
};

// A camera that looks down from 'altitude' with some tilt, the pad somewhere near its middle.
inline RigidTransform RandomPadBelow(double altitude, Random* random) {
  const double yaw = random->Uniform(0, 2 * kPi);
  const double tilt = random->Uniform(0, Radians(15));
  const double way = random->Uniform(0, 2 * kPi);
  const double x = random->Uniform(-0.3, 0.3) * altitude;
  const double y = random->Uniform(-0.2, 0.2) * altitude;
  const Eigen::Quaterniond down(Eigen::AngleAxisd(kPi, Eigen::Vector3d::UnitX()));
  const Eigen::Vector3d axis(std::cos(way), std::sin(way), 0);
  const Eigen::AngleAxisd tilted(tilt, axis), turned(yaw, Eigen::Vector3d::UnitZ());
  return {tilted * down * turned, tilted * Eigen::Vector3d(x, y, altitude)};
}

}  // namespace kestrel
