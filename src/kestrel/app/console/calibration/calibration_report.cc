// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/console/calibration/calibration_report.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include <fmt/format.h>

#include "kestrel/core/base/error.h"
#include "kestrel/core/geometry/angles.h"
#include "kestrel/io/recording/euroc/euroc_text.h"

namespace kestrel {
namespace {

constexpr double kNotKnown = std::numeric_limits<double>::quiet_NaN();
// Limit of the points in a drawing, so that a slow browser can receive the message.
constexpr std::size_t kMaxPoints = 2000;

// Keeps an even sample of at most kMaxPoints values.
template <class T>
void Thin(std::vector<T>* values) {
  const std::size_t stride = (values->size() + kMaxPoints - 1) / kMaxPoints;
  if (stride <= 1) return;
  std::size_t kept = 0;
  for (std::size_t i = 0; i < values->size(); i += stride) (*values)[kept++] = (*values)[i];
  values->resize(kept);
}

// Number of cells of LensCoverage's grid over the image that contain points.
std::size_t CoveredFields(const std::vector<cv::Point2f>& points, const cv::Size& image) {
  std::set<int> fields;
  for (const cv::Point2f& point : points) {
    if (!cv::Rect2f(0, 0, image.width, image.height).contains(point)) continue;
    const int column = static_cast<int>(point.x * LensCoverage::kColumns / image.width);
    const int row = static_cast<int>(point.y * LensCoverage::kRows / image.height);
    fields.insert(row * LensCoverage::kColumns + column);
  }
  return fields.size();
}

// Fits the poses of the views to the same edges with the given lens held fixed; nothing when that
// fit is not possible.
std::optional<LensFit> FitGiven(const LensCalibration& lens, const CameraIntrinsics& given) {
  const CameraIntrinsics& found = lens.intrinsics;
  constexpr std::size_t kMostCoefficients = kLensParameters - kDistortion;
  if (given.distortion.size() > kMostCoefficients) return std::nullopt;
  if (given.width_px != found.width_px || given.height_px != found.height_px) return std::nullopt;
  const LensFreedom none{.focal = false, .aspect = false, .principal = false, .distortion = 0};
  return FitLens(lens.views, given, none, std::max(RobustSigma(lens.fit.residuals_px), 1e-3));
}

double AngleDeg(const CameraModel& camera, const Eigen::Vector2d& pixel) {
  Eigen::Vector3d ray;
  if (camera.Unproject(pixel, &ray) == ProjectionStatus::kOutsideModel) return kNotKnown;
  return Degrees(std::atan2(ray.head<2>().norm(), ray.z()));
}

CalibrationResiduals LensResiduals(const LensCalibration& lens, const CameraIntrinsics& given) {
  const std::optional<LensFit> before = FitGiven(lens, given);
  CalibrationResiduals residuals{.of = "edges of the pattern",
                                 .unit = "px",
                                 .over = "angle to the optical axis, degrees",
                                 .rms_before = before ? before->RootMeanSquare() : kNotKnown,
                                 .rms_after = lens.fit.RootMeanSquare(),
                                 .points = {}};
  const CameraModel camera(lens.intrinsics);
  for (std::size_t i = 0; i < lens.views.size(); ++i) {
    for (std::size_t k = 0; k < lens.views[i].edges.size(); ++k) {
      residuals.points.push_back({AngleDeg(camera, lens.views[i].edges[k].pixel),
                                  before ? std::abs(before->residuals_px[i][k]) : kNotKnown,
                                  std::abs(lens.fit.residuals_px[i][k])});
    }
  }
  Thin(&residuals.points);
  return residuals;
}

std::vector<CalibrationNumber> LensNumbers(const LensCalibration& lens,
                                           const CameraIntrinsics& given) {
  const CameraIntrinsics& found = lens.intrinsics;
  const auto& sigmas = lens.fit.sigmas;
  std::vector<CalibrationNumber> numbers = {
      {"focal length, across", "px", given.fx_px, found.fx_px, sigmas(kFocal)},
      {"focal length, down over across", "", given.fy_px / given.fx_px, found.fy_px / found.fx_px,
       sigmas(kAspect)},
      {"principal point, x", "px", given.cx_px, found.cx_px, sigmas(kPrincipalX)},
      {"principal point, y", "px", given.cy_px, found.cy_px, sigmas(kPrincipalY)}};
  const bool is_same_kind = given.distortion_model == found.distortion_model;
  for (std::size_t i = 0; i < found.distortion.size(); ++i) {
    const bool is_given = is_same_kind && i < given.distortion.size();
    numbers.push_back({fmt::format("{} {}", DistortionName(found.distortion_model), i + 1), "",
                       is_given ? given.distortion[i] : kNotKnown, found.distortion[i],
                       sigmas(static_cast<Eigen::Index>(kDistortion + i))});
  }
  return numbers;
}

}  // namespace

std::string CalibrationRequest::Name() const {
  if (lens) return "lens";
  if (mount && clock) return "mount_clock";
  return mount ? "mount" : "clock";
}

CalibrationRequest ParseCalibrationRequest(const std::vector<std::string>& words) {
  CalibrationRequest request;
  for (const std::string& word : words) {
    bool* const flag = word == "mount"    ? &request.mount
                       : word == "clock"  ? &request.clock
                       : word == "moving" ? &request.moving
                       : word == "lens"   ? &request.lens
                                          : nullptr;
    if (flag == nullptr || *flag) {
      throw InputError(
          "no calibration of this name: expected lens, or mount and clock, with or without moving");
    }
    *flag = true;
  }
  const bool is_flight = request.mount || request.clock;
  if (is_flight == request.lens || (request.moving && !is_flight)) {
    throw InputError("expected the lens, or mount and clock from a flight");
  }
  return request;
}

ConsoleCalibration FlightCoverage(const std::vector<PatternPlace>& places, std::size_t images,
                                  const cv::Size& image) {
  ConsoleCalibration report;
  report.image = image;
  report.distance_name = "height above the pattern";
  for (const PatternPlace& place : places) {
    report.places.push_back(place.pixel);
    report.distances_m.push_back(place.height_m);
  }
  report.coverage = fmt::format("the pattern was found in {} of {} images", places.size(), images);
  if (!places.empty()) {
    const auto [low, high] =
        std::minmax_element(report.distances_m.begin(), report.distances_m.end());
    report.coverage += fmt::format(
        ", its centre in {} of {} fields of the image, from {:.1f} to "
        "{:.1f} m above it",
        CoveredFields(report.places, image), LensCoverage::kColumns * LensCoverage::kRows, *low,
        *high);
  }
  Thin(&report.places);
  Thin(&report.distances_m);
  return report;
}

void AddFlight(const FlightCalibration& result, const FlightCalibrationOptions& options,
               const MountAndClock& given, ConsoleCalibration* report) {
  if (options.estimate_mount) {
    constexpr std::array<const char*, 3> kNames = {"mount turned by roll", "mount turned by pitch",
                                                   "mount turned by yaw"};
    for (int i = 0; i < 3; ++i) {
      report->numbers.push_back(
          {kNames[i], "degrees", 0, Degrees(result.angles(i)), Degrees(result.angle_sigmas(i))});
    }
  }
  if (options.estimate_clock) {
    report->numbers.push_back({"clock offset", "s", given.clock_offset_s,
                               result.estimate.clock_offset_s, result.clock_sigma_s});
  }
  report->coverage += fmt::format("; {} used, {} left out", result.sightings, result.outliers);
  report->residuals = {.of = "positions in the world",
                       .unit = "m",
                       .over = "time, s",
                       .rms_before = result.rms_before_m,
                       .rms_after = result.rms_after_m,
                       .points = {}};
  for (const SightingResidual& residual : result.residuals) {
    report->residuals.points.push_back({ToSeconds(residual.time - result.residuals.front().time),
                                        residual.before_m, residual.after_m});
  }
  Thin(&report->residuals.points);
  report->warnings = result.warnings;
  report->no_use = WhyOfNoUse(result);
}

ConsoleCalibration LensReport(const LensCalibration& lens, const CameraIntrinsics& given,
                              std::size_t images) {
  ConsoleCalibration report;
  report.image = {lens.intrinsics.width_px, lens.intrinsics.height_px};
  report.distance_name = "distance from the pattern";
  for (const LensView& view : lens.views) {
    for (const LensEdge& edge : view.edges) {
      report.places.emplace_back(edge.pixel.x(), edge.pixel.y());
    }
  }
  for (const RigidTransform& pose : lens.fit.camera_from_target) {
    report.distances_m.push_back(pose.translation.norm());
  }
  Thin(&report.places);
  Thin(&report.distances_m);
  report.coverage =
      fmt::format("pattern found in {} of {} images, {} views used ({} left out); {}", lens.found,
                  images, lens.views.size(), lens.outliers, lens.coverage.InWords());
  report.numbers = LensNumbers(lens, given);
  report.residuals = LensResiduals(lens, given);
  report.warnings = lens.warnings;
  return report;
}

}  // namespace kestrel
