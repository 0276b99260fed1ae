// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/simulation/recordings/hunt_truth.h"

#include <cmath>
#include <optional>

#include <fmt/format.h>

#include "kestrel/simulation/rendering/occlusion.h"
#include "kestrel/simulation/vehicle/flight_time.h"

namespace kestrel {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

bool IsInside(const Vector2d& pixel, const CameraModel& camera, double margin_px) {
  return pixel.x() > -0.5 - margin_px && pixel.x() < camera.width_px() - 0.5 + margin_px &&
         pixel.y() > -0.5 - margin_px && pixel.y() < camera.height_px() - 0.5 + margin_px;
}

// Returns the part of the upper face that is inside of the image, with nothing in front of it.
double VisiblePart(const HuntObject& object, const SimulatedFlight& flight, double time_s) {
  const auto camera_now = flight.CameraAt(time_s);
  const FlightCamera& camera = *camera_now;
  constexpr int kSteps = 10;
  const Vector2d along(std::cos(object.yaw), std::sin(object.yaw));
  int inside = 0;
  int all = 0;
  for (int i = 0; i < kSteps * kSteps; ++i) {
    const int column = i % kSteps;
    const int row = i / kSteps;
    const double x = 2 * (column + 0.5) / kSteps - 1;
    const double y = 2 * (row + 0.5) / kSteps - 1;
    if (object.shape == "disc" && x * x + y * y > 1) continue;
    const Vector2d offset = x * object.half_size.x() * along +
                            y * object.half_size.y() * Vector2d(-along.y(), along.x());
    const auto point = [&](double row_time_s) {
      return Vector3d(object.center(row_time_s) + Vector3d(offset.x(), offset.y(), 0));
    };
    ++all;
    const auto pixel = camera.Project(time_s, point);
    if (!pixel || !IsInside(*pixel, camera.lens().camera(), 0)) continue;
    const double row_time_s = camera.TimeOfRow(time_s, *pixel);
    inside += !IsHidden(flight.world(), row_time_s, camera.WorldFromCamera(row_time_s).translation,
                        point(row_time_s));
  }
  return static_cast<double>(inside) / all;
}

// Returns one row, or nothing when the object is not in view.
std::string ObjectRow(const HuntObject& object, const SimulatedFlight& flight, double time_s) {
  const auto camera_now = flight.CameraAt(time_s);
  const FlightCamera& camera = *camera_now;
  const CameraModel& model = camera.lens().camera();
  const auto pixel = camera.Project(time_s, object.center);
  if (!pixel) return "";
  // Half of the object may be in view while its middle is not.
  const double range_m =
      (camera.WorldFromCamera(time_s).translation - object.center(time_s)).norm();
  const double margin_px = 1.5 * object.size_m * model.intrinsics().fx_px / range_m;
  if (!IsInside(*pixel, model, margin_px)) return "";
  const double visible = VisiblePart(object, flight, time_s);
  if (visible <= 0) return "";
  constexpr double kStep_s = 1e-3;
  const Vector3d p = object.center(time_s);
  const Vector3d v =
      (object.center(time_s + kStep_s) - object.center(time_s - kStep_s)) / (2 * kStep_s);
  return fmt::format("{},{},{:.6f},{:.6f},{:.6f},{:.6f},{:.6f},{:.6f},{:.4f},{:.4f},{:.4f}\n",
                     ToNanoseconds(TimeOfFlight(time_s)), object.id, p.x(), p.y(), p.z(), v.x(),
                     v.y(), v.z(), pixel->x(), pixel->y(), visible);
}

}  // namespace

std::string ObjectsText(const std::vector<HuntObject>& objects) {
  std::string text = "#id [],class [],diameter [m],shape []\n";
  for (const HuntObject& object : objects) {
    text += fmt::format("{},{},{},{}\n", object.id, object.color, object.size_m, object.shape);
  }
  return text;
}

std::string ObjectRowsText(const std::vector<HuntObject>& objects, const SimulatedFlight& flight) {
  std::string text =
      "#timestamp [ns],id [],p_WO_W_x [m],p_WO_W_y [m],p_WO_W_z [m],"
      "v_WO_W_x [m s^-1],v_WO_W_y [m s^-1],v_WO_W_z [m s^-1],u [px],v [px],visible_fraction []\n";
  for (const double time_s : flight.times_s()) {
    for (const HuntObject& object : objects) text += ObjectRow(object, flight, time_s);
  }
  return text;
}

std::string DigitsText(const std::vector<HuntObject>& objects) {
  std::string text = "#id [],digit [],yaw [rad]\n";
  for (const HuntObject& object : objects) {
    if (object.digit >= 0)
      text += fmt::format("{},{},{:.6f}\n", object.id, object.digit, object.yaw);
  }
  return text;
}

}  // namespace kestrel
