// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/search/pad_search.h"

#include <algorithm>
#include <chrono>
#include <utility>

#include "kestrel/core/geometry/angles.h"
#include "kestrel/core/geometry/mirror_pose.h"
#include "kestrel/vision/target/part_below_horizon.h"

namespace kestrel {
namespace {

constexpr double kSigmas = 3;  // size of the searched area around the expected place
// Largest shift of a pad that is followed, to either side: so many pixels, or steps if that is
// more.
constexpr double kMostShiftPx = 30;
constexpr int kMostShiftSteps = 10;
constexpr double kMirrorCost = 4.5;  // below it the image cannot distinguish two poses: 3 sigma
constexpr double kMisfitBoundPx = 1;

}  // namespace

PadSearch::PadSearch(const PadSearchModels& models, const cv::Mat& image, const TargetHint& hint,
                     PadSearchBuffers* buffers)
    : models_(models),
      image_(image),
      hint_(hint),
      buffers_(*buffers),
      prior_{hint.up_in_camera, Radians(models.level_sigma_deg)} {}

TargetReport PadSearch::Run() {
  if (image_.type() != CV_8UC1 || image_.cols != models_.camera.width_px() ||
      image_.rows != models_.camera.height_px()) {
    report_.reason = "the image is not CV_8UC1 of the camera's size";
    return report_;
  }
  report_.reason = "the image has no contrast";
  if (hint_.center_in_camera && hint_.rotation_in_camera) {
    const SearchLog::Timer timer = log_.Time(LandingStage::kMatch);
    Follow({*hint_.rotation_in_camera, *hint_.center_in_camera});
  }
  if (!is_found()) Search();
  if (is_found()) {
    report_.reached = LandingStage::kFound;
    report_.reason = {};
  }
  return report_;
}

void PadSearch::Search() {
  using Clock = std::chrono::steady_clock;
  const cv::Rect part = SearchedPart();
  {
    const SearchLog::Timer timer = log_.Time(LandingStage::kBinarize);
    Begin(part);
  }
  const Clock::time_point start = Clock::now();
  const std::chrono::duration<double, std::milli> limit(hint_.max_search_ms);
  const int first = std::max(0, hint_.first_step) % Steps();
  for (int step = first; step < Steps() && !is_found(); ++step) {
    if (limit.count() > 0 && step > first && Clock::now() - start > limit) {
      report_.diagnostics.next_step = step;
      return;
    }
    if (MayHaveSize(step % PlaneBorders::kPasses)) SearchStep(part, step);
  }
}

bool PadSearch::MayHaveSize(int pass) const {
  if (!hint_.center_in_camera) return true;
  const double distance = hint_.center_in_camera->norm();
  return MayHaveSize(pass, distance, std::min(0.5, kSigmas * hint_.center_sigma_m / distance));
}

cv::Rect PadSearch::SearchedPart() const {
  const cv::Rect whole(0, 0, image_.cols, image_.rows);
  std::optional<cv::Rect> ground;
  if (hint_.up_in_camera && hint_.sky_above_rad) {
    ground = PartBelowHorizon(models_.camera, *hint_.up_in_camera, *hint_.sky_above_rad);
  }
  const cv::Rect all = ground.value_or(whole);
  Eigen::Vector2d center;
  if (!hint_.center_in_camera ||
      models_.camera.Project(*hint_.center_in_camera, &center) == ProjectionStatus::kOutsideModel) {
    return all;
  }
  const double reach = models_.radius_m + kSigmas * hint_.center_sigma_m;
  const double radius_px = models_.part_factor * models_.camera.intrinsics().fx_px * reach /
                               std::max(0.1, hint_.center_in_camera->norm()) +
                           models_.part_margin_px;
  const double most = image_.cols + image_.rows;
  if (!(radius_px < most)) return all;
  const cv::Rect part =
      whole & cv::Rect(static_cast<int>(center.x() - radius_px),
                       static_cast<int>(center.y() - radius_px), static_cast<int>(2 * radius_px),
                       static_cast<int>(2 * radius_px));
  return part.empty() ? all : part;
}

void PadSearch::ExamineBorders(std::size_t count, std::string_view reason) {
  report_.diagnostics.candidates[static_cast<std::size_t>(LandingStage::kAreas)] +=
      static_cast<std::int32_t>(count);
  if (count == 0 || report_.reached >= LandingStage::kAreas) return;
  report_.reached = LandingStage::kAreas;
  report_.reason = reason;
}

PadSearch::ShiftGrid PadSearch::GridOf(const RigidTransform& expected, double step_px) const {
  const double sigma_px =
      hint_.center_sigma_m * models_.camera.intrinsics().fx_px / expected.translation.norm();
  const double most = std::max(kMostShiftPx, kMostShiftSteps * step_px);
  const double radius = std::min(most, kSigmas * sigma_px);
  const double step = std::max(step_px, radius / kMostShiftSteps);
  return {step, static_cast<int>(std::ceil(radius / step))};
}

// The sample nearest to the image's middle carries the shift into space.
std::optional<RigidTransform> PadSearch::Shifted(const RigidTransform& expected,
                                                 std::span<const Eigen::Vector2d> places,
                                                 const Eigen::Vector2d& shift_px) const {
  const PadSamples& samples = buffers_.samples;
  const Eigen::Vector2d middle(0.5 * image_.cols, 0.5 * image_.rows);
  double nearest = 1e18;
  std::size_t carrier = 0;
  for (std::size_t i = 0; i < samples.count(); ++i) {
    const double away = (Eigen::Vector2d(samples.u(i), samples.v(i)) - middle).squaredNorm();
    if (!(away < nearest)) continue;
    nearest = away;
    carrier = i;
  }
  const Eigen::Vector2d pixel(samples.u(carrier), samples.v(carrier));
  Eigen::Vector3d from, to;
  const auto sees = [this](const Eigen::Vector2d& place, Eigen::Vector3d* ray) {
    return models_.camera.Unproject(place, ray) != ProjectionStatus::kOutsideModel;
  };
  if (!sees(pixel, &from) || !sees(pixel + shift_px, &to)) return std::nullopt;
  const Eigen::Vector2d& place = places[carrier];
  const double range = (expected * Eigen::Vector3d(place.x(), place.y(), 0)).norm();
  return RigidTransform{expected.rotation, expected.translation + range * (to - from)};
}

std::optional<AlignedPad> PadSearch::Align(const RigidTransform& start, const PadPart* only) {
  return models_.alignment.Align(image_, start, prior_, only, &buffers_.alignment);
}

std::optional<RigidTransform> PadSearch::ResolveMirror(AlignedPad* best) {
  std::optional<AlignedPad> other = Align(MirrorPose(best->camera_from_pad));
  if (!other) return std::nullopt;
  const double apart =
      best->camera_from_pad.rotation.angularDistance(other->camera_from_pad.rotation);
  constexpr double kApart = Radians(0.5);  // else both starts led to the same pose
  if (apart < kApart) return std::nullopt;
  const double cost = CostAbove(*best, *other);
  if (cost < 0) std::swap(*best, *other);
  if (std::abs(cost) >= kMirrorCost) return std::nullopt;
  return other->camera_from_pad;
}

double PadSearch::Slant(const RigidTransform& pose) {
  const Eigen::Vector3d face = pose.rotation * Eigen::Vector3d::UnitZ();
  return std::abs(face.dot(pose.translation)) / pose.translation.norm();
}

TargetDetection PadSearch::DetectionOf(const AlignedPad& aligned, double quality,
                                       DetectionMethod method) const {
  TargetDetection detection{};
  detection.camera_from_target = aligned.camera_from_pad;
  if (models_.camera.Project(aligned.camera_from_pad.translation, &detection.center_px) ==
      ProjectionStatus::kOutsideModel) {
    detection.center_px.setConstant(NAN);
  }
  detection.covariance = aligned.covariance;
  detection.method = method;
  detection.quality = quality;
  detection.diagnostics.misfit_px = aligned.rms_px;
  detection.diagnostics.misfit_bound_px = kMisfitBoundPx;
  return detection;
}

}  // namespace kestrel
