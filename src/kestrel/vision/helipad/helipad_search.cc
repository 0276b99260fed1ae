// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/helipad/helipad_search.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numbers>
#include <span>
#include <utility>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <Eigen/SVD>

#include "kestrel/core/geometry/angles.h"

namespace kestrel {
namespace {

constexpr double kSearchPrior = 12;   // odds against an H at any border, natural logarithm
constexpr double kFollowedPrior = 6;  // against it near the expected place
constexpr double kLeastStrokePx = 1.3;
constexpr double kSearchSigmas = 3;      // of the expected place that are searched
constexpr double kLeastRight = 0.8;      // of the samples of a part
constexpr double kLeastExplained = 0.7;  // of the edges of the H
constexpr int kTurns = 24;               // that are tried, in half a circle
constexpr double kAmbiguousCost = 4.5;   // below it the image cannot tell two poses apart: 3 sigma
constexpr double kHelipadMisfitBoundPx = 1;

std::int64_t NowNs() {
  return std::chrono::steady_clock::now().time_since_epoch() / std::chrono::nanoseconds(1);
}

// Adds the time from its construction to its end.
class HelipadTimer {
 public:
  HelipadTimer(LandingReport* report, LandingStage stage)
      : total_(report->stage_ns[static_cast<std::size_t>(stage)]), start_(NowNs()) {}
  ~HelipadTimer() { total_ += NowNs() - start_; }
  HelipadTimer(const HelipadTimer&) = delete;
  HelipadTimer& operator=(const HelipadTimer&) = delete;

