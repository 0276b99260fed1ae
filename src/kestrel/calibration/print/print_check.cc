// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/calibration/print/print_check.h"

#include <cmath>

#include <fmt/format.h>

#include "kestrel/calibration/print/pattern_print.h"
#include "kestrel/core/base/error.h"

namespace kestrel {
namespace {

// A larger tolerance, relative to the dimension, is not good enough for a verdict.
constexpr double kMaxTolerance = 0.1;
constexpr double kLeastGap_px = 6;  // smallest visible gap between arm and ring

PrintVerdict Judge(const CheckedDimension& dimension) {
  const double difference = std::abs(dimension.measured->value_m - dimension.configured_m);
  if (difference > dimension.tolerance_m()) return PrintVerdict::kWrong;
  return dimension.tolerance_m() > kMaxTolerance * dimension.configured_m ? PrintVerdict::kTooCoarse
                                                                          : PrintVerdict::kGood;
}

CheckedDimension Check(const char* option, double configured_m, const MeasuredLength& measured,
                       const PrintScale& scale) {
  CheckedDimension dimension{
      option, configured_m,
      MeasuredLength{measured.value_m * scale.value,
                     std::hypot(measured.sigma_m * scale.value, measured.value_m * scale.sigma)},
      PrintVerdict::kGood};
  dimension.verdict = Judge(dimension);
  return dimension;
}

CheckedDimension CheckArmsWithoutEnds(const LandingPattern& configured, double pixel_m) {
  const double gap = configured.inner_radius_m() - configured.arm_half_length_m;
  const PrintVerdict verdict = gap <= 0                       ? PrintVerdict::kGood
                               : gap > kLeastGap_px * pixel_m ? PrintVerdict::kWrong
                                                              : PrintVerdict::kTooCoarse;
  return {"arm_half_length_m", configured.arm_half_length_m, std::nullopt, verdict};
}

}  // namespace

const char* ToString(PrintVerdict verdict) {
  switch (verdict) {
    case PrintVerdict::kGood:
      return "good";
    case PrintVerdict::kWrong:
      return "WRONG";
    case PrintVerdict::kTooCoarse:
      return "cannot tell";
  }
  return "";
}

PrintScale ScaleByDistance(double distance_m, const PrintMeasurement& print) {
  constexpr double kTapeSigma = 0.01 / 3;  // relative
  const double scale = distance_m / print.distance.value_m;
  return {scale, scale * std::hypot(kTapeSigma, print.distance.sigma_m / print.distance.value_m)};
}

PrintScale ScaleByRuler(double ruler_m, const LandingPattern& configured) {
  constexpr double kReadingSigma_m = 0.0002;
  const double printed_m = RulerLength(configured.board_size_m);
  return {ruler_m / printed_m, kReadingSigma_m / printed_m};
}

std::vector<CheckedDimension> CheckPrint(const LandingPattern& configured,
                                         const PrintMeasurement& print,
                                         const std::optional<PrintScale>& scale) {
  const PrintScale by = scale.value_or(PrintScale{1, 0});
  std::vector<CheckedDimension> dimensions;
  if (scale) {
    const double diameter = configured.outer_diameter_m;
    dimensions.push_back(Check("outer_diameter_m", diameter, {diameter, 0}, by));
  }
  dimensions.push_back(Check("ring_width_m", configured.ring_width_m, print.ring_width, by));
  dimensions.push_back(Check("arm_width_m", configured.arm_width_m, print.arm_width, by));
  if (print.arm_half_length) {
    dimensions.push_back(
        Check("arm_half_length_m", configured.arm_half_length_m, *print.arm_half_length, by));
  } else {
    dimensions.push_back(CheckArmsWithoutEnds(configured, print.pixel_m));
  }
  return dimensions;
}

std::string DimensionsTable(const std::vector<CheckedDimension>& dimensions) {
  std::string table =
      fmt::format("{:<18} {:>13} {:>13} {:>12}\n", "", "configured", "measured", "tolerance");
  const auto millimetres = [](double length_m) { return fmt::format("{:.1f} mm", 1e3 * length_m); };
  for (const CheckedDimension& dimension : dimensions) {
    const bool is_measured = dimension.measured.has_value();
    table += fmt::format(
        "{:<18} {:>13} {:>13} {:>12}  {}\n", dimension.option, millimetres(dimension.configured_m),
        is_measured ? millimetres(dimension.measured->value_m) : "no end",
        is_measured ? millimetres(dimension.tolerance_m()) : "", ToString(dimension.verdict));
  }
  return table;
}

void RequireAsConfigured(const std::string& photo,
                         const std::vector<CheckedDimension>& dimensions) {
  std::string wrong, settings;
  bool is_coarse = false;
  for (const CheckedDimension& dimension : dimensions) {
    is_coarse = is_coarse || dimension.verdict == PrintVerdict::kTooCoarse;
    if (dimension.verdict != PrintVerdict::kWrong) continue;
    wrong += (wrong.empty() ? "" : ", ") + dimension.option;
    if (!dimension.measured) continue;
    settings += fmt::format(" --set landing.detector.pattern.{}={:.4f}", dimension.option,
                            dimension.measured->value_m);
  }
  if (!wrong.empty()) {
    throw InputError(fmt::format("{}: not as configured: {}; print again at 100 %{}", photo, wrong,
                                 settings.empty() ? "" : ", or say what is there:" + settings));
  }
  if (is_coarse) {
    throw InputError(photo + ": too coarse to tell: photograph the print from nearer");
  }
}

}  // namespace kestrel
