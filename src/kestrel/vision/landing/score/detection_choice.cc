// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/landing/score/detection_choice.h"

#include <cmath>
#include <limits>

#include <Eigen/Geometry>

#include "kestrel/vision/landing/alignment/print_outline.h"

namespace kestrel {
namespace {

// Largest standard deviation of the position of a partial print that ends the search, as a share of
// the distance. A wrong pose of a small part of a print can bend until its edges scatter little,
// but then they hardly determine it.
constexpr double kMaxSureSigma = 0.01;
// Frequency with which the mirror pose is the right one although it explains the image less well.
// Measured on rendered stills, docs/location.md.
constexpr double kMirrorIsRight = 0.05;

Eigen::Vector3d NormalOf(const PrintFinding& finding) {
  return finding.location.camera_from_target.rotation * Eigen::Vector3d::UnitZ();
}

// True when two findings are the two poses of one ring and the image does not decide between them.
bool AreMirrorPoses(const PrintFinding& a, const PrintFinding& b) {
  constexpr double kSameCenterPx = 2;
  constexpr double kOtherNormal = 0.99;  // cosine between the normals
  constexpr double kAlike = 4;           // log odds; a clearly wrong pose differs by more
  return std::abs(a.log_odds - b.log_odds) < kAlike &&
         (a.center_px - b.center_px).norm() < kSameCenterPx &&
         NormalOf(a).dot(NormalOf(b)) < kOtherNormal;
}

// The better one of two mirror poses has the smaller residuals: both show the same parts of
// the print in place, but not equally near to their place.
bool IsBetterMirror(const PrintFinding& a, const PrintFinding& b) {
  const PatternLocation& one = a.location;
  const PatternLocation& other = b.location;
  if (one.edge_rms_px > 0 && other.edge_rms_px > 0) return one.edge_rms_px < other.edge_rms_px;
  if (one.gray_rms > 0 && other.gray_rms > 0) return one.gray_rms < other.gray_rms;
  return a.log_odds > b.log_odds;
}

// Difference between two poses: translation, then rotation vector, in the camera frame.
Eigen::Matrix<double, 6, 1> Difference(const RigidTransform& from, const RigidTransform& to) {
  Eigen::Matrix<double, 6, 1> difference;
  difference << to.translation - from.translation,
      RotationVector(to.rotation * from.rotation.inverse());
  return difference;
}

// The bound allows for the scatter of edges and for a sheet that is not quite flat.
double MisfitBoundPx(const PrintFinding& finding) {
  constexpr double kSigmas = 3;
  if (!finding.seen) return 0;
  return kSigmas * std::hypot(finding.seen_rms_px, kUnflatShare * finding.diameters_px.x());
}

}  // namespace

double PrintFinding::relative_sigma() const {
  return std::sqrt(location.covariance.topLeftCorner<3, 3>().trace()) /
         location.camera_from_target.translation.norm();
}

DetectionChoice::DetectionChoice(double min_quality, const FindingObserver* observer,
                                 SearchLog* log)
    : least_log_odds_(min_quality < 1 ? std::log(min_quality / (1 - min_quality))
                                      : std::numeric_limits<double>::infinity()),
      observer_(observer),
      log_(*log) {}

bool DetectionChoice::Add(const PrintFinding& finding) {
  if (observer_) (*observer_)(finding);
  if (!Accepts(finding)) {
    log_.Reach(LandingStage::kLocate, MainDoubt(finding.kind, finding.doubts));
    return false;
  }
  log_.Reach(LandingStage::kFound, {});
  if (!Replaces(finding)) return true;
  // A finding that contradicts the hint ends the search only when it is beyond doubt.
  is_sure_ = finding.log_odds + finding.by_hint >= least_log_odds_ &&
             (!finding.is_part() || finding.relative_sigma() <= kMaxSureSigma);
  return true;
}

// Makes the finding the best one or the mirror pose of the best one, as appropriate. True when it
// became the best.
bool DetectionChoice::Replaces(const PrintFinding& finding) {
  if (best_ && AreMirrorPoses(*best_, finding)) {
    const bool is_better = IsBetterMirror(finding, *best_);
    mirror_ = is_better ? best_ : finding;
    if (is_better) best_ = finding;
    return is_better;
  }
  if (best_ && finding.log_odds + finding.by_hint <= best_->log_odds + best_->by_hint) return false;
  mirror_.reset();
  best_ = finding;
  return true;
}

bool DetectionChoice::IsClear() const {
  constexpr double kClearLogOdds = 4.6;  // 0.99
  return best_ && best_->log_odds >= kClearLogOdds;
}

std::optional<TargetDetection> DetectionChoice::Detection() const {
  if (!best_) return std::nullopt;
  TargetDetection detection;
  detection.center_px = best_->center_px;
  detection.camera_from_target = best_->location.camera_from_target;
  detection.covariance = best_->location.covariance;
  detection.method = best_->method;
  detection.quality = ProbabilityOf(best_->log_odds);
  detection.semi_major_px = 0.5 * best_->diameters_px.x();
  detection.semi_minor_px = 0.5 * best_->diameters_px.y();
  detection.heading_symmetry = PrintOutline::kArms;
  detection.parts.Add({"ring and cross", std::nullopt, best_->diameters_px.x()});
  detection.diagnostics.misfit_px = best_->location.misfit_px;
  detection.diagnostics.misfit_bound_px = MisfitBoundPx(*best_);
  detection.diagnostics.seen = best_->seen;
  detection.diagnostics.calibration = best_->location.calibration;
  if (!mirror_) return detection;
  detection.diagnostics.mirror_camera_from_target = mirror_->location.camera_from_target;
  const Eigen::Matrix<double, 6, 1> difference =
      Difference(detection.camera_from_target, *detection.diagnostics.mirror_camera_from_target);
  detection.covariance += kMirrorIsRight * difference * difference.transpose();
  return detection;
}

}  // namespace kestrel
