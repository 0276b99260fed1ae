// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/simulation/labelled_images/scene_renderer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>

#include <Eigen/Geometry>
#include <fmt/format.h>
#include <opencv2/imgproc.hpp>

#include "kestrel/core/base/error.h"
#include "kestrel/core/base/limits.h"
#include "kestrel/core/base/options.h"
#include "kestrel/core/base/random.h"
#include "kestrel/simulation/labelled_images/ground_texture.h"

namespace kestrel {
namespace {

// A pixel with an edge is divided into cells with one ray each. If the plane moves during the
// exposure, every cell is sampled at several times: only whole grids of cells keep an edge in
// place.
constexpr int kCellsPerSideStill = 4;
constexpr int kCellsPerSideMoving = 2;
constexpr int kTimesMoving = 12;

// Rays that meet the plane at a smaller angle (sine) see the sky: the plane ends at the horizon, a
// thousand camera heights away.
constexpr double kHorizonSine = 1e-3;

// Returns gray values from radiances in units of white, with noise.
cv::Mat Expose(const ImagingOptions& imaging, const cv::Mat& radiance) {
  constexpr double kShotNoiseGray = 100;  // gray value at which 'shot_noise' is given
  Random random(imaging.noise_seed);
  cv::Mat image(radiance.size(), CV_8UC1);
  const double range = imaging.white_level - imaging.black_level;
  for (int v = 0; v < image.rows; ++v) {
    for (int u = 0; u < image.cols; ++u) {
      const double light = range * radiance.at<float>(v, u);
      const double shot = imaging.shot_noise * std::sqrt(light / kShotNoiseGray);
      const double noise = std::sqrt(imaging.read_noise * imaging.read_noise + shot * shot);
      const double gray = imaging.black_level + light + (noise > 0 ? noise * random.Normal() : 0);
      image.at<std::uint8_t>(v, u) = cv::saturate_cast<std::uint8_t>(gray);
    }
  }
  return image;
}

void CheckPose(const RigidTransform& camera_from_target) {
  const double height = camera_from_target.Inverse().translation.z();
  if (!(height > 0 && std::isfinite(height))) {
    throw InputError(
        fmt::format("camera_from_target puts the camera {} m above the pattern's plane, expected "
                    "a positive height",
                    height));
  }
}

}  // namespace

RigidTransform PoseAt(const RigidTransform& camera_from_target, const ImagingOptions& imaging,
                      double time_s) {
  return Moved(camera_from_target, time_s * imaging.velocity_in_camera,
               time_s * imaging.angular_velocity_in_camera);
}

double RowTime(const ImagingOptions& imaging, double row, int rows) {
  return imaging.readout_s * ((row + 0.5) / rows - 0.5);
}

std::vector<std::string> Scene::Validate() const {
  std::vector<std::string> violations;
  Require(ground_reflectance, Range{0, 1}, "ground_reflectance", &violations);
  Require(ground_texture, Range{0, 1}, "ground_texture", &violations);
  Require(sky_radiance, AtLeast(0), "sky_radiance", &violations);
  for (std::size_t i = 0; i < layers.size(); ++i) {
    Require(layers[i].reflectance, Range{0, 1}, fmt::format("layers[{}].reflectance", i),
            &violations);
    Require(layers[i].texture, Range{0, 1}, fmt::format("layers[{}].texture", i), &violations);
  }
  for (std::size_t i = 0; i < shadows.size(); ++i) {
    Require(shadows[i].transmission, Range{0, 1}, fmt::format("shadows[{}].transmission", i),
            &violations);
    Require(shadows[i].penumbra_m, AtLeast(0), fmt::format("shadows[{}].penumbra_m", i),
            &violations);
  }
  for (std::size_t i = 0; i < glares.size(); ++i) {
    Require(glares[i].sigma_m, Range{1e-3, 1e3}, fmt::format("glares[{}].sigma_m", i), &violations);
    Require(glares[i].strength, AtLeast(0), fmt::format("glares[{}].strength", i), &violations);
  }
  AddViolations("relief", relief.Validate(), &violations);
  return violations;
}

std::vector<std::string> ImagingOptions::Validate() const {
  std::vector<std::string> violations;
  Require(black_level, Range{0, 255}, "black_level", &violations);
  Require(white_level, Range{0, 255}, "white_level", &violations);
  if (!(white_level > black_level)) {
    violations.push_back(fmt::format("white_level is {}, expected more than black_level, {}",
                                     white_level, black_level));
  }
  Require(blur_sigma_px, Range{0, 20}, "blur_sigma_px", &violations);
  Require(gradient.norm(), {}, "gradient", &violations);
  Require(haze, Range{0, 1}, "haze", &violations);
  Require(haze_radiance, AtLeast(0), "haze_radiance", &violations);
  Require(read_noise, AtLeast(0), "read_noise", &violations);
  Require(shot_noise, AtLeast(0), "shot_noise", &violations);
  Require(exposure_s, AtLeast(0), "exposure_s", &violations);
  Require(readout_s, AtLeast(0), "readout_s", &violations);
  Require(velocity_in_camera.norm(), {}, "velocity_in_camera", &violations);
  Require(angular_velocity_in_camera.norm(), {}, "angular_velocity_in_camera", &violations);
  return violations;
}

// Computes the radiance of single pixels of one picture.
class SceneRenderer::PlanePainter {
 public:
  // The arguments must outlive the painter.
  PlanePainter(const Scene& scene, const GroundTexture& texture,
               const RigidTransform& camera_from_target, const ImagingOptions& imaging)
      : scene_(scene), texture_(texture), middle_(camera_from_target, scene.relief) {
    const bool moving = imaging.exposure_s > 0 && !(imaging.velocity_in_camera.isZero() &&
                                                    imaging.angular_velocity_in_camera.isZero());
    cells_per_side_ = moving ? kCellsPerSideMoving : kCellsPerSideStill;
    const int times = moving ? kTimesMoving : 1;
    for (int i = 0; i < times; ++i) {
      const double time = ((i + 0.5) / times - 0.5) * imaging.exposure_s;
      const RigidTransform pose = PoseAt(camera_from_target, imaging, time);
      CheckPose(pose);
      views_.emplace_back(pose, scene.relief);
    }
  }

