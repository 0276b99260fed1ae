// SPDX-License-Identifier: BSD-3-Clause
#include "landing_score.h"

#include <algorithm>
#include <cmath>
#include <mutex>
#include <numbers>
#include <numeric>

#include <Eigen/Cholesky>
#include <fmt/format.h>

#include "for_each_index.h"
#include "kestrel/core/base/robust_statistics.h"

namespace kestrel {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

// Distance of a point from an ellipse along the line to its centre.
double DistanceToEllipse(const Ellipse& ellipse, const Vector2d& point) {
  const Vector2d offset = point - ellipse.center;
  const double scale = std::hypot(offset.dot(ellipse.major_axis()) / ellipse.semi_major,
                                  offset.dot(ellipse.minor_axis()) / ellipse.semi_minor);
  return std::abs(offset.norm() - offset.norm() / std::max(scale, 1e-9));
}

bool RingAgrees(const LandingFrame& frame, const TargetDetection& detection,
                const CameraModel& camera, const LandingPattern& pattern) {
  constexpr int kPoints = 128;
  constexpr int kMinPointsInImage = 16;
  double sum_squares = 0;
  int in_image = 0;
  for (int i = 0; i < kPoints; ++i) {
    const double angle = 2 * std::numbers::pi * i / kPoints;
    const Vector3d point = pattern.outer_radius_m() * Vector3d(std::cos(angle), std::sin(angle), 0);
    Vector2d pixel;
    if (camera.Project(detection.camera_from_target * point, &pixel) != ProjectionStatus::kOk) {
      continue;
    }
    const double distance = DistanceToEllipse(*frame.outer, pixel);
    sum_squares += distance * distance;
    ++in_image;
  }
  return in_image >= kMinPointsInImage &&
         std::sqrt(sum_squares / in_image) <= std::max(2.0, 0.05 * frame.ring_radius_px);
}

bool IsRight(const LandingFrame& frame, const TargetDetection& detection, const CameraModel& camera,
             const LandingPattern& pattern) {
  if (frame.truth == PatternTruth::kPartial) return RingAgrees(frame, detection, camera, pattern);
  return (detection.center_px - frame.center_px).norm() <=
         std::max(4.0, 0.15 * frame.ring_radius_px);
}

LandingOutcome OutcomeOf(const LandingFrame& frame, const TargetReport& report,
                         const CameraModel& camera, const LandingPattern& pattern) {
  if (frame.truth == PatternTruth::kNone) {
    return report.detection ? LandingOutcome::kWrong : LandingOutcome::kQuiet;
  }
  if (!report.detection) return LandingOutcome::kMissed;
  return IsRight(frame, *report.detection, camera, pattern) ? LandingOutcome::kFound
                                                            : LandingOutcome::kWrong;
}

void MeasureErrors(const LandingFrame& frame, const TargetDetection& detection,
                   LandingScore* score) {
  score->center_error_px = (detection.center_px - frame.center_px).norm();
  if (!frame.camera_from_target) return;
  const Vector3d& truth = frame.camera_from_target->translation;
  const Vector3d error = detection.camera_from_target.translation - truth;
  score->position_error = error.norm() / truth.norm();
  const Eigen::Matrix3d covariance = detection.covariance.topLeftCorner<3, 3>();
  score->nees = error.dot(covariance.ldlt().solve(error));
  if (!detection.diagnostics.mirror_camera_from_target) return;
  const auto tilt_error = [&](const RigidTransform& pose) {
    const Vector3d z = Vector3d::UnitZ();
    return (pose.rotation * z - frame.camera_from_target->rotation * z).norm();
  };
  score->has_mirror = true;
  score->is_mirrored = tilt_error(*detection.diagnostics.mirror_camera_from_target) <
                       tilt_error(detection.camera_from_target);
}

}  // namespace

LandingScore ScoreLanding(const LandingFrame& frame, const TargetReport& report,
                          const CameraModel& camera, const LandingPattern& pattern) {
  LandingScore score;
  score.name = frame.name;
  score.group = frame.group;
  score.truth = frame.truth;
  score.ring_radius_px = frame.ring_radius_px;
  score.altitude_m = frame.altitude_m;
  score.outcome = OutcomeOf(frame, report, camera, pattern);
  score.reached = report.reached;
  score.reason = report.reason;
  if (report.detection) {
    score.detected_px = report.detection->center_px;
    score.quality = report.detection->quality;
  }
  if (score.outcome == LandingOutcome::kFound) MeasureErrors(frame, *report.detection, &score);
  return score;
}

TargetHint NoHint(const LandingFrame& /*frame*/) { return {}; }

TargetHint AttitudeHint(const LandingFrame& frame) {
  TargetHint hint;
  hint.up_in_camera = frame.up_in_camera;
  return hint;
}

std::vector<LandingScore> ScoreFrames(
    const LandingPatternDetector& detector, std::size_t count, int threads, HintOf hint,
    const std::function<LandingFrame(std::size_t)>& make_frame,
    const std::function<void(const LandingFrame&, const LandingScore&)>& sees) {
  std::vector<LandingScore> scores(count);
  std::mutex seeing;
  ForEachIndex(count, threads, [&](std::size_t i) {
    thread_local LandingWorkspace workspace;
    const LandingFrame frame = make_frame(i);
    const TargetReport report = detector.Detect(frame.image, hint(frame), workspace);
    scores[i] = ScoreLanding(frame, report, detector.camera(), detector.options().pattern);
    if (!sees) return;
    const std::lock_guard lock(seeing);
    sees(frame, scores[i]);
  });
  return scores;
}

std::string AltitudeBin::Name() const { return fmt::format("{} to {} m", min_m, max_m); }

LandingTally::LandingTally(std::span<const LandingScore> scores) {
  for (const LandingScore& score : scores) Add(score);
}

void LandingTally::Add(const LandingScore& score) {
  const bool is_found = score.outcome == LandingOutcome::kFound;
  const bool is_wrong = score.outcome == LandingOutcome::kWrong;
  switch (score.truth) {
    case PatternTruth::kNone:
      ++negatives;
      false_detections += is_wrong;
      return;
    case PatternTruth::kPartial:
      ++partial;
      partial_found += is_found || is_wrong;
      partial_right += is_found;
      return;
    case PatternTruth::kUnknown:
      return;
    case PatternTruth::kWhole:
      break;
  }
  ++frames;
  found += is_found;
  wrong += is_wrong;
  if (!is_found) return;
  center_errors_px.push_back(score.center_error_px);
  if (score.altitude_m == 0) return;
  position_errors.push_back(score.position_error);
  nees.push_back(score.nees);
  with_mirror += score.has_mirror;
  mirrored += score.is_mirrored;
}

void LandingTally::Add(const LandingTally& tally) {
  frames += tally.frames;
  found += tally.found;
  wrong += tally.wrong;
  partial += tally.partial;
  partial_found += tally.partial_found;
  partial_right += tally.partial_right;
  negatives += tally.negatives;
  false_detections += tally.false_detections;
  with_mirror += tally.with_mirror;
  mirrored += tally.mirrored;
  const auto append = [](const std::vector<double>& from, std::vector<double>* to) {
    to->insert(to->end(), from.begin(), from.end());
  };
  append(tally.center_errors_px, &center_errors_px);
  append(tally.position_errors, &position_errors);
  append(tally.nees, &nees);
}

double Quantile(std::vector<double> values, double p) {
  if (values.empty()) return 0;
  return QuantileInPlace(values, p, QuantileRank::kNearest);
}

double Mean(std::span<const double> values) {
  if (values.empty()) return 0;
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

}  // namespace kestrel
