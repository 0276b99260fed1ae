// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include <Eigen/Core>

#include "kestrel/simulation/rendering/frame_renderer.h"
#include "kestrel/simulation/rendering/sensor.h"
#include "kestrel/simulation/scene/motion.h"

namespace kestrel {

// A camera on a flying body, and the projection of what it sees. Thread-safe.
class FlightCamera {
 public:
  // 'world_from_camera': its motion with its vibration. Not copyable or movable; the world must
  // outlive it.
  FlightCamera(const FlightCamera&) = delete;
  FlightCamera& operator=(const FlightCamera&) = delete;

  FlightCamera(const CameraModel& camera, const LensOptions& lens, const ShutterOptions& shutter,
               const SensorOptions& sensor, const World& world, Motion world_from_camera);

  // Returns the 8-bit image whose exposure has its middle at 'time_s'. 'gain' multiplies the light,
  // 'seed' determines the noise.
  cv::Mat Capture(double time_s, double gain, std::uint64_t seed) const;

  // Returns the pixel at which a point appears in that image: the middle of its streak during the
  // exposure of the row in which it appears. Nothing where the lens model is not valid, or where
  // the image moves as fast as the rolling shutter, so that there is no single row (far beside the
  // image).
  std::optional<Eigen::Vector2d> Project(double time_s, const Path& point_in_world) const;

  // Returns the middle of the exposure of a pixel's row, s.
  double TimeOfRow(double time_s, const Eigen::Vector2d& pixel) const {
    return time_s + renderer_.RowTime(pixel.y());
  }

  const Lens& lens() const { return lens_; }
  RigidTransform WorldFromCamera(double time_s) const { return world_from_camera_(time_s); }

 private:
  std::optional<Eigen::Vector2d> ProjectAt(double time_s, const Path& point_in_world) const;

  Lens lens_;
  SensorOptions sensor_;
  FrameRenderer renderer_;
  Motion world_from_camera_;
};

}  // namespace kestrel
