// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/simulation/flight_camera.h"

#include <utility>

#include "kestrel/base/options.h"

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
  // The row's time depends on the row: a few rounds settle it.
  constexpr int kRounds = 6;
  Eigen::Vector2d pixel(0, 0);
  double row_time_s = time_s;
  for (int i = 0; i < kRounds; ++i) {
    const Eigen::Vector3d point =
        world_from_camera_(row_time_s).Inverse() * point_in_world(row_time_s);
    if (lens_.camera().Project(point, &pixel) == ProjectionStatus::kOutsideModel) {
      return std::nullopt;
    }
    const double new_time_s = time_s + renderer_.RowTime(pixel.y());
    if (new_time_s == row_time_s) break;
    row_time_s = new_time_s;
  }
  return pixel;
}

}  // namespace kestrel
