// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/core/camera/zoom_lens.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "kestrel/core/base/error.h"
#include "kestrel/core/camera/calibration.h"
#include "kestrel/core/geometry/angles.h"

namespace kestrel {
namespace {

constexpr double kTolerance = 0.05;  // of the view, beyond the table

// Focal length over half of the width, by the field of view.
double FocalOf(DistortionModel model, double view_rad) {
  return model == DistortionModel::kEquidistant ? 2 / view_rad : 1 / std::tan(view_rad / 2);
}

CameraIntrinsics Scaled(CameraIntrinsics lens, double factor) {
  lens.fx_px *= factor;
  lens.fy_px *= factor;
  return lens;
}

// 'part': 0 gives a, 1 gives b.
CameraIntrinsics Between(const CameraIntrinsics& a, const CameraIntrinsics& b, double part) {
  CameraIntrinsics lens = a;
  lens.fx_px = a.fx_px * std::pow(b.fx_px / a.fx_px, part);
  lens.fy_px = a.fy_px * std::pow(b.fy_px / a.fy_px, part);
  lens.cx_px = std::lerp(a.cx_px, b.cx_px, part);
  lens.cy_px = std::lerp(a.cy_px, b.cy_px, part);
  for (std::size_t i = 0; i < lens.distortion.size(); ++i) {
    lens.distortion[i] = std::lerp(a.distortion[i], b.distortion[i], part);
  }
  return lens;
}

// A report may be of another unit than degrees.
std::optional<CameraIntrinsics> IfValid(const CameraIntrinsics& lens) {
  return lens.Validate().empty() ? std::optional(lens) : std::nullopt;
}

}  // namespace

void RequireFixedLens(const CameraCalibration& camera, const std::string& task) {
  if (!camera.zoom) return;
  throw InputError(
      task +
      " needs a lens that is fixed, and the camera's file has a zoom: leave out 'zoom' "
      "and keep it at the setting of the file's own lens");
}

double ViewOf(const CameraIntrinsics& lens) {
  const double half = 0.5 * lens.width_px / lens.fx_px;
  return 2 * (lens.distortion_model == DistortionModel::kEquidistant ? half : std::atan(half));
}

std::optional<CameraIntrinsics> LensAt(const ZoomLens& zoom, double view_rad) {
  const auto& settings = zoom.settings;
  const DistortionModel model = settings.front().lens.distortion_model;
  if (!(view_rad > 0) || (model != DistortionModel::kEquidistant && view_rad >= kPi)) {
    return std::nullopt;
  }
  const double focal = FocalOf(model, view_rad);
  if (settings.size() == 1) {
    return IfValid(
        Scaled(settings.front().lens, focal / FocalOf(model, settings.front().view_rad)));
  }
  if (view_rad < (1 - kTolerance) * settings.front().view_rad ||
      view_rad > (1 + kTolerance) * settings.back().view_rad) {
    return std::nullopt;
  }
  const auto next = std::find_if(settings.begin() + 1, settings.end() - 1,
                                 [&](const auto& setting) { return setting.view_rad >= view_rad; });
  const auto before = next - 1;
  const double from = FocalOf(model, before->view_rad);
  const double part = std::log(focal / from) / std::log(FocalOf(model, next->view_rad) / from);
  return IfValid(Between(before->lens, next->lens, std::clamp(part, 0.0, 1.0)));
}

}  // namespace kestrel
