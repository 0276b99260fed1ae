// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/io/recording/tables/landing_csv.h"

#include <optional>

#include <fmt/format.h>

#include "kestrel/io/recording/tables/csv_table.h"

namespace kestrel {
namespace {

std::string Position(const std::optional<Eigen::Vector3d>& position) {
  if (!position) return ",,";
  return fmt::format("{:.6f},{:.6f},{:.6f}", position->x(), position->y(), position->z());
}

// The columns u_px to p_CP_C_z_m, from the detection.
std::string ImageCells(const std::optional<TargetDetection>& detection, bool only_in_image) {
  if (!detection) return ",,,,,,";
  return fmt::format("{:.3f},{:.3f},{},{:.4f},{}", detection->center_px.x(),
                     detection->center_px.y(), ToString(detection->method), detection->quality,
                     only_in_image ? ",," : Position(detection->camera_from_target.translation));
}

// 0 stands for "no edges", as a measured misfit is never exactly 0.
std::string MisfitCell(const std::optional<TargetDetection>& detection, bool only_in_image) {
  if (!detection || only_in_image || detection->diagnostics.misfit_px == 0) return "";
  return fmt::format("{:.3f}", detection->diagnostics.misfit_px);
}

std::string IdCell(const std::optional<TargetDetection>& detection) {
  return detection && detection->id ? std::to_string(*detection->id) : "";
}

std::string SigmaCells(const std::optional<TargetDetection>& detection, bool only_in_image) {
  if (!detection || only_in_image) return ",,";
  return Position(detection->covariance.diagonal().head<3>().cwiseSqrt().eval());
}

std::string LandingRow(const std::string& frame_name, Time time,
                       const LandingObservation& observation, bool only_in_image) {
  const TargetReport& report = observation.report;
  const auto& yaw = observation.yaw_in_world;
  return fmt::format(
      "{},{},{},{},{},{},{},{},{:.4f},{},{}\n", CsvCell(frame_name), ToNanoseconds(time),
      report.detection ? 1 : 0, ImageCells(report.detection, only_in_image),
      Position(observation.center_in_world), yaw ? fmt::format("{:.6f}", *yaw) : "",
      SigmaCells(report.detection, only_in_image), report.detection ? "" : ToString(report.reached),
      1e3 * ToSeconds(observation.detect_time), MisfitCell(report.detection, only_in_image),
      IdCell(report.detection));
}

}  // namespace

std::string LandingCsvHeader() {
  return "frame,timestamp_ns,detected,u_px,v_px,method,quality,p_CP_C_x_m,p_CP_C_y_m,p_CP_C_z_m,"
         "p_WP_W_x_m,p_WP_W_y_m,p_WP_W_z_m,yaw_WP_rad,sigma_x_m,sigma_y_m,sigma_z_m,rejected_at,"
         "detect_ms,misfit_px,target_id\n";
}

std::string LandingCsvRow(const std::string& frame_name, const LandingObservation& observation,
                          bool only_in_image) {
  return LandingRow(frame_name, observation.time, observation, only_in_image);
}

std::string LandingCsvRow(const Frame& frame, const LandingObservation& observation,
                          bool only_in_image) {
  return LandingRow(frame.name, frame.time, observation, only_in_image);
}

std::string UnreadableLandingCsvRow(const std::string& frame_name, Time time) {
  return fmt::format("{},{},0{:,>15}{},,,\n", CsvCell(frame_name), ToNanoseconds(time), "",
                     kUnreadable);
}

}  // namespace kestrel
