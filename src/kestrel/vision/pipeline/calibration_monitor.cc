// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/pipeline/calibration_monitor.h"

#include <algorithm>
#include <cmath>
#include <span>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <fmt/format.h>

namespace kestrel {
namespace {

constexpr std::size_t kMinViews = 6;
constexpr std::size_t kMinSides = 4;
constexpr double kSureSigmas = 3.5;  // the contradiction is tested after every view
constexpr double kLeastContradiction = 0.015;
// Prior of the calibration: the logarithm of the focal length, the principal point in focal
// lengths, and the distortion (factor of the cube of the distance from the principal point, in
// focal lengths).
constexpr std::array<double, 4> kPriorSigma{0.5, 0.05, 0.05, 0.1};
// Width of a side, in direction (rad) and in position in the image (focal lengths).
constexpr double kSideWidth = 0.1;
// Edge error that views from one side share, because a print is not quite flat; share of the ring's
// diameter.
constexpr double kSharedShare = 0.001;
// Standard deviations of the logarithm of the focal length that all views share: from errors of the
// sheet, and from the square of a large error, which linear equations ignore (as a factor of it).
constexpr double kSharedSigma = 0.003;
constexpr double kOfSquare = 0.1;
constexpr double kFarSurprise = 4;  // a side with this surprise has half the weight (Cauchy)
constexpr int kRounds = 2;          // updates of the weights per view; they converge over the views

Eigen::Vector4d PriorInformation() {
  return Eigen::Vector4d(kPriorSigma.data()).cwiseAbs2().cwiseInverse();
}

}  // namespace

double CalibrationMonitor::Side::Surprise(const Eigen::Vector4d& error) const {
  const double more = error.dot(information * error) - 2 * error.dot(pull);
  return Trust() * std::max(0.0, surprise_0 + more);
}

CalibrationMonitor::Side* CalibrationMonitor::SideOf(const TargetDetection& detection) {
  const RigidTransform& pose = detection.camera_from_target;
  const Eigen::Vector3d in_camera = pose.translation.normalized();
  const Eigen::Vector3d in_pattern = pose.rotation.conjugate() * in_camera;
  const auto part = [](double share) { return static_cast<int>(std::lround(share / kSideWidth)); };
  const std::array<int, 4> key{part(in_pattern.x()), part(in_pattern.y()), part(in_camera.x()),
                               part(in_camera.y())};
  for (Side& side : std::span(sides_).first(side_count_)) {
    if (side.key == key) return &side;
  }
  if (side_count_ == kMostSides) return nullptr;
  sides_[side_count_].key = key;
  return &sides_[side_count_++];
}

void CalibrationMonitor::Add(const TargetDetection& detection) {
  if (detection.diagnostics.misfit_px > 0) ++misfits_.detections;
  if (detection.diagnostics.is_misfit()) ++misfits_.misfits;
  AddEvidence(detection);
}

// Views without evidence are ignored.
void CalibrationMonitor::AddEvidence(const TargetDetection& detection) {
  const CalibrationEvidence& evidence = detection.diagnostics.calibration;
  if (!(evidence.edge_variance > 0) || !evidence.information.allFinite()) return;
  Side* const side = SideOf(detection);
  if (side == nullptr) return;
  side->information += evidence.information;
  side->pull += evidence.pull;
  const double shared_px = kSharedShare * 2 * detection.semi_major_px;
  side->shared += shared_px * shared_px / evidence.edge_variance;
  // Regularization of the directions that the side hardly determines.
  constexpr double kWeak = 1e-3;
  Eigen::Matrix4d h = side->information;
  h.diagonal() += kWeak * PriorInformation();
  side->surprise_0 = side->pull.dot(h.ldlt().solve(side->pull));
  ++views_;
  Weigh();
}

// Robust least squares: sides that contradict the others have less weight and increase the standard
// deviation.
void CalibrationMonitor::Weigh() {
  constexpr double kKnownBySide = 2;  // numbers that a side determines; it leaves the others open
  constexpr double kEstimated = 4;
  const Eigen::Vector4d prior = PriorInformation();
  for (int round = 0; round < kRounds; ++round) {
    Eigen::Matrix4d information = prior.asDiagonal();
    Eigen::Vector4d pull = Eigen::Vector4d::Zero();
    double weights = 0, surprise = 0;
    for (const Side& side : std::span(sides_).first(side_count_)) {
      const double surprise_of_side = side.Surprise(error_);
      const double weight = 1 / (1 + surprise_of_side / kFarSurprise);
      information += weight * side.Trust() * side.information;
      pull += weight * side.Trust() * side.pull;
      weights += weight;
      surprise += weight * surprise_of_side;
    }
    const Eigen::LDLT<Eigen::Matrix4d> decomposition(information);
    error_ = decomposition.solve(pull);
    const double variance = decomposition.solve(Eigen::Vector4d::UnitX())(0);
    const double scatter = surprise / std::max(1.0, kKnownBySide * weights - kEstimated);
    log_focal_sigma_ = std::hypot(kSharedSigma, kOfSquare * error_(0) * error_(0),
                                  std::sqrt(variance * std::max(1.0, scatter)));
  }
}

std::optional<FocalFactor> CalibrationMonitor::Focal() const {
  if (views_ < kMinViews || side_count_ < kMinSides) return std::nullopt;
  const double factor = std::exp(error_(0));
  return FocalFactor{factor, factor * log_focal_sigma_, views_};
}

std::optional<FocalFactor> CalibrationMonitor::Contradiction() const {
  const std::optional<FocalFactor> focal = Focal();
  const double least = std::max(kLeastContradiction, kSureSigmas * log_focal_sigma_);
  return focal && std::abs(error_(0)) > least ? focal : std::nullopt;
}

std::optional<MisfitCount> CalibrationMonitor::Misfits() const {
  constexpr std::size_t kLeast = 10;
  constexpr double kLeastShare = 0.2;
  const auto detections = static_cast<double>(misfits_.detections);
  const bool are_many = misfits_.misfits >= kLeast &&
                        static_cast<double>(misfits_.misfits) > kLeastShare * detections;
  return are_many ? std::optional(misfits_) : std::nullopt;
}

std::string LensWarning(const CalibrationMonitor& monitor, double focal_px) {
  constexpr char kAdvice[] = "kestrel calibrate lens estimates it from such views";
  if (const auto focal = monitor.Contradiction()) {
    return fmt::format("the pattern says f = {:.0f} +- {:.0f} px, the calibration {:.0f}: {}",
                       focal->factor * focal_px, focal->sigma * focal_px, focal_px, kAdvice);
  }
  if (const auto count = monitor.Misfits()) {
    return fmt::format(
        "in {} of {} frames the pattern is seen beside where pose and calibration have it "
        "(misfit_px): lens or print are not what they are configured to be; {}",
        count->misfits, count->detections, kAdvice);
  }
  return "";
}

}  // namespace kestrel