  // 'rays': those of the upper left, upper right, lower left and lower right corner of the pixel.
  double Radiance(const std::array<Eigen::Vector3d, 4>& rays) const {
    const std::optional<Footprint> footprint = FootprintOf(rays);
    if (!footprint) return ManyRays(rays);
    if (footprint->sky) return scene_.sky_radiance;
    if (HasEdgeWithin(footprint->center, footprint->radius)) return ManyRays(rays);
    const double texture = texture_.At(footprint->center, footprint->size);
    return RadianceAt(footprint->center, *footprint, texture);
  }

 private:
  // A camera pose relative to the plane, or to the sheet on it.
  struct PlaneView {
    Eigen::Matrix3d pattern_from_camera;
    Eigen::Vector3d camera_in_pattern;
    const Relief& relief;

    PlaneView(const RigidTransform& camera_from_target, const Relief& sheet)
        : pattern_from_camera(camera_from_target.rotation.conjugate().toRotationMatrix()),
          camera_in_pattern(camera_from_target.Inverse().translation),
          relief(sheet) {}

    // Finds the point of the plane that a ray of any length sees; false when it sees none.
    bool Hit(const Eigen::Vector3d& ray_in_camera, Eigen::Vector2d* point) const {
      const Eigen::Vector3d ray = pattern_from_camera * ray_in_camera;
      if (ray.z() > -kHorizonSine) return false;
      const Eigen::Vector2d run = ray.head<2>() / ray.z();
      *point = camera_in_pattern.head<2>() - camera_in_pattern.z() * run;
      if (relief.IsFlat()) return true;
      // The height is that of the visible point, which is found iteratively.
      constexpr int kSteps = 8;
      const Eigen::Vector2d on_plane = *point;
      for (int i = 0; i < kSteps; ++i) *point = on_plane + relief.HeightAt(*point) * run;
      return true;
    }
  };

