// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/io/recording/tables/follow_csv.h"

#include <cmath>
#include <tuple>

#include <fmt/format.h>

#include "kestrel/io/recording/tables/csv_table.h"
#include "kestrel/io/recording/tables/landing_csv.h"

namespace kestrel {
namespace {

std::string PointCells(const Eigen::Vector3d& vector) {
  return fmt::format("{:.6f},{:.6f},{:.6f}", vector.x(), vector.y(), vector.z());
}

std::string BoxCells(const RegionReport& region) {
  if (region.state == RegionState::kLost) return ",,,";
  const cv::Rect2d& box = region.box_px;
  return fmt::format("{:.2f},{:.2f},{:.2f},{:.2f}", box.x, box.y, box.width, box.height);
}

// Standard deviations along the line of sight on the ground, and across it.
std::string GroundSigmaCells(const Eigen::Vector3d& sight, const Eigen::Matrix3d& covariance) {
  const Eigen::Vector2d flat = sight.head<2>();
  const Eigen::Vector2d along = flat.norm() > 0 ? flat.normalized() : Eigen::Vector2d::UnitX();
  const Eigen::Vector2d across(-along.y(), along.x());
  const Eigen::Matrix2d level = covariance.topLeftCorner<2, 2>();
  return fmt::format("{:.6f},{:.6f}", std::sqrt(along.dot(level * along)),
                     std::sqrt(across.dot(level * across)));
}

// The columns p_WR_W_x_m to sigma_across_m: the track, or before there is one the place alone.
std::string WorldCells(const FollowObservation& observation) {
  const auto& [place, target, camera] =
      std::tie(observation.place, observation.target, observation.world_from_camera);
  const bool is_lost = observation.region->state == RegionState::kLost;
  if (is_lost || !camera || (!place && !target)) return ",,,,,,,";
  const Eigen::Vector3d position = target ? target->motion.position() : place->position;
  const Eigen::Matrix3d covariance =
      target ? Eigen::Matrix3d(target->motion.covariance.topLeftCorner<3, 3>()) : place->covariance;
  return fmt::format("{},{},{}", PointCells(position),
                     target ? PointCells(target->motion.velocity()) : ",,",
                     GroundSigmaCells(position - camera->translation, covariance));
}

}  // namespace

std::string FollowCsvHeader() {
  return "frame,timestamp_ns,state,x_px,y_px,width_px,height_px,quality,p_WR_W_x_m,p_WR_W_y_m,"
         "p_WR_W_z_m,v_x_mps,v_y_mps,v_z_mps,sigma_along_m,sigma_across_m,follow_ms\n";
}

std::string FollowCsvRow(const std::string& frame_name, const FollowObservation& observation,
                         bool only_in_image) {
  const RegionReport& region = *observation.region;
  return fmt::format("{},{},{},{},{:.4f},{},{:.4f}\n", CsvCell(frame_name),
                     ToNanoseconds(observation.time), ToString(region.state), BoxCells(region),
                     region.probability, only_in_image ? ",,,,,,," : WorldCells(observation),
                     1e3 * ToSeconds(observation.detect_time));
}

std::string UnreadableFollowCsvRow(const std::string& frame_name, Time time) {
  return fmt::format("{},{},{}{:,>14}\n", CsvCell(frame_name), ToNanoseconds(time), kUnreadable,
                     "");
}

}  // namespace kestrel
