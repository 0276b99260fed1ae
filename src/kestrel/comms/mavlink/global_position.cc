// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/comms/mavlink/global_position.h"

#include <cmath>
#include <numbers>

#include "kestrel/core/base/parse_number.h"

namespace kestrel {
namespace {

constexpr double kRadiansPerUnit = 1e-7 * std::numbers::pi / 180;

double EarthRadius(AutopilotKind kind) {
  constexpr double kPx4Radius_m = 6371000;
  constexpr double kArduPilotRadius_m = 6378100;
  return kind == AutopilotKind::kPx4 ? kPx4Radius_m : kArduPilotRadius_m;
}

// Relative size of the circle of latitude in the middle between two latitudes.
double Shrinking(double latitude_e7, double other_e7) {
  return std::cos(kRadiansPerUnit * (latitude_e7 + other_e7) / 2);
}

}  // namespace

Eigen::Vector3d LocalFromGlobal(AutopilotKind kind, const GlobalPosition& origin,
                                const GlobalPosition& position) {
  constexpr double kTurn_e7 = 360e7;
  const double scale_m = kRadiansPerUnit * EarthRadius(kind);
  const double east_e7 =
      std::remainder(static_cast<double>(position.longitude_e7) - origin.longitude_e7, kTurn_e7);
  const double north_e7 = static_cast<double>(position.latitude_e7) - origin.latitude_e7;
  return {scale_m * east_e7 * Shrinking(position.latitude_e7, origin.latitude_e7),
          scale_m * north_e7, position.altitude_m - origin.altitude_m};
}

GlobalPosition GlobalFromLocal(AutopilotKind kind, const GlobalPosition& origin,
                               const Eigen::Vector3d& in_world) {
  const double scale_m = kRadiansPerUnit * EarthRadius(kind);
  const double latitude_e7 = origin.latitude_e7 + in_world.y() / scale_m;
  const double longitude_e7 =
      origin.longitude_e7 + in_world.x() / (scale_m * Shrinking(latitude_e7, origin.latitude_e7));
  return {static_cast<std::int32_t>(std::lround(latitude_e7)),
          static_cast<std::int32_t>(std::lround(longitude_e7)), origin.altitude_m + in_world.z()};
}

std::optional<GlobalPosition> ParseGlobalPosition(std::string_view text) {
  constexpr double kPerDegree = 1e7;
  const std::size_t comma = text.find(',');
  if (comma == std::string_view::npos) return std::nullopt;
  const auto latitude = ParseNumber<double>(text.substr(0, comma));
  const auto longitude = ParseNumber<double>(text.substr(comma + 1));
  if (!latitude || !longitude || !(std::abs(*latitude) <= 90) || !(std::abs(*longitude) <= 180)) {
    return std::nullopt;
  }
  if (*latitude == 0 && *longitude == 0) return std::nullopt;  // autopilots refuse it
  return GlobalPosition{static_cast<std::int32_t>(std::lround(kPerDegree * *latitude)),
                        static_cast<std::int32_t>(std::lround(kPerDegree * *longitude)), 0};
}

}  // namespace kestrel
