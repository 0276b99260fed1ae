// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/helipad/helipad_search.h"

#include <algorithm>
#include <cmath>
#include <span>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>

#include "kestrel/core/geometry/angles.h"
#include "kestrel/vision/search/plane_figure.h"

namespace kestrel {
namespace {

// Natural logarithms of the odds against an H in any pose that a search tries: some 20,000 (10), in
// images that are made of lines rather than of independent points and seldom show a pad (26, the
// least that kept it out of textures, and half of what the faintest pads have above it).
constexpr double kSearchPrior = 36;
// The same near the expected place: some 400 poses (6), and a pad is likely to be there.
constexpr double kFollowedPrior = 24;
constexpr double kLeastStrokePx = 1.3;
constexpr double kLeastRight = 0.8;      // as a share of a part's samples
constexpr double kLeastExplained = 0.7;  // as a share of the edges of the H
constexpr int kTurns = 24;               // that are tried, in half a circle

// Half a turn, under which the H looks the same.
RigidTransform HalfTurned(const RigidTransform& pose) {
  return {pose.rotation * Eigen::Quaterniond(0, 0, 0, 1), pose.translation};
}

}  // namespace

HelipadSearch::HelipadSearch(const HelipadSearchModels& models, const cv::Mat& image,
                             const TargetHint& hint, HelipadSearchBuffers* buffers)
    : PadSearch(models.search, image, hint, &buffers->pad),
      helipad_(models),
      candidates_(buffers->candidates) {}

double HelipadSearch::StrokePx(const RigidTransform& pose) const {
  return helipad_.pad.parts[0].StrokePx(models_.camera, pose);
}

void HelipadSearch::Follow(const RigidTransform& expected) {
  const double stroke_px = StrokePx(expected);
  if (stroke_px < kLeastStrokePx) return;
  constexpr double kStepStrokes = 0.4;
  const std::optional<RigidTransform> shifted = MostLike(
      expected, helipad_.pad.samples.places(), kStepStrokes * stroke_px,
      [this](std::span<const float> gray) { return helipad_.pad.samples.LikenessOf(gray); });
  if (shifted) Take(*shifted, kFollowedPrior, DetectionMethod::kFollowed);
}

void HelipadSearch::Begin(const cv::Rect& part) {
  helipad_.finder.Begin(image_, part, &candidates_);
  const bool is_predicted = hint_.center_in_camera && part.size() != image_.size();
  may_be_in_glare_ = is_predicted || candidates_.borders.ShowsGlare();
}

bool HelipadSearch::MayHaveSize(int pass, double distance_m, double error) const {
  const double size_px = 2 * models_.camera.intrinsics().fx_px * models_.radius_m / distance_m;
  constexpr double kSlant = 0.6;  // share of its extent that a pad keeps when it is seen from aside
  return helipad_.finder.Covers(pass, kSlant * size_px / (1 + error), size_px / (1 - error));
}

// Where no pass finds intact borders, strokes in any light are looked for, which takes longer; then
// gray values are searched, whose logarithms glare brings together: in a whole image only if some
// of it is overexposed.
int HelipadSearch::Steps() const { return (may_be_in_glare_ ? 3 : 2) * PlaneBorders::kPasses; }

void HelipadSearch::SearchStep(const cv::Rect& part, int step) {
  {
    const SearchLog::Timer timer = log_.Time(LandingStage::kAreas);
    const int pass = step % PlaneBorders::kPasses;
    const int round = step / PlaneBorders::kPasses;
    if (round == 1) {
      helipad_.finder.FindNarrow(part, pass, &candidates_);
    } else {
      if (round == 2 && !is_linear_) {
        helipad_.finder.BeginLinear(image_, part, &candidates_);
        is_linear_ = true;
      }
      helipad_.finder.Find(part, pass, &candidates_);
    }
  }
  ExamineBorders(candidates_.examined, "no border has the moments of an H or its frame");
  const SearchLog::Timer timer = log_.Time(LandingStage::kCross);
  for (const HelipadCandidate& candidate : candidates_.candidates) Try(candidate);
}

std::optional<Eigen::Matrix2d> HelipadSearch::BestTurn(const HelipadCandidate& candidate) {
  const Eigen::LLT<Eigen::Matrix2d> seen(candidate.moments.covariance);
  if (seen.info() != Eigen::Success) return std::nullopt;
  // The pad's face looks at the camera, so that its axes are mirrored.
  const Eigen::Vector2d unit = candidate.printed->covariance.diagonal().cwiseSqrt().cwiseInverse();
  const Eigen::Matrix2d from_pad = Eigen::Vector2d(unit.x(), -unit.y()).asDiagonal();
  std::optional<Eigen::Matrix2d> best;
  constexpr double kLeastLikeness = 0.5;
  double most = kLeastLikeness;
  for (int i = 0; i < kTurns; ++i) {
    const Eigen::Matrix2d map = seen.matrixL().toDenseMatrix() *
                                Eigen::Rotation2Dd(kPi * i / kTurns).toRotationMatrix() * from_pad;
    buffers_.samples.Clear();
    for (const Eigen::Vector2d& place : helipad_.pad.samples.places()) {
      const Eigen::Vector2d on_plane = map * place + candidate.moments.centroid;
      buffers_.samples.Add(candidate.camera_from_plane * on_plane.homogeneous());
    }
    buffers_.samples.Project(models_.camera);
    const double likeness = helipad_.pad.samples.LikenessOf(buffers_.samples.Read(image_));
    if (likeness <= most) continue;
    most = likeness;
    best = map;
  }
  return best;
}

void HelipadSearch::Try(const HelipadCandidate& candidate) {
  log_.Reach(LandingStage::kRing, "no border with the moments of an H or its frame is one");
  const std::optional<Eigen::Matrix2d> map = BestTurn(candidate);
  if (!map) return;
  log_.Reach(LandingStage::kCross, "the edges of the H are not where they should be");
  for (const double sign : {1.0, -1.0}) {
    const std::optional<AlignedPad> letter =
        Align(PoseOfAffineMap(candidate.camera_from_plane, *map, candidate.moments.centroid, sign),
              &helipad_.pad.parts[0]);
    if (letter) Take(letter->camera_from_pad, kSearchPrior, DetectionMethod::kLetter);
  }
}

int HelipadSearch::EdgesInView(const RigidTransform& pose) const {
  int count = 0;
  for (const PadEdge& edge : helipad_.pad.parts[0].edges) {
    Eigen::Vector2d pixel;
    const Eigen::Vector3d place = pose * Eigen::Vector3d(edge.place.x(), edge.place.y(), 0);
    count += !edge.fine && models_.camera.Project(place, &pixel) == ProjectionStatus::kOk;
  }
  return count;
}

double HelipadSearch::QualityOf(const AlignedPad& aligned, double prior, DimSample dim) {
  const RigidTransform& pose = aligned.camera_from_pad;
  const double stroke_px = StrokePx(pose);
  if (stroke_px < kLeastStrokePx) return 0;
  // Edges of other figures are where the H has some, too, but not exactly there.
  constexpr double kMostMisfitPx = 0.5, kMostMisfitStrokes = 0.02;
  if (aligned.rms_px > std::max(kMostMisfitPx, kMostMisfitStrokes * stroke_px)) return 0;
  if (aligned.edges < kLeastExplained * EdgesInView(pose)) return 0;
  const InkSamples& samples = helipad_.pad.samples;
  buffers_.samples.Place(models_.camera, pose, samples.places());
  const InkAgreement agreement = samples.Compare(
      buffers_.samples.Read(image_), helipad_.pad.sample_area * stroke_px * stroke_px, dim);
  // A leg with what is beside it, at least.
  constexpr int kFewestParts = 3;
  if (agreement.parts < kFewestParts || agreement.worst_share < kLeastRight) return 0;
  return 1 / (1 + std::exp(prior - agreement.evidence));
}

void HelipadSearch::Take(const RigidTransform& pose, double prior, DetectionMethod method) {
  const std::optional<AlignedPad> aligned = Align(pose);
  if (!aligned) return;
  log_.Reach(LandingStage::kMatch, "what is at the edges does not look like the H");
  const double quality = QualityOf(*aligned, prior, DimSampleIn(method));
  if (quality < helipad_.min_quality) return;
  if (is_found() && quality <= report_.detection->quality) return;
  log_.Reach(LandingStage::kLocate, "no pose explains the edges");
  Report(*aligned, quality, method);
}

void HelipadSearch::Report(const AlignedPad& found, double quality, DetectionMethod method) {
  AlignedPad aligned = found;
  const std::optional<RigidTransform> mirror = ResolveMirror(&aligned);
  TargetDetection detection = DetectionOf(aligned, quality, method);
  detection.diagnostics.mirror_camera_from_target = mirror;
  RigidTransform& pose = detection.camera_from_target;
  if (hint_.rotation_in_camera &&
      pose.rotation.angularDistance(*hint_.rotation_in_camera) > kPi / 2) {
    pose = HalfTurned(pose);
  }
  detection.semi_major_px =
      models_.camera.intrinsics().fx_px * models_.radius_m / pose.translation.norm();
  detection.semi_minor_px = Slant(pose) * detection.semi_major_px;
  detection.heading_symmetry = 2;
  detection.parts.Add({"H", std::nullopt, 2 * detection.semi_major_px});
  report_.detection = detection;
}

}  // namespace kestrel
