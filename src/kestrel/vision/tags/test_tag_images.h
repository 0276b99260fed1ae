// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "kestrel/core/base/random.h"
#include "kestrel/core/camera/camera_model.h"
#include "kestrel/core/camera/ray_table.h"
#include "kestrel/core/geometry/angles.h"
#include "kestrel/core/geometry/rigid_transform.h"
#include "kestrel/vision/tags/tag_board.h"

namespace kestrel {

// Returns a board of one tag. 'size_m': side of the tag, m.
inline TagBoard BoardOfTag(const std::string& family, int id, double size_m) {
  return TagTargetOptions{.family = family, .id = id, .size_m = size_m}.Board();
}

// Conditions under which an image of a board is taken.
struct TagImageOptions {
  double blur_px = 0.5;  // sigma of the lens
  double motion_px = 0;  // length of the blur by motion, along the rows
  double noise = 3;      // sigma, gray values
  double contrast = 1;   // between the print's black and white
  bool shadow = false;   // the edge of a shadow runs through the board's middle
};

// Renders boards on a textured ground through any lens.
class TagRenderer {
 public:
  explicit TagRenderer(const CameraModel& camera) : camera_(camera), rays_(camera) {}

  cv::Mat Render(const std::vector<PrintedTag>& tags, const RigidTransform& camera_from_board,
                 const TagImageOptions& options, std::uint64_t seed) const {
    const Plane plane{camera_from_board.rotation.conjugate().toRotationMatrix(),
                      camera_from_board.Inverse().translation};
    double plate = 0;  // half of the white plate's side
    std::vector<PlacedTag> placed;
    for (const PrintedTag& tag : tags) {
      plate = std::max(
          plate, tag.center.lpNorm<Eigen::Infinity>() + M_SQRT1_2 * tag.grid.width * tag.cell_m);
      placed.push_back({&tag, std::cos(tag.heading), std::sin(tag.heading)});
    }
    cv::Mat image(camera_.height_px(), camera_.width_px(), CV_32FC1);
    for (int v = 0; v < image.rows; ++v) {
      for (int u = 0; u < image.cols; ++u) {
        const std::optional<Eigen::Vector2d> place = OnPlane(plane, u, v);
        const bool near = place && place->lpNorm<Eigen::Infinity>() < 1.2 * plate + 0.05;
        const int samples = near ? 5 : 1;
        double sum = 0;
        for (int row = 0; row < samples; ++row) {
          for (int column = 0; column < samples; ++column) {
            const double du = (column + 0.5) / samples - 0.5;
            const double dv = (row + 0.5) / samples - 0.5;
            sum += GrayAt(placed, plate, OnPlane(plane, u + du, v + dv), options, seed);
          }
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

  struct PlacedTag {
    const PrintedTag* tag;
    double cosine, sine;  // where it heads
  };

  std::optional<Eigen::Vector2d> OnPlane(const Plane& plane, double u, double v) const {
    const Eigen::Vector3f seen = rays_.Ray(static_cast<float>(u), static_cast<float>(v));
    const Eigen::Vector3d ray = plane.from_camera * seen.cast<double>();
    const Eigen::Vector3d& eye = plane.eye;
    if (!(ray.z() < -1e-3)) return std::nullopt;
    return (eye - eye.z() / ray.z() * ray).head<2>();
  }

  static double GrayAt(const std::vector<PlacedTag>& tags, double plate,
                       const std::optional<Eigen::Vector2d>& place, const TagImageOptions& options,
                       std::uint64_t seed) {
    constexpr double kSky = 200, kWhite = 215, kBlack = 30, kMiddle = 0.5 * (kWhite + kBlack);
    if (!place) return kSky;
    const bool is_on_plate = place->lpNorm<Eigen::Infinity>() < plate;
    double gray = is_on_plate ? kWhite : Ground(*place, seed);
    for (const auto& [printed, cosine, sine] : tags) {
      const PrintedTag& tag = *printed;
      const Eigen::Vector2d d = *place - tag.center;
      const double column = (cosine * d.x() + sine * d.y()) / tag.cell_m + 0.5 * tag.grid.width;
      const double row = 0.5 * tag.grid.width - (cosine * d.y() - sine * d.x()) / tag.cell_m;
      if (column < 0 || row < 0 || column >= tag.grid.width || row >= tag.grid.width) continue;
      const TagCell cell = tag.grid.at(static_cast<int>(column), static_cast<int>(row));
      if (cell != TagCell::kNone) gray = cell == TagCell::kWhite ? kWhite : kBlack;
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
      std::uint64_t hash =
          seed + 0x9E3779B97F4A7C15u * static_cast<std::uint64_t>(x * 7919 + y * 104729 + octave);
      hash = (hash ^ (hash >> 30)) * 0xBF58476D1CE4E5B9u;
      hash = (hash ^ (hash >> 27)) * 0x94D049BB133111EBu;
      gray += 36 * (static_cast<double>(hash >> 40) / (1 << 24) - 0.5);
    }
    return gray;
  }

  static cv::Mat Taken(cv::Mat image, const TagImageOptions& options, std::uint64_t seed) {
    if (options.blur_px > 0) cv::GaussianBlur(image, image, cv::Size(), options.blur_px);
    if (options.motion_px >= 1) {
      cv::blur(image, image, cv::Size(static_cast<int>(options.motion_px), 1));
    }
    Random random(seed);
    cv::Mat taken(image.size(), CV_8UC1);
    for (int v = 0; v < image.rows; ++v) {
      for (int u = 0; u < image.cols; ++u) {
        const double noise = options.noise * random.Normal();
        taken.at<std::uint8_t>(v, u) =
            cv::saturate_cast<std::uint8_t>(image.at<float>(v, u) + noise);
      }
    }
    return taken;
  }

  CameraModel camera_;
  RayTable rays_;
};

// Returns the pose of a level board below a camera that looks down: 'height' below it, 'offset' (m)
// aside to the right and down in the image, turned by 'heading', under a camera that is tilted by
// rotation vector 'tilt'.
inline RigidTransform BoardBelow(double height, const Eigen::Vector2d& offset, double heading,
                                 const Eigen::Vector3d& tilt) {
  const Eigen::Quaterniond face_up(Eigen::AngleAxisd(kPi, Eigen::Vector3d::UnitX()));
  const Eigen::Quaterniond turn(Eigen::AngleAxisd(heading, Eigen::Vector3d::UnitZ()));
  const RigidTransform level{face_up * turn, {offset.x(), offset.y(), height}};
  return RigidTransform{RotationBy(tilt), Eigen::Vector3d::Zero()} * level;
}

// The same at random, tilted by up to 'tilt' (rad), in view: up to 'off_axis' (rad) from below.
inline RigidTransform RandomBoardBelow(double height, double off_axis, double tilt,
                                       Random* random) {
  const double away = height * std::tan(off_axis * std::sqrt(random->Uniform()));
  const double direction = random->Uniform(-kPi, kPi);
  const double heading = random->Uniform(-kPi, kPi);
  const double tilt_x = random->Uniform(-tilt, tilt);
  const double tilt_y = random->Uniform(-tilt, tilt);
  return BoardBelow(height, {away * std::cos(direction), away * std::sin(direction)}, heading,
                    {tilt_x, tilt_y, 0});
}

}  // namespace kestrel