 private:
  std::int64_t& total_;
  std::int64_t start_;
};

// Returns one of the two poses whose weak perspective is an affine map: 'map' is from the pad (m)
// to the plane at distance 1, 'center' the place of the pad's middle there.
RigidTransform PoseOfAffine(const HelipadCandidate& candidate, const Eigen::Matrix2d& map,
                            double sign) {
  const Eigen::JacobiSVD<Eigen::Matrix2d> svd(map);
  const double scale = svd.singularValues()(0);
  const Eigen::Matrix2d flat = map / scale;
  const double first = std::sqrt(std::max(0.0, 1 - flat.col(0).squaredNorm()));
  double second = std::sqrt(std::max(0.0, 1 - flat.col(1).squaredNorm()));
  if (flat.col(0).dot(flat.col(1)) > 0) second = -second;
  Eigen::Matrix3d rotation;
  rotation.col(0) << flat.col(0), sign * first;
  rotation.col(1) << flat.col(1), sign * second;
  rotation.col(0).normalize();
  rotation.col(1) -= rotation.col(0).dot(rotation.col(1)) * rotation.col(0);
  rotation.col(1).normalize();
  rotation.col(2) = rotation.col(0).cross(rotation.col(1));
  const Eigen::Matrix3d& axes = candidate.camera_from_plane;
  return {Eigen::Quaterniond(Eigen::Matrix3d(axes * rotation)),
          axes * candidate.moments.centroid.homogeneous() / scale};
}

// Half a turn, under which the H looks the same.
RigidTransform HalfTurned(const RigidTransform& pose) {
  return {pose.rotation * Eigen::Quaterniond(0, 0, 0, 1), pose.translation};
}

}  // namespace

HelipadSearch::HelipadSearch(const HelipadSearchModels& models, const cv::Mat& image,
                             const LandingHint& hint, HelipadSearchBuffers* buffers)
    : models_(models),
      image_(image),
      hint_(hint),
      buffers_(*buffers),
      prior_{hint.up_in_camera, Radians(models.options.level_sigma_deg)} {}

LandingReport HelipadSearch::Run() {
  report_.reason = "the image has no contrast";
  if (hint_.center_in_camera && hint_.rotation_in_camera) Follow();
  if (!is_found()) Search();
  if (is_found()) {
    report_.reached = LandingStage::kFound;
    report_.reason = {};
  }
  return report_;
}

void HelipadSearch::Reached(LandingStage stage, std::string_view reason) {
  ++report_.candidates[static_cast<std::size_t>(stage)];
  if (stage < report_.reached) return;
  report_.reached = stage;
  report_.reason = reason;
}

void HelipadSearch::SampleAt(const RigidTransform& pose) {
  buffers_.samples.Clear();
  for (const HelipadSample& sample : models_.pad.samples) {
    buffers_.samples.Add(pose * Eigen::Vector3d(sample.place.x(), sample.place.y(), 0));
  }
  buffers_.samples.Project(models_.camera);
}

// Moves a pose across the line of sight to where the image looks most like the pad.
std::optional<RigidTransform> HelipadSearch::ShiftedPose(const RigidTransform& expected) {
  const double stroke_px = CellPx(models_.camera, expected, models_.pad.edges.tags[0]);
  if (stroke_px < kLeastStrokePx) return std::nullopt;
  constexpr double kMostShiftPx = 30, kStepStrokes = 0.4;
  constexpr int kMostSteps = 10;  // to either side
  const double focal_px = models_.camera.intrinsics().fx_px;
  const double radius = std::min(
      kMostShiftPx, kSearchSigmas * hint_.center_sigma_m * focal_px / expected.translation.norm());
  const double step = std::max(kStepStrokes * stroke_px, radius / kMostSteps);
  const int steps = static_cast<int>(std::ceil(radius / step));
  SampleAt(expected);
  double best = 0;
  Eigen::Vector2d shift(0, 0);
  for (int y = -steps; y <= steps; ++y) {
    for (int x = -steps; x <= steps; ++x) {
      const double here = models_.pad.Likeness(buffers_.samples.Read(
          image_, static_cast<float>(x * step), static_cast<float>(y * step)));
      if (here <= best) continue;
      best = here;
      shift = Eigen::Vector2d(x, y) * step;
    }
  }
  if (best <= 0) return std::nullopt;
  // The sample nearest to the image's middle carries the shift into space.
  const Eigen::Vector2d middle(0.5 * image_.cols, 0.5 * image_.rows);
  double nearest = 1e18;
  std::size_t carrier = 0;
  for (std::size_t i = 0; i < buffers_.samples.count(); ++i) {
    const Eigen::Vector2d place(buffers_.samples.u(i), buffers_.samples.v(i));
    const double away = (place - middle).squaredNorm();
    if (!(away < nearest)) continue;
    nearest = away;
    carrier = i;
  }
  const Eigen::Vector2d from_px(buffers_.samples.u(carrier), buffers_.samples.v(carrier));
  Eigen::Vector3d from, to;
  if (models_.camera.Unproject(from_px, &from) == ProjectionStatus::kOutsideModel ||
      models_.camera.Unproject(from_px + shift, &to) == ProjectionStatus::kOutsideModel) {
    return std::nullopt;
  }
  const Eigen::Vector2d& place = models_.pad.samples[carrier].place;
  const double range = (expected * Eigen::Vector3d(place.x(), place.y(), 0)).norm();
  return RigidTransform{expected.rotation, expected.translation + range * (to - from)};
}

void HelipadSearch::Follow() {
  const HelipadTimer timer(&report_, LandingStage::kMatch);
  const RigidTransform expected{*hint_.rotation_in_camera, *hint_.center_in_camera};
  const std::optional<RigidTransform> shifted = ShiftedPose(expected);
  if (shifted) Take(*shifted, kFollowedPrior, DetectionMethod::kFollowed);
}

cv::Rect HelipadSearch::SearchedPart() const {
  const cv::Rect whole(0, 0, image_.cols, image_.rows);
  Eigen::Vector2d center;
  if (!hint_.center_in_camera ||
      models_.camera.Project(*hint_.center_in_camera, &center) == ProjectionStatus::kOutsideModel) {
    return whole;
  }
  // A box of the threshold around the pad, and lenses that magnify towards the edge.
  constexpr double kMargin = 1.5;
  const double reach = models_.pad.edges.radius_m + kSearchSigmas * hint_.center_sigma_m;
  const double radius_px = kMargin * models_.camera.intrinsics().fx_px * reach /
                               std::max(0.1, hint_.center_in_camera->norm()) +
                           12;
  const double most = image_.cols + image_.rows;
  if (!(radius_px < most)) return whole;
  const cv::Rect part =
      whole & cv::Rect(static_cast<int>(center.x() - radius_px),
                       static_cast<int>(center.y() - radius_px), static_cast<int>(2 * radius_px),
                       static_cast<int>(2 * radius_px));
  return part.empty() ? whole : part;
}

bool HelipadSearch::MayHaveSize(int pass) const {
  if (!hint_.center_in_camera) return true;
  const double distance = hint_.center_in_camera->norm();
  const double error = std::min(0.5, kSearchSigmas * hint_.center_sigma_m / distance);
  const double size_px =
      2 * models_.camera.intrinsics().fx_px * models_.pad.edges.radius_m / distance;
  constexpr double kSlant = 0.6;  // of the extent of a pad that is seen from aside
  return HelipadFinder::Covers(pass, kSlant * size_px / (1 + error), size_px / (1 - error));
}

void HelipadSearch::Search() {
  const cv::Rect part = SearchedPart();
  {
    const HelipadTimer timer(&report_, LandingStage::kBinarize);
    models_.finder.Begin(image_, part, &buffers_.candidates);
  }
  const std::int64_t start = NowNs();
  for (int pass = hint_.first_step; pass < HelipadFinder::kPasses && !is_found(); ++pass) {
    constexpr double kNsPerMs = 1e6;
    const bool late = hint_.max_search_ms > 0 && pass > hint_.first_step &&
                      static_cast<double>(NowNs() - start) > hint_.max_search_ms * kNsPerMs;
    if (late) {
      report_.next_step = pass;
      return;
    }
    if (MayHaveSize(pass)) SearchPass(part, pass);
  }
}

void HelipadSearch::SearchPass(const cv::Rect& part, int pass) {
  {
    const HelipadTimer timer(&report_, LandingStage::kAreas);
    models_.finder.Find(part, pass, &buffers_.candidates);
  }
  report_.candidates[static_cast<std::size_t>(LandingStage::kAreas)] +=
      static_cast<std::int32_t>(buffers_.candidates.borders);
  if (buffers_.candidates.borders > 0 && report_.reached < LandingStage::kAreas) {
    report_.reached = LandingStage::kAreas;
    report_.reason = "no border has the moments of an H";
  }
  const HelipadTimer timer(&report_, LandingStage::kCross);
  for (const HelipadCandidate& candidate : buffers_.candidates.candidates) Try(candidate);
}

std::optional<Eigen::Matrix2d> HelipadSearch::BestTurn(const HelipadCandidate& candidate) {
  const Eigen::LLT<Eigen::Matrix2d> seen(candidate.moments.covariance);
  if (seen.info() != Eigen::Success) return std::nullopt;
  // The pad's face looks at the camera, so that its axes are mirrored.
  const Eigen::Vector2d unit = models_.pad.moments.covariance.diagonal().cwiseSqrt().cwiseInverse();
  const Eigen::Matrix2d from_pad = Eigen::Vector2d(unit.x(), -unit.y()).asDiagonal();
  std::optional<Eigen::Matrix2d> best;
  constexpr double kLeastLikeness = 1;
  double most = kLeastLikeness;
  for (int i = 0; i < kTurns; ++i) {
    const Eigen::Matrix2d map = seen.matrixL().toDenseMatrix() *
                                Eigen::Rotation2Dd(kPi * i / kTurns).toRotationMatrix() * from_pad;
    buffers_.samples.Clear();
    for (const HelipadSample& sample : models_.pad.samples) {
      const Eigen::Vector2d place = map * sample.place + candidate.moments.centroid;
      buffers_.samples.Add(candidate.camera_from_plane * place.homogeneous());
    }
    buffers_.samples.Project(models_.camera);
    const double likeness = models_.pad.Likeness(buffers_.samples.Read(image_));
    if (likeness <= most) continue;
    most = likeness;
    best = map;
  }
  return best;
}

void HelipadSearch::Try(const HelipadCandidate& candidate) {
  Reached(LandingStage::kRing, "no border with the moments of an H looks like one");
  const std::optional<Eigen::Matrix2d> map = BestTurn(candidate);
  if (!map) return;
  Reached(LandingStage::kCross, "the edges of the H are not where they should be");
  for (const double sign : {1.0, -1.0}) {
    const std::optional<AlignedBoard> letter =
        models_.alignment.Align(image_, PoseOfAffine(candidate, *map, sign), prior_,
                                &models_.pad.edges.tags[0], &buffers_.alignment);
    if (letter) Take(letter->camera_from_board, kSearchPrior, DetectionMethod::kLetter);
  }
}

int HelipadSearch::EdgesInView(const RigidTransform& pose) const {
  const TagModel& letter = models_.pad.edges.tags[0];
  int count = 0;
  for (const BoardEdge& edge : letter.edges) {
    Eigen::Vector2d pixel;
    const Eigen::Vector3d place = pose * Eigen::Vector3d(edge.place.x(), edge.place.y(), 0);
    count += !edge.fine && models_.camera.Project(place, &pixel) == ProjectionStatus::kOk;
  }
  return count;
}

double HelipadSearch::QualityOf(const AlignedBoard& aligned, double prior) {
  const RigidTransform& pose = aligned.camera_from_board;
  const double stroke_px = CellPx(models_.camera, pose, models_.pad.edges.tags[0]);
  if (stroke_px < kLeastStrokePx) return 0;
  // Edges of other figures are where the H has some, too, but not exactly there.
  constexpr double kMostMisfitPx = 0.5, kMostMisfitStrokes = 0.02;
  if (aligned.rms_px > std::max(kMostMisfitPx, kMostMisfitStrokes * stroke_px)) return 0;
  if (aligned.edges < kLeastExplained * EdgesInView(pose)) return 0;
  SampleAt(pose);
  const HelipadAgreement agreement = models_.pad.Compare(buffers_.samples.Read(image_));
  // A leg with what is beside it, at least.
  constexpr int kFewestParts = 3;
  if (agreement.parts < kFewestParts || agreement.worst_share < kLeastRight) return 0;
  return 1 / (1 + std::exp(prior - agreement.evidence));
}

void HelipadSearch::Take(const RigidTransform& pose, double prior, DetectionMethod method) {
  std::optional<AlignedBoard> aligned =
      models_.alignment.Align(image_, pose, prior_, nullptr, &buffers_.alignment);
  if (!aligned) return;
  Reached(LandingStage::kMatch, "what is at the edges does not look like the H");
  const double quality = QualityOf(*aligned, prior);
  if (quality < models_.options.min_quality) return;
  if (is_found() && quality <= report_.detection->quality) return;
  Reached(LandingStage::kLocate, "no pose explains the edges");
  Report(*aligned, quality, method);
}

void HelipadSearch::Report(const AlignedBoard& found, double quality, DetectionMethod method) {
  AlignedBoard aligned = found;
  LandingDetection detection{};
  std::optional<AlignedBoard> mirror = models_.alignment.Align(
      image_, MirrorPose(aligned.camera_from_board), prior_, nullptr, &buffers_.alignment);
  constexpr double kApart = Radians(0.5);  // else both starts led to the same pose
  if (mirror && mirror->camera_from_board.rotation.angularDistance(
                    aligned.camera_from_board.rotation) > kApart) {
    const double cost = CostAbove(aligned, *mirror);
    if (cost < 0) std::swap(aligned, *mirror);
    if (std::abs(cost) < kAmbiguousCost) {
      detection.mirror_camera_from_pattern = mirror->camera_from_board;
    }
  }
  RigidTransform& pose = aligned.camera_from_board;
  if (hint_.rotation_in_camera &&
      pose.rotation.angularDistance(*hint_.rotation_in_camera) > kPi / 2) {
    pose = HalfTurned(pose);
  }
  detection.camera_from_pattern = pose;
  if (models_.camera.Project(pose.translation, &detection.center_px) ==
      ProjectionStatus::kOutsideModel) {
    detection.center_px.setConstant(NAN);
  }
  detection.covariance = aligned.covariance;
  detection.method = method;
  detection.quality = quality;
  const double distance = pose.translation.norm();
  const double slant =
      std::abs((pose.rotation * Eigen::Vector3d::UnitZ()).dot(pose.translation)) / distance;
  detection.semi_major_px =
      models_.camera.intrinsics().fx_px * models_.pad.edges.radius_m / distance;
  detection.semi_minor_px = slant * detection.semi_major_px;
  detection.heading_symmetry = 2;
  detection.parts.Add({"H", std::nullopt, 2 * detection.semi_major_px});
  detection.misfit_px = aligned.rms_px;
  detection.misfit_bound_px = kHelipadMisfitBoundPx;
  report_.detection = detection;
}

}  // namespace kestrel
