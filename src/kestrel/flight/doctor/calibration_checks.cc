// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/doctor/calibration_checks.h"

#include <algorithm>
#include <cmath>
#include <string>

#include <fmt/format.h>

#include "kestrel/core/geometry/angles.h"
#include "kestrel/flight/doctor/statistics.h"

namespace kestrel {
namespace {

constexpr char kCalibrateAdvice[] =
    "a dozen views of the pattern, then kestrel calibrate lens FOLDER --output DIR";

// Number of pixels along the image's border for which the lens model has a ray.
struct BorderReach {
  int pixels = 0;
  int reached = 0;
};

BorderReach ReachOf(const CameraModel& model) {
  constexpr int kSteps = 64;
  BorderReach reach;
  const double right = model.width_px() - 1;
  const double bottom = model.height_px() - 1;
  const auto look = [&](double x, double y) {
    Eigen::Vector3d ray;
    ++reach.pixels;
    if (model.Unproject({x, y}, &ray) == ProjectionStatus::kOk) ++reach.reached;
  };
  for (int i = 0; i < kSteps; ++i) {
    const double part = static_cast<double>(i) / kSteps;
    look(part * right, 0);
    look(right, part * bottom);
    look(right - part * right, bottom);
    look(0, bottom - part * bottom);
  }
  return reach;
}

// Returns the angle between the rays through the middles of the left and right border, rad; nothing
// where the model has no ray for one of them.
std::optional<double> AngleOfView(const CameraModel& model) {
  Eigen::Vector3d left;
  Eigen::Vector3d right;
  const double y = 0.5 * (model.height_px() - 1);
  if (model.Unproject({0, y}, &left) != ProjectionStatus::kOk) return std::nullopt;
  if (model.Unproject({model.width_px() - 1.0, y}, &right) != ProjectionStatus::kOk) {
    return std::nullopt;
  }
  return std::acos(std::clamp(left.dot(right), -1.0, 1.0));
}

}  // namespace

Finding CheckImageSize(const CameraIntrinsics& intrinsics, const CameraObservations& camera) {
  const std::string check = "image size";
  if (camera.has_other_size) {
    return Wrong(check, camera.open_error,
                 "the calibration of this camera at this size (--camera), or ask the camera for "
                 "the calibration's size (fly.camera.device_caps)");
  }
  if (camera.width_px == 0) return NotChecked(check, "no image");
  const std::string measured =
      fmt::format("{}x{} px, calibration {}x{} px", camera.width_px, camera.height_px,
                  intrinsics.width_px, intrinsics.height_px);
  if (camera.width_px == intrinsics.width_px && camera.height_px == intrinsics.height_px) {
    return Good(check, measured);
  }
  const bool is_swapped =
      camera.width_px == intrinsics.height_px && camera.height_px == intrinsics.width_px;
  return Wrong(check, measured,
               is_swapped ? "width and height are swapped: in the calibration file, or the camera "
                            "turns its images by 90 deg"
                          : "calibrate at this size: a calibration does not hold for another one");
}

Finding CheckLensModel(const CameraIntrinsics& intrinsics) {
  constexpr double kCorners =
      0.6;  // share of the border; the rest may be the black corners around a fisheye's circle
  const std::string check = "lens model";
  if (const auto violations = intrinsics.Validate(); !violations.empty()) {
    return Wrong(check, violations.front(), kCalibrateAdvice);
  }
  const CameraModel model(intrinsics);
  const BorderReach reach = ReachOf(model);
  const std::optional<double> view = AngleOfView(model);
  const std::string measured =
      fmt::format("valid to {:.0f} deg from the axis, {:.0f} % of the image's border{}",
                  Degrees(model.max_angle()), 100.0 * reach.reached / reach.pixels,
                  view ? fmt::format(", {:.0f} deg wide", Degrees(*view)) : "");
  if (reach.reached == reach.pixels) return Good(check, measured);
  const std::string advice =
      "the distortion bends back before the rim: calibrate with views at the border and in the "
      "corners, or with the model equidistant for a wide lens";
  if (reach.reached < kCorners * reach.pixels) return Wrong(check, measured, advice);
  return Doubtful(check, measured, advice);
}

Finding CheckPixelShape(const CameraIntrinsics& intrinsics) {
  constexpr double kAspect = 0.03;
  constexpr double kOffAxis = 0.15;  // largest offset from the middle, share of the image's size
  const std::string check = "principal point, pixels";
  const double aspect = intrinsics.fx_px / intrinsics.fy_px;
  const double off_x = intrinsics.cx_px / (intrinsics.width_px - 1) - 0.5;
  const double off_y = intrinsics.cy_px / (intrinsics.height_px - 1) - 0.5;
  const std::string measured =
      fmt::format("({:.0f}, {:.0f}) of {}x{} px, fx/fy {:.3f}", intrinsics.cx_px, intrinsics.cy_px,
                  intrinsics.width_px, intrinsics.height_px, aspect);
  const bool is_off = std::abs(off_x) > kOffAxis || std::abs(off_y) > kOffAxis;
  if (!is_off && std::abs(aspect - 1) < kAspect) return Good(check, measured);
  return Doubtful(check, measured,
                  std::string(is_off ? "the optical axis is seldom so far from the middle"
                                     : "pixels are square in nearly all cameras") +
                      ": is it the calibration of this camera, uncropped and unscaled?");
}

Finding CheckCalibrationByPattern(const VisionObservations& vision) {
  constexpr std::size_t kFewest = 5;
  constexpr double kGood_px = 0.6;
  constexpr double kMost_px = 1.5;
  constexpr double kFocalDoubtful = 0.09;
  constexpr double kFocalWrong = 0.13;
  constexpr double kMostContradict = 0.5;
  const std::string check = "calibration by the pattern";
  std::vector<double> misfits;
  std::size_t contradict = 0;
  for (const PatternSample& pattern : vision.patterns) {
    if (pattern.misfit_px > 0) misfits.push_back(pattern.misfit_px);
    if (pattern.contradicts) ++contradict;
  }
  if (misfits.size() < kFewest) {
    return NotChecked(check,
                      fmt::format("pattern in view in {} of {} images, with edges to "
                                  "measure in {}{}{}",
                                  vision.patterns.size(), vision.frames, misfits.size(),
                                  vision.other_tag ? "; " : "",
                                  vision.other_tag ? InWords(*vision.other_tag) : ""),
                      "hold the camera 1 to 4 m above the pattern");
  }
  std::string measured = fmt::format("in {} images misfit ", misfits.size());
  const double misfit_px = MedianOf(std::move(misfits));
  measured += fmt::format("{:.2f} px", misfit_px);
  if (vision.focal) {
    measured += fmt::format(", focal length {:.3f} +- {:.3f} of the file's", vision.focal->factor,
                            vision.focal->sigma);
  }
  // Images from one place share their errors, which the standard deviation does not contain.
  const double focal_off =
      vision.focal_contradiction ? std::abs(std::log(vision.focal_contradiction->factor)) : 0;
  if (focal_off > kFocalWrong) {
    return Wrong(
        check, measured,
        std::string("it is the calibration of another lens, zoom or size: ") + kCalibrateAdvice);
  }
  const auto all = static_cast<double>(vision.patterns.size());
  if (static_cast<double>(contradict) > kMostContradict * all || misfit_px > kMost_px) {
    return Wrong(check,
                 fmt::format("{}; {:.0f} % of the images contradict the calibration", measured,
                             kPercent * static_cast<double>(contradict) / all),
                 std::string("another lens, or another pattern than that of landing.detector."
                             "pattern: ") +
                     kCalibrateAdvice);
  }
  if (misfit_px > kGood_px || focal_off > kFocalDoubtful) {
    return Doubtful(check, measured, kCalibrateAdvice);
  }
  return Good(check, measured);
}

std::vector<Finding> CheckCalibration(const DoctorObservations& observations) {
  const CameraIntrinsics& intrinsics = observations.calibration.intrinsics;
  std::vector<Finding> findings = {CheckImageSize(intrinsics, observations.camera)};
  // Without a source there may be no calibration at all.
  if (intrinsics.width_px == 0) return findings;
  findings.push_back(CheckLensModel(intrinsics));
  findings.push_back(CheckPixelShape(intrinsics));
  findings.push_back(CheckCalibrationByPattern(observations.vision));
  return findings;
}

}  // namespace kestrel
