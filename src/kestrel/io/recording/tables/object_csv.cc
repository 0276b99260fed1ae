// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/io/recording/tables/object_csv.h"

#include <cmath>
#include <optional>

#include <fmt/format.h>

#include "kestrel/io/recording/tables/csv_table.h"

namespace kestrel {
namespace {

std::string Position(const std::optional<ObjectLocation>& location) {
  if (!location) return ",,";
  const Eigen::Vector3d& p = location->position;
  return fmt::format("{:.6f},{:.6f},{:.6f}", p.x(), p.y(), p.z());
}

std::string Sigma(const std::optional<ObjectLocation>& location) {
  return location ? fmt::format("{:.4f}", std::sqrt(location->covariance.trace() / 3)) : "";
}

// The columns shape to digit_probability.
std::string ShapeCells(const ObjectDetection& detection, const ObjectModel& model) {
  const char* shape = detection.completeness == Completeness::kMerged
                          ? ToString(detection.completeness)
                          : ToString(model.classes[detection.class_index].shape);
  if (!detection.digits) return fmt::format("{},,", shape);
  const LikelyDigit digit = LikeliestDigit(*detection.digits);
  return fmt::format("{},{},{:.4f}", shape, digit.digit, digit.probability);
}

// The columns u_px to pixels.
std::string DetectionCells(const ObjectDetection& detection,
                           const std::optional<ObjectLocation>& in_world,
                           const ObjectModel& model) {
  const Ellipse& ellipse = detection.ellipse;
  return fmt::format(
      "{:.3f},{:.3f},{:.2f},{:.2f},{:.4f},{},{:.4f},{},{},{},{:.4f},{:.4f},{}",
      detection.center_px.x(), detection.center_px.y(), ellipse.semi_major, ellipse.semi_minor,
      ellipse.angle, CsvCell(model.classes[detection.class_index].name),
      detection.class_probability, Position(detection.location), Position(in_world),
      Sigma(detection.location), detection.roundness, detection.circularity, detection.pixels);
}

}  // namespace

std::string ObjectCsvHeader() {
  return "frame,timestamp_ns,u_px,v_px,semi_major_px,semi_minor_px,angle_rad,class,"
         "class_probability,p_CO_C_x_m,p_CO_C_y_m,p_CO_C_z_m,p_WO_W_x_m,p_WO_W_y_m,p_WO_W_z_m,"
         "sigma_m,roundness,circularity,pixels,detect_ms,shape,digit,digit_probability\n";
}

std::string ObjectCsvRows(const std::string& frame_name, const HuntObservation& observation,
                          const ObjectModel& model) {
  const std::string frame =
      fmt::format("{},{}", CsvCell(frame_name), ToNanoseconds(observation.time));
  const std::string detect_ms = fmt::format("{:.4f}", 1e3 * ToSeconds(observation.detect_time));
  std::string rows;
  for (std::size_t i = 0; i < observation.report.detections.size(); ++i) {
    const ObjectDetection& detection = observation.report.detections[i];
    rows += fmt::format("{},{},{},{}\n", frame,
                        DetectionCells(detection, observation.in_world[i], model), detect_ms,
                        ShapeCells(detection, model));
  }
  if (rows.empty()) rows = fmt::format("{}{:,>18}{},,,\n", frame, "", detect_ms);
  return rows;
}

}  // namespace kestrel
