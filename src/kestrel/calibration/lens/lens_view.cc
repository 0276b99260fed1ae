// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/calibration/lens/lens_view.h"

#include <algorithm>
#include <cmath>

#include "kestrel/vision/landing/alignment/print_alignment.h"
#include "kestrel/vision/landing/alignment/print_outline.h"
#include "kestrel/vision/target/plane_warp.h"

namespace kestrel {
namespace {

constexpr double kMinRingPx = 40;     // diameter: an arm of a tenth of it has two edges
constexpr double kReachShare = 0.03;  // search range for edges, of the ring's diameter
constexpr double kLeastReachPx = 3;
constexpr double kMinStep = 4;         // least step of an edge, gray values per pixel
constexpr double kInPlacePx = 1;       // largest offset of an edge from its place by its neighbours
constexpr std::size_t kMinEdges = 40;  // out of 150

// Corrects a wrong camera by the evidence of the detection.
CameraIntrinsics Recalibrated(CameraIntrinsics camera, const CalibrationEvidence& evidence) {
  if (!evidence.contradicts) return camera;
  const double zoom = std::exp(evidence.log_focal);
  camera.fx_px *= zoom;
  camera.fy_px *= zoom;
  camera.cx_px += evidence.principal_px.x();
  camera.cy_px += evidence.principal_px.y();
  return camera;
}

}  // namespace

LensViewFinder::LensViewFinder(const CameraIntrinsics& camera,
                               const LandingPatternDetectorOptions& options)
    : detector_(CameraModel(camera), options),
      outline_(std::make_unique<const PrintOutline>(options.pattern)) {}
LensViewFinder::~LensViewFinder() = default;
LensViewFinder::LensViewFinder(LensViewFinder&&) noexcept = default;
LensViewFinder& LensViewFinder::operator=(LensViewFinder&&) noexcept = default;

std::optional<LensView> LensViewFinder::Find(const std::string& name, const cv::Mat& image) {
  const TargetReport report = detector_.Detect(image, {}, workspace_);
  if (!report.detection || 2 * report.detection->semi_major_px < kMinRingPx) {
    return std::nullopt;
  }
  const TargetDetection& seen = *report.detection;
  const CameraModel camera(
      Recalibrated(detector_.camera().intrinsics(), seen.diagnostics.calibration));
  PrintAlignment alignment{PlaneWarp(camera, seen.camera_from_target, outline_->radius_m()), {}};
  const double reach_px = std::max(kLeastReachPx, kReachShare * 2 * seen.semi_major_px);
  if (!AlignPrint(image, image, {}, outline_->all(), reach_px, kMinStep, &alignment)) {
    return std::nullopt;
  }
  LensView view{name, {}, seen.camera_from_target};
  for (const PrintEdge& edge : alignment.edges.all()) {
    if (std::abs(alignment.edges.ResidualOf(edge)) > kInPlacePx) continue;
    view.edges.push_back({edge.place->point, edge.pixel(), edge.across});
  }
  if (view.edges.size() < kMinEdges) return std::nullopt;
  return view;
}

}  // namespace kestrel
