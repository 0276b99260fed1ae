// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/simulation/rendering/flight_camera.h"

#include <cmath>
#include <utility>

#include "kestrel/core/base/options.h"

namespace kestrel {

FlightCamera::FlightCamera(const CameraModel& camera, const LensOptions& lens,
                           const ShutterOptions& shutter, const SensorOptions& sensor,
                           const World& world, Motion world_from_camera)
    : lens_(camera, lens),
      sensor_(sensor),
      renderer_(lens_, world, shutter),
      world_from_camera_(std::move(world_from_camera)) {
  RequireValid(sensor);
}

cv::Mat FlightCamera::Capture(double time_s, double gain, std::uint64_t seed) const {
  const cv::Mat light = renderer_.Render(time_s, world_from_camera_, seed);
  return Expose(sensor_, lens_, gain, ~seed, light);
}

std::optional<Eigen::Vector2d> FlightCamera::Project(double time_s,
                                                     const Path& point_in_world) const {
  // The row's time depends on the row: a few iterations converge.
  constexpr int kRounds = 12;
  constexpr double kTolerance_s = 1e-6;
  double row_time_s = time_s;
  double change_s = 0;
  for (int i = 0; i < kRounds; ++i) {
    const auto pixel = ProjectAt(row_time_s, point_in_world);
    if (!pixel) return std::nullopt;
    const double new_time_s = TimeOfRow(time_s, *pixel);
    change_s = std::abs(new_time_s - row_time_s);
    row_time_s = new_time_s;
    if (change_s < kTolerance_s) break;
  }
  if (change_s >= kTolerance_s) return std::nullopt;
  constexpr int kMoments = 8;
  Eigen::Vector2d sum(0, 0);
  for (int i = 0; i < kMoments; ++i) {
    const double part = (i + 0.5) / kMoments - 0.5;
    const auto pixel =
        ProjectAt(row_time_s + part * renderer_.shutter().exposure_s, point_in_world);
    if (!pixel) return std::nullopt;
    sum += *pixel;
  }
  return sum / kMoments;
}

std::optional<Eigen::Vector2d> FlightCamera::ProjectAt(double time_s,
                                                       const Path& point_in_world) const {
  Eigen::Vector2d pixel;
  const Eigen::Vector3d point = world_from_camera_(time_s).Inverse() * point_in_world(time_s);
  if (lens_.camera().Project(point, &pixel) == ProjectionStatus::kOutsideModel) {
    return std::nullopt;
  }
  return pixel;
}

}  // namespace kestrel