  // The part of the plane that a pixel sees.
  struct Footprint {
    bool sky = false;
    Eigen::Vector2d center{0, 0};
    Eigen::Vector2d right{0, 0};  // from one pixel to its right neighbour
    Eigen::Vector2d down{0, 0};
    double size = 0;    // geometric mean of its sides
    double radius = 0;  // radius of the circle that contains it during the whole exposure
  };

  // Returns nothing when the pixel sees the horizon.
  std::optional<Footprint> FootprintOf(const std::array<Eigen::Vector3d, 4>& rays) const {
    std::array<Eigen::Vector2d, 4> corners;
    int hits = 0;
    for (int i = 0; i < 4; ++i) hits += middle_.Hit(rays[i], &corners[i]);
    if (hits == 0) return Footprint{.sky = true};
    if (hits < 4) return std::nullopt;
    Footprint footprint;
    footprint.center = 0.25 * (corners[0] + corners[1] + corners[2] + corners[3]);
    footprint.right = 0.5 * (corners[1] + corners[3] - corners[0] - corners[2]);
    footprint.down = 0.5 * (corners[2] + corners[3] - corners[0] - corners[1]);
    footprint.size = std::sqrt(std::abs(footprint.right.x() * footprint.down.y() -
                                        footprint.right.y() * footprint.down.x()));
    for (const Eigen::Vector2d& corner : corners) {
      footprint.radius = std::max(footprint.radius, (corner - footprint.center).norm());
    }
    footprint.radius += 0.5 * MotionOf(rays[0]);
    return footprint;
  }

  // Returns the motion over the plane of the point under a ray during the exposure.
  double MotionOf(const Eigen::Vector3d& ray) const {
    Eigen::Vector2d from;
    Eigen::Vector2d to;
    if (!views_.front().Hit(ray, &from) || !views_.back().Hit(ray, &to)) return 0;
    return (to - from).norm();
  }

  bool HasEdgeWithin(const Eigen::Vector2d& center, double radius) const {
    const auto near_layer = [&](const PaintLayer& layer) {
      return std::abs(layer.shape.NearestEdge(center).distance) < radius;
    };
    const auto near_shadow = [&](const Shadow& shadow) {
      const double reach = radius + 0.5 * shadow.penumbra_m;
      return std::abs(shadow.shape.NearestEdge(center).distance) < reach;
    };
    return std::any_of(scene_.layers.begin(), scene_.layers.end(), near_layer) ||
           std::any_of(scene_.shadows.begin(), scene_.shadows.end(), near_shadow);
  }

  double ManyRays(const std::array<Eigen::Vector3d, 4>& rays) const {
    Footprint cell = FootprintOf(rays).value_or(Footprint{});
    const double texture = texture_.At(cell.center, cell.size);
    cell.right /= cells_per_side_;
    cell.down /= cells_per_side_;
    double sum = 0;
    for (int i = 0; i < cells_per_side_ * cells_per_side_; ++i) {
      const int column = i % cells_per_side_;
      const int row = i / cells_per_side_;
      const double x = (column + 0.5) / cells_per_side_;
      const double y = (row + 0.5) / cells_per_side_;
      const Eigen::Vector3d ray =
          (1 - y) * ((1 - x) * rays[0] + x * rays[1]) + y * ((1 - x) * rays[2] + x * rays[3]);
      for (const PlaneView& view : views_) {
        Eigen::Vector2d point;
        sum += view.Hit(ray, &point) ? RadianceAt(point, cell, texture) : scene_.sky_radiance;
      }
    }
    return sum / (cells_per_side_ * cells_per_side_ * static_cast<double>(views_.size()));
  }

