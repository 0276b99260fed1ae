// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/landing/verification/small_print_verifier.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "kestrel/vision/landing/image_properties.h"
#include "kestrel/vision/landing/location/pattern_pose.h"
#include "kestrel/vision/landing/print_places.h"
#include "kestrel/vision/landing/score/gray_doubts.h"
#include "kestrel/vision/landing/verification/cross.h"

namespace kestrel {
namespace {

using Light = SmallPatternFitter::Light;

constexpr double kMinMajorPx = 9;         // longer diameter of the smallest ring
constexpr double kFlattestRing = 0.08;    // axis ratio of the flattest ring
constexpr double kMinCorrelation = 0.35;  // correlation of a start with the image
constexpr double kSureCorrelation = 0.6;  // correlation of a start by the direction of an arm
constexpr double kMinCorrelationOfEither = 0.7;  // else the mirror pose is not tested
// Explained share of the variance below which shadows are searched for even on a print that is
// found in even light: they bend the pose.
constexpr double kWellExplained = 0.85;
constexpr int kFitIterations = 8;

// Largest change of the distance and of the place (radii) of the ring by a fit.
constexpr double kMaxDistanceChange = 0.25;
constexpr double kMaxMove = 0.4;

// True when a fitted pose still belongs to the ring it started from.
bool Agrees(const RigidTransform& start, const RigidTransform& fitted, double radius_m) {
  const double distance = start.translation.norm();
  return std::abs(fitted.translation.norm() - distance) < kMaxDistanceChange * distance &&
         (fitted.translation.normalized() - start.translation / distance).norm() <
             kMaxMove * radius_m / distance;
}

}  // namespace

void SmallPrintVerifier::Test(const RingCandidate& ring) {
  if (IsTooSmall(ring.diameters_px)) return;
  const SearchLog::Timer timer = search_.log.Time(LandingStage::kCross);
  search_.log.Reach(LandingStage::kCross, "no cross inside of the ring");
  RingPlace place{{}, ring.diameters_px};
  if (search_.models.camera.Project(ring.poses[0].center, &place.center_px) ==
          ProjectionStatus::kOutsideModel ||
      buffers_.tested.Holds(place, RingMemory::kSameStart)) {
    return;
  }
  buffers_.tested.Note(place);
  const PriorKnowledge::Order order = search_.prior.OrderOf(ring.poses);
  for (const int pose : order.poses) {
    const Outcome outcome = TestPose(ring.poses[pose], ring.scales);
    if (outcome == Outcome::kNothing) return;
    if (outcome == Outcome::kFound && order.one_is_right) return;
  }
}

void SmallPrintVerifier::TestPredicted(const CirclePose& ring,
                                       const Eigen::Vector2d& diameters_px) {
  if (IsTooSmall(diameters_px)) return;
  const SearchLog::Timer timer = search_.log.Time(LandingStage::kCross);
  TestPose(ring, kOneScale);
}

// True when a ring is too small or seen almost edge-on.
bool SmallPrintVerifier::IsTooSmall(const Eigen::Vector2d& diameters_px) const {
  return diameters_px.x() < kMinMajorPx ||
         diameters_px.y() < SearchPass::kThinnest * search_.models.options.min_ring_px ||
         diameters_px.y() < kFlattestRing * diameters_px.x();
}

SmallPrintVerifier::Outcome SmallPrintVerifier::TestPose(const CirclePose& pose,
                                                         std::span<const double> scales) {
  const SmallPatternFitter::Start start = FindStart(pose, scales);
  // The two poses of a small ring look much the same: when one does not fit, neither does the
  // other.
  if (start.correlation < kMinCorrelation) return Outcome::kNothing;
  search_.log.Reach(LandingStage::kMatch, "ring and cross do not look like the pattern");
  const std::optional<NormalPrior> level = search_.prior.LevelPrior(pose.normal);
  const auto fit = [&](const RigidTransform& initial, Light light) {
    return search_.models.small.Refine(search_.image.whole(), initial, light, kFitIterations,
                                       &buffers_.gray_values, level);
  };
  const auto in_even = fit(start.camera_from_target, Light::kEven);
  if (!in_even || in_even->correlation < kMinCorrelationOfEither) return Outcome::kNothing;
  const RigidTransform& fitted = in_even->location.camera_from_target;
  if (!Agrees(start.camera_from_target, fitted, search_.models.options.pattern.outer_radius_m())) {
    return Outcome::kOtherPose;
  }
  search_.log.Reach(LandingStage::kLocate, "it is too small to tell");
  std::optional<PrintFinding> finding = FindingOf(*in_even, Light::kEven);
  if (!finding || !search_.choice.Accepts(*finding) || in_even->explained < kWellExplained) {
    const auto in_shadows = fit(fitted, Light::kShadows);
    const auto evened = in_shadows ? FindingOf(*in_shadows, Light::kShadows) : std::nullopt;
    if (evened && (!finding || evened->log_odds > finding->log_odds)) finding = evened;
  }
  return finding && search_.choice.Add(*finding) ? Outcome::kFound : Outcome::kOtherPose;
}

// Returns nothing for a print smaller than the smallest searched for.
std::optional<PrintFinding> SmallPrintVerifier::FindingOf(const SmallPatternFitter::Fit& fit,
                                                          Light light) const {
  constexpr double kSizeTolerance = 0.75;  // so few pixels hardly determine it
  const RigidTransform& pose = fit.location.camera_from_target;
  PrintFinding finding;
  finding.kind = PrintKind::kAsAWhole;
  finding.location = fit.location;
  finding.diameters_px =
      RingDiametersPx(search_.models.camera, search_.models.options.pattern.outer_radius_m(),
                      {pose.translation, pose.rotation * Eigen::Vector3d::UnitZ()});
  if (finding.diameters_px.y() < kSizeTolerance * search_.models.options.min_ring_px ||
      search_.models.camera.Project(pose.translation, &finding.center_px) ==
          ProjectionStatus::kOutsideModel) {
    return std::nullopt;
  }
  const PatternView view(search_.models.camera, pose, search_.models.ink.extent_m(), {});
  if (!view.valid()) return std::nullopt;
  const double seen = search_.models.ink.Doubt(search_.image.whole(), view, &finding.doubts);
  finding.method = seen < PrintPlaces::kWhole ? DetectionMethod::kPartial : DetectionMethod::kRing;
  finding.doubts[PrintDoubt::kHidden] = 1 - seen;
  DoubtGrayValues(fit, &finding.doubts);
  DoubtView(finding.diameters_px, finding.relative_sigma(), &finding.doubts);
  finding.doubts[PrintDoubt::kShadows] = light == Light::kShadows ? 1 : 0;
  finding.log_odds = PrintLogOdds(finding.kind, finding.doubts);
  finding.by_hint = search_.prior.LogOddsOfDistance(pose.translation);
  return finding;
}

// Returns the best start for a small pattern whose ring lies as 'pose'; its correlation is -1 when
// there is none.
SmallPatternFitter::Start SmallPrintVerifier::FindStart(const CirclePose& pose,
                                                        std::span<const double> scales) {
  const std::optional<double> scale =
      search_.models.small.FindScale(search_.image.whole(), pose, scales, &buffers_.gray_values);
  if (!scale) return {{}, -1};
  if (const std::optional<double> angle = ArmAngle(pose)) {
    auto start = search_.models.small.FindStart(pose, *scale, {&*angle, 1}, &buffers_.gray_values);
    if (start.correlation >= kSureCorrelation) return start;
  }
  // At most 7.5 degrees from any direction.
  constexpr double kStep = std::numbers::pi / 12;
  constexpr std::array<double, 6> kTurns{0, kStep, 2 * kStep, 3 * kStep, 4 * kStep, 5 * kStep};
  return search_.models.small.FindStart(pose, *scale, kTurns, &buffers_.gray_values);
}

// Returns the direction of an arm of a small cross.
std::optional<double> SmallPrintVerifier::ArmAngle(const CirclePose& pose) {
  const PatternView view(search_.models.camera, PatternPose(pose, 0),
                         search_.models.ring_probe.extent_m(), {});
  if (!view.valid()) return std::nullopt;
  const auto arms = FindArms(search_.image.whole(), view, search_.models.options.pattern);
  return arms ? std::optional(arms->angle) : std::nullopt;
}

}  // namespace kestrel
