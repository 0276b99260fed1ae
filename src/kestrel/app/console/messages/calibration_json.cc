// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/console/messages/calibration_json.h"

#include <cmath>
#include <vector>

#include <nlohmann/json.hpp>

namespace kestrel {
namespace {

using Json = nlohmann::json;

// Rounds to four digits: the drawing is no finer, and the text is a third as long.
double Short(double value) {
  if (value == 0 || !std::isfinite(value)) return value;
  const double scale = std::pow(10, 3 - std::floor(std::log10(std::abs(value))));
  return std::round(value * scale) / scale;
}

Json PlacesJson(const std::vector<cv::Point2f>& places) {
  Json list = Json::array();
  for (const cv::Point2f& place : places) {
    list.push_back(std::lround(place.x));
    list.push_back(std::lround(place.y));
  }
  return list;
}

Json DistancesJson(const std::vector<double>& distances_m) {
  Json list = Json::array();
  for (const double distance : distances_m) list.push_back(Short(distance));
  return list;
}

Json NumbersJson(const std::vector<CalibrationNumber>& numbers) {
  Json list = Json::array();
  for (const CalibrationNumber& number : numbers) {
    list.push_back({{"name", number.name},
                    {"unit", number.unit},
                    {"before", number.before},
                    {"after", number.after},
                    {"sigma", number.sigma}});
  }
  return list;
}

Json ResidualsJson(const CalibrationResiduals& residuals) {
  Json points = Json::array();
  for (const auto& [over, before, after] : residuals.points) {
    points.push_back({Short(over), Short(before), Short(after)});
  }
  return {{"of", residuals.of},
          {"unit", residuals.unit},
          {"over", residuals.over},
          {"rms_before", residuals.rms_before},
          {"rms_after", residuals.rms_after},
          {"points", std::move(points)}};
}

}  // namespace

Json CalibrationJson(const ConsoleCalibration& calibration) {
  static constexpr const char* kStates[] = {"none", "running", "done", "cancelled", "refused"};
  return {{"kind", "calibration"},
          {"state", kStates[static_cast<int>(calibration.state)]},
          {"number", calibration.number},
          {"asked", calibration.requested},
          {"done", calibration.done},
          {"of", calibration.of},
          {"ending", calibration.is_ending},
          {"error", calibration.error},
          {"width", calibration.image.width},
          {"height", calibration.image.height},
          {"places", PlacesJson(calibration.places)},
          {"distance_name", calibration.distance_name},
          {"distances_m", DistancesJson(calibration.distances_m)},
          {"coverage", calibration.coverage},
          {"numbers", NumbersJson(calibration.numbers)},
          {"residuals", ResidualsJson(calibration.residuals)},
          {"warnings", calibration.warnings},
          {"can_save", calibration.can_save},
          {"no_use", calibration.no_use},
          {"saved", calibration.saved},
          {"save_error", calibration.save_error}};
}

}  // namespace kestrel