  double RadianceAt(const Eigen::Vector2d& point, const Footprint& cell, double texture) const {
    double reflectance = scene_.ground_reflectance * (1 + scene_.ground_texture * texture);
    for (const PaintLayer& layer : scene_.layers) {
      const double cover = CoverOf(layer.shape, point, cell, 0);
      reflectance += cover * (layer.reflectance * (1 + layer.texture * texture) - reflectance);
    }
    double light = 1;
    for (const Shadow& shadow : scene_.shadows) {
      const double cover = CoverOf(shadow.shape, point, cell, shadow.penumbra_m);
      light *= 1 - cover * (1 - shadow.transmission);
    }
    double glare = 0;
    for (const Glare& spot : scene_.glares) {
      const double distance = (point - spot.center).norm() / spot.sigma_m;
      glare += spot.strength * std::exp(-0.5 * distance * distance);
    }
    return std::max(reflectance, 0.0) * light + glare;
  }

  // The edge is a ramp as wide as the cell's extent across the edge.
  static double CoverOf(const Drawing& shape, const Eigen::Vector2d& point, const Footprint& cell,
                        double min_width) {
    const Drawing::Edge edge = shape.NearestEdge(point);
    const Eigen::Vector2d width(cell.right.dot(edge.normal), cell.down.dot(edge.normal));
    return Coverage(edge.distance, std::max(width.norm(), min_width));
  }

  const Scene& scene_;
  const GroundTexture& texture_;
  PlaneView middle_;
  std::vector<PlaneView> views_;  // at several times of the exposure, in order
  int cells_per_side_ = 1;
};

cv::Mat SceneRenderer::Render(const Scene& scene, const RigidTransform& camera_from_target,
                              const ImagingOptions& imaging) const {
  RequireValid(scene);
  RequireValid(imaging);
  CheckPose(camera_from_target);
  cv::Mat radiance = PaintRadiance(scene, camera_from_target, imaging);
  PassLens(imaging, &radiance);
  return Expose(imaging, radiance);
}

cv::Mat SceneRenderer::PaintRadiance(const Scene& scene, const RigidTransform& camera_from_target,
                                     const ImagingOptions& imaging) const {
  const GroundTexture texture(scene.texture_seed);
  std::optional<PlanePainter> painter;
  cv::Mat radiance(lens_.gain().size(), CV_32F, cv::Scalar(0));
  for (int v = 0; v < radiance.rows; ++v) {
    if (!painter || imaging.readout_s > 0) {
      const double time = RowTime(imaging, v, radiance.rows);
      painter.emplace(scene, texture, PoseAt(camera_from_target, imaging, time), imaging);
    }
    for (int u = 0; u < radiance.cols; ++u) {
      if (lens_.gain().at<float>(v, u) <= 0) continue;
      std::array<Eigen::Vector3d, 4> corners;
      std::ranges::transform(lens_.PixelCorners(u, v), corners.begin(),
                             [](const Eigen::Vector3f& ray) { return ray.cast<double>(); });
      radiance.at<float>(v, u) = static_cast<float>(painter->Radiance(corners));
    }
  }
  return radiance;
}

void SceneRenderer::PassLens(const ImagingOptions& imaging, cv::Mat* radiance) const {
  for (int v = 0; v < radiance->rows; ++v) {
    for (int u = 0; u < radiance->cols; ++u) {
      float& value = radiance->at<float>(v, u);
      const double hazy = value + imaging.haze * (imaging.haze_radiance - value);
      const double cover = lens_.airframe_cover().at<float>(v, u);
      const double seen = hazy + cover * (lens_.options().airframe_radiance - hazy);
      const double light = 1 + imaging.gradient.x() * ((u + 0.5) / radiance->cols - 0.5) +
                           imaging.gradient.y() * ((v + 0.5) / radiance->rows - 0.5);
      value = static_cast<float>(seen * std::max(light, 0.0) * lens_.gain().at<float>(v, u));
    }
  }
  if (imaging.blur_sigma_px > 0) {
    cv::GaussianBlur(*radiance, *radiance, cv::Size(), imaging.blur_sigma_px, imaging.blur_sigma_px,
                     cv::BORDER_REPLICATE);
  }
}

}  // namespace kestrel
