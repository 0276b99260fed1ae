// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <variant>

#include <Eigen/Core>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "kestrel/core/base/hash.h"
#include "kestrel/core/base/random.h"
#include "kestrel/core/camera/camera_model.h"
#include "kestrel/core/camera/ray_table.h"
#include "kestrel/core/geometry/rigid_transform.h"
#include "kestrel/vision/target/target_print.h"

namespace kestrel {

// Conditions under which an image of a pad is taken.
struct PadImageOptions {
  double blur_px = 0.6;  // sigma of the lens
  double motion_px = 0;  // length of the blur by motion, along the rows
  double noise = 3;      // sigma, gray values
  double contrast = 1;   // of all that is seen
  bool shadow = false;   // the edge of a shadow runs through the pad's middle
};

// Renders prints on a textured ground through any lens, by the area at each of 16 places in a
// pixel.
class PadRenderer {
 public:
  explicit PadRenderer(const CameraModel& camera) : camera_(camera), rays_(camera) {}

  cv::Mat Render(const TargetPrint& print, const RigidTransform& camera_from_pad,
                 const PadImageOptions& options, std::uint64_t seed) const {
    const RigidTransform pad_from_camera = camera_from_pad.Inverse();
    cv::Mat image(camera_.height_px(), camera_.width_px(), CV_32FC1);
    for (int v = 0; v < image.rows; ++v) {
      for (int u = 0; u < image.cols; ++u) {
        const std::optional<Eigen::Vector2d> place = OnPlane(pad_from_camera, u, v);
        const bool near = place && ReachOnBoard(print, *place) < 0.6 * print.board_size_m;
        const int samples = near ? 4 : 1;
        double sum = 0;
        for (int k = 0; k < samples * samples; ++k) {
          const double du = (k % samples + 0.5) / samples - 0.5;
          const double dv = (k / samples + 0.5) / samples - 0.5;
          sum += GrayAt(print, OnPlane(pad_from_camera, u + du, v + dv), options, seed);
        }
        image.at<float>(v, u) = static_cast<float>(sum / (samples * samples));
      }
    }
    return Taken(image, options, seed);
  }

 private:
  std::optional<Eigen::Vector2d> OnPlane(const RigidTransform& pad_from_camera, double u,
                                         double v) const {
    const Eigen::Vector3f seen = rays_.Ray(static_cast<float>(u), static_cast<float>(v));
    const Eigen::Vector3d ray = pad_from_camera.rotation * seen.cast<double>();
    const Eigen::Vector3d& eye = pad_from_camera.translation;
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
    double gray = Ground(*place, seed);
    if (ReachOnBoard(print, *place) < 0.5 * print.board_size_m) {
      double ink = print.board_gray;
      for (const PrintShape& shape : print.shapes) {
        if (std::visit([&](const auto& area) { return IsIn(area, *place); }, shape.area)) {
          ink = shape.gray;
        }
      }
      gray = kBlack + ink * (kWhite - kBlack);
    }
    gray = kMiddle + options.contrast * (gray - kMiddle);
    constexpr double kShade = 0.35;
    if (options.shadow && place->x() + 0.3 * place->y() > 0) gray *= kShade;
    return gray;
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

}  // namespace kestrel
