// SPDX-License-Identifier: BSD-3-Clause
// How the search of an image tests a ring for the print, and locates it.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "kestrel/landing/landing_search.h"
#include "kestrel/landing/pattern_pose.h"

namespace kestrel {
namespace {

// Share of the least quality from which a pose is worth locating: one that lies beside the print
// may miss an arm, and be brought to it by the edges.
constexpr double kWorthLocating = 0.68;
// Edges of the print are found to a tenth of a pixel, blurred ones to a few; the nearest edges of
// anything else scatter over the whole reach of the search.
constexpr double kMaxEdgeRmsPx = 0.7;
constexpr double kMaxEdgeRms = 0.02;     // the same of small rings, share of the mean axis
constexpr double kInspectedRingPx = 80;  // mean axis below which it is looked for other signs
constexpr double kMinMajorPx = 9;        // of the smallest ring
constexpr double kMinAxisRatio = 0.08;   // of the flattest one
// Differences of the residuals inside of a small ring, on it and around it, share of the contrast.
constexpr double kMaxMoreInside = 0.085;
constexpr double kMaxMoreOnRing = 0.12;
constexpr double kMaxMoreOutside = 0.15;
// Darkness of what only other signs have, share of the contrast.
constexpr double kMinCrossCorrelation = 0.7;
// Added to that for a small pattern whose board is dark, times the darkness: two doubts in one.
constexpr double kCrossForDarkBoard = 1.2;
constexpr double kMaxOtherSpokes = 0.65;
constexpr double kMaxOtherSpokesOfSmall = 0.58;
constexpr double kMaxFrameCorners = 0.12;
constexpr double kMaxBoardDarkness = 0.35;
constexpr double kEveryPart = 0.95;              // quality of a print of which nothing is missing
constexpr double kSmallMargin = 0.1;             // of the quality of a small pattern
constexpr double kMinCorrelation = 0.35;         // of a start of a small pattern
constexpr double kSureCorrelation = 0.6;         // of a start that quadrants give
constexpr double kMinCorrelationOfEither = 0.7;  // of the poses of a small pattern
constexpr double kMinFittedCorrelation = 0.84;   // of a small pattern
constexpr double kMinExplained = 0.62;           // of the variance
// Added to that for a small pattern of which an arm is weaker than most are, times what it lacks:
// two doubts in one.
constexpr double kExplainedForWeakArm = 0.4;
constexpr double kStrongArm = 0.8;
// What is asked of the cross in a small ring: its worst arm, and more of it by the logarithm of the
// ring's axis ratio, less by that of what the image inside lacks of the print's correlation. The
// weights are those of a logistic regression over rings that passed all other tests.
constexpr double kCrossByFlatness = 0.25;
constexpr double kCrossByCorrelation = 0.22;
constexpr double kLeastCross = 0.97;
// Where shadows were taken out, which explain much by themselves.
constexpr double kMinExplainedInShadows = 0.75;
constexpr double kMinQualityInShadows = 0.84;
// Share of the variance below which shadows are looked for on a pattern that is found in even light
// as well: they bend the pose.
constexpr double kWellExplained = 0.85;
// Edges and contrasts of the ring that are where a circle has them: a frame of another shape has
// some of them.
constexpr double kMinRingShare = 0.85;
constexpr double kMinRingContrast = 5;  // gray values
// How near the centres of two rings are that are the same, of the shorter axis. A small ring fails
// its test where it lies half a stroke beside the print: as near it has to be to one that failed.
constexpr double kSameSign = 0.12;
constexpr double kSameStart = 0.05;
// How far from where a ring was seen its edges are looked for when there is no cross in it: where
// much of it is cut off or hidden, the rest tells little of its far side. Times the usual reach.
constexpr std::array<double, 2> kRefinedReaches{1.5, 2.5};
constexpr double kWhole = 0.75;  // share of the print in view that is no partial pattern
constexpr int kFitIterations = 8;

// Whether a place is one of others: its centre to a share of its shorter axis, and its edges within
// what was looked at there.
bool IsAmong(const RingPlace& place, const std::vector<RingPlace>& others, double same_center) {
  constexpr double kSameSize = 0.1;
  return std::any_of(others.begin(), others.end(), [&](const RingPlace& other) {
    return (place.center - other.center).norm() < same_center * place.diameters.y() &&
           ((place.diameters - other.diameters).array().abs() < kSameSize * place.diameters.array())
               .all() &&
           place.reach_px <= other.reach_px;
  });
}

// Remembers a place as long as there is room.
void Note(const RingPlace& place, std::vector<RingPlace>* places) {
  if (places->size() < places->capacity()) places->push_back(place);
}

// Whether nearly the same ring was tested before, as another pass saw it; notes it if not.
bool WasTested(const RingPlace& place, std::vector<RingPlace>* tested) {
  if (IsAmong(place, *tested, kSameStart)) return true;
  Note(place, tested);
  return false;
}

// Whether a fitted pose is still that of the ring it started from.
bool Agrees(const RigidTransform& start, const RigidTransform& fitted, double radius_m) {
  const double distance = start.translation.norm();
  return std::abs(fitted.translation.norm() - distance) < 0.25 * distance &&
         (fitted.translation.normalized() - start.translation / distance).norm() <
             0.4 * radius_m / distance;
}

bool HasOtherSpokes(const SmallPatternFitter::OtherSigns& others) {
  return others.spokes > kMaxOtherSpokes;
}

bool IsOtherSign(const SmallPatternFitter::OtherSigns& others) {
  return HasOtherSpokes(others) || others.frame_corners > kMaxFrameCorners ||
         others.cross_correlation < kMinCrossCorrelation ||
         others.board_darkness > kMaxBoardDarkness;
}

bool IsDoubtful(const SmallPatternFitter::OtherSigns& others) {
  return others.cross_correlation <
         kMinCrossCorrelation + kCrossForDarkBoard * std::max(0.0, others.board_darkness);
}

// Share of the print's contrast that the worst arm in view has, 0 to 1.
double WorstArm(const PatternMatch& match) {
  double worst = 1;
  for (const double arm : match.arm) {
    if (arm >= 0) worst = std::min(worst, arm);
  }
  return worst;
}

// Share of the variance that the fit of a small pattern has to explain.
double LeastExplained(const PatternMatch& match) {
  return kMinExplained + kExplainedForWeakArm * std::max(0.0, kStrongArm - WorstArm(match));
}

// Whether what is in a small ring is a cross. The flatter the ring is seen, the fewer pixels tell a
// cross from a letter or from other spokes.
bool HasCross(const SmallPatternFitter::Fit& fit, const Eigen::Vector2d& diameters_px) {
  const double lacking = std::max(0.001, 1 - fit.others.cross_correlation);
  return WorstArm(fit.match) + kCrossByFlatness * std::log(diameters_px.y() / diameters_px.x()) -
             kCrossByCorrelation * std::log(lacking) >=
         kLeastCross;
}

// What is asked of the quality of a small pattern beyond that of a near one: the fewer pixels, and
// the fewer across a ring that is seen from the side, the more a chance agrees with.
double SmallMargin(const Eigen::Vector2d& diameters_px) {
  const double size = std::sqrt(diameters_px.prod());
  return kSmallMargin * (std::clamp((36 - size) / 16, 0.0, 1.0) +
                         std::clamp((9 - diameters_px.y()) / 6, 0.0, 1.0));
}

}  // namespace

// Level of the pyramid at which a ring has about 40 to 80 pixels.
int LandingSearch::ViewLevel(double diameter_px) {
  return std::clamp(static_cast<int>(std::floor(std::log2(diameter_px / 40))), 0, 4);
}

// Which of the two poses of a ring the attitude allows; both when it is not known.
std::array<bool, 2> LandingSearch::LevelEnough(const RingFit& ring) const {
  std::array<bool, 2> allowed{true, true};
  if (!hint_.up_in_camera) return allowed;
  const double a = ring.poses[0].normal.dot(*hint_.up_in_camera);
  const double b = ring.poses[1].normal.dot(*hint_.up_in_camera);
  // The board is level to some degrees; where the two poses are that near, the image decides.
  if (std::abs(a - b) > 0.05) allowed[a > b ? 1 : 0] = false;
  return allowed;
}

void LandingSearch::TestRing(const RingFit& ring, const Eigen::Vector2d& diameters_px,
                             double reach_px) {
  std::optional<RingPlace> place = PlaceOf(ring.poses[0].center, diameters_px);
  if (!place || IsAmong(*place, buffers_.other_signs, kSameSign)) return;
  place->reach_px = reach_px;
  if (WasTested(*place, &buffers_.tested_large)) return;
  std::array<std::optional<Hypothesis>, 2> hypotheses;
  {
    StageTimer timer(&report_, LandingStage::kCross);
    Reach(LandingStage::kCross, "no cross inside of the ring");
    const std::array<bool, 2> allowed = LevelEnough(ring);
    for (int i = 0; i < 2; ++i) {
      if (allowed[i]) hypotheses[i] = TestPose(ring.poses[i], diameters_px.x());
    }
    for (const double farther : kRefinedReaches) {
      if (hypotheses[0] || hypotheses[1]) break;
      for (int i = 0; i < 2; ++i) {
        if (!allowed[i]) continue;
        constexpr int kIterations = 4;
        const std::optional<RigidTransform> refined =
            RefineRing(ring.poses[i], farther * reach_px, kIterations);
        if (refined) hypotheses[i] = TestRefinedPose(*refined, diameters_px.x());
      }
    }
  }
  if (hypotheses[0] && hypotheses[1]) {
    const double difference = hypotheses[0]->quality - hypotheses[1]->quality;
    if (std::abs(difference) > 0.1) hypotheses[difference > 0 ? 1 : 0].reset();
  }
  for (const auto& hypothesis : hypotheses) {
    if (hypothesis) Locate(*hypothesis, diameters_px, reach_px);
  }
}

std::optional<LandingSearch::VerifiedCross> LandingSearch::VerifyCross(const cv::Mat& image,
                                                                       const PatternView& view,
                                                                       double diameter_px) {
  const LandingPattern& pattern = models_.options.pattern;
  constexpr double kMinContrast = 6;
  const auto by_thinning = [&]() -> std::optional<Cross> {
    const auto inside = RectifyInside(image, view, pattern, 32, kMinContrast);
    return inside ? FindCrossByThinning(*inside) : std::nullopt;
  };
  const auto by_lines = [&]() -> std::optional<Cross> {
    const auto inside = RectifyInside(image, view, pattern, 64, kMinContrast);
    return inside ? FindCrossByLines(*inside, pattern, &buffers_.cross_lines) : std::nullopt;
  };
  // Where the lines of a large cross are broken, thinning stands in: on the rectified inside it is
  // not slow at any size.
  if (diameter_px > 150) {
    if (const auto cross = by_lines()) return VerifiedCross{*cross, CrossMethod::kLines};
  }
  if (const auto cross = by_thinning()) return VerifiedCross{*cross, CrossMethod::kThinning};
  return std::nullopt;
}

// The print whose ring lies as 'pose', turned by the cross inside; not compared with the image yet.
std::optional<LandingSearch::Hypothesis> LandingSearch::FindCross(const CirclePose& pose,
                                                                  double diameter_px) {
  const ImageRegion region{offset_, ViewLevel(diameter_px)};
  const cv::Mat image = buffers_.pyramid.ImageAt(region.level);
  const PatternView view(models_.camera, PatternPose(pose, 0), models_.matcher.extent_m(), region);
  if (!view.valid()) return std::nullopt;
  const double contrast = models_.matcher.RingContrast(image, view);
  if (contrast < kMinRingContrast) return std::nullopt;
  const std::optional<VerifiedCross> cross = VerifyCross(image, view, diameter_px);
  if (!cross) return std::nullopt;
  return Hypothesis{PatternPose(pose, cross->cross.arm_angle), cross->method, 0, contrast};
}

std::optional<LandingSearch::Hypothesis> LandingSearch::TestPose(const CirclePose& pose,
                                                                 double diameter_px) {
  const std::optional<Hypothesis> print = FindCross(pose, diameter_px);
  if (!print) return std::nullopt;
  return Compare(print->camera_from_pattern, print->method, diameter_px);
}

// Where the ring is cut off or broken, what is known of it says little about its far side: the
// edges of both of its circles bring it into place before its inside is looked at.
std::optional<RigidTransform> LandingSearch::RefineRing(const CirclePose& pose, double reach_px,
                                                        int iterations) {
  return models_.locator.LocateRing(image_, PatternPose(pose, 0), reach_px, kMinRingContrast / 2,
                                    iterations, level_);
}

std::optional<LandingSearch::Hypothesis> LandingSearch::TestRefinedPose(const RigidTransform& ring,
                                                                        double diameter_px) {
  const ImageRegion region{offset_, ViewLevel(diameter_px)};
  const cv::Mat image = buffers_.pyramid.ImageAt(region.level);
  const PatternView view(models_.camera, ring, models_.matcher.extent_m(), region);
  if (!view.valid() || models_.matcher.RingContrast(image, view) < kMinRingContrast) {
    return std::nullopt;
  }
  const std::optional<Cross> cross =
      FindCrossByProfile(image, view, models_.options.pattern, kMinRingContrast / 2);
  if (!cross) return std::nullopt;
  RigidTransform turned = ring;
  turned.rotation *=
      Eigen::Quaterniond(Eigen::AngleAxisd(cross->arm_angle, Eigen::Vector3d::UnitZ()));
  return Compare(turned, CrossMethod::kThinning, diameter_px);
}

std::optional<LandingSearch::Hypothesis> LandingSearch::Compare(const RigidTransform& pose,
                                                                CrossMethod method,
                                                                double diameter_px) {
  Reach(LandingStage::kMatch, "ring and cross do not look like the pattern");
  const ImageRegion region{offset_, ViewLevel(diameter_px)};
  const PatternView view(models_.camera, pose, models_.matcher.extent_m(), region);
  if (!view.valid()) return std::nullopt;
  const PatternMatch match = models_.matcher.Match(buffers_.pyramid.ImageAt(region.level), view);
  const double quality = match.Quality();
  if (quality < kWorthLocating * models_.options.min_quality) return std::nullopt;
  return Hypothesis{pose, method, quality, match.contrast};
}

// Direction of an arm of a small cross by its quadrants.
std::optional<double> LandingSearch::ArmAngleByQuadrants(const CirclePose& pose) {
  const LandingPattern& pattern = models_.options.pattern;
  const ImageRegion region{offset_, 0};
  const PatternView view(models_.camera, PatternPose(pose, 0), models_.matcher.extent_m(), region);
  if (!view.valid()) return std::nullopt;
  constexpr int kSize = 24;
  constexpr double kMinContrast = 6;
  const auto inside = RectifyInside(searched_, view, pattern, kSize, kMinContrast);
  if (!inside) return std::nullopt;
  const std::optional<Cross> cross = FindCrossByQuadrants(*inside);
  if (!cross) return std::nullopt;
  return cross->arm_angle;
}

// Where a ring is in the image; nothing when the lens does not show it.
std::optional<RingPlace> LandingSearch::PlaceOf(const Eigen::Vector3d& center,
                                                const Eigen::Vector2d& diameters_px) const {
  RingPlace place{Eigen::Vector2d::Zero(), diameters_px};
  if (models_.camera.Project(center, &place.center) == ProjectionStatus::kOutsideModel) {
    return std::nullopt;
  }
  return place;
}

// What the print does not explain is spread evenly where the print is: a sign with another figure
// in the ring leaves more inside, one in another frame more on the ring and around it. So few
// pixels tell less than the edges of a near pattern: more is asked of them.
bool LandingSearch::IsSmallPattern(const SmallPatternFitter::Fit& fit,
                                   const Eigen::Vector2d& diameters_px) const {
  const double on_print = std::max(fit.inside_residual, fit.ring_residual);
  constexpr double kTolerance = 0.75;  // of the size, which so few pixels hardly tell
  const RigidTransform& pose = fit.location.camera_from_pattern;
  const CirclePose ring{pose.translation, pose.rotation * Eigen::Vector3d::UnitZ()};
  const Eigen::Vector2d fitted_px = DiametersPx(ring);
  if (fitted_px.y() < kTolerance * models_.options.min_ring_px) return false;
  return fit.match.Quality() >= models_.options.min_quality + SmallMargin(diameters_px) &&
         fit.correlation >= kMinFittedCorrelation && fit.explained >= LeastExplained(fit.match) &&
         fit.inside_residual - fit.ring_residual <= kMaxMoreInside &&
         fit.ring_residual - fit.inside_residual <= kMaxMoreOnRing &&
         fit.white_residual <= on_print + kMaxMoreOutside && !IsOtherSign(fit.others) &&
         fit.others.spokes <= kMaxOtherSpokesOfSmall && !IsDoubtful(fit.others) &&
         HasCross(fit, fitted_px);
}

// The best start for a small pattern whose ring lies as 'pose'; its correlation is -1 when there is
// none.
SmallPatternFitter::Start LandingSearch::FindStart(const CirclePose& pose,
                                                   std::span<const double> scales) {
  const std::optional<double> scale =
      models_.small.FindScale(image_, pose, scales, &buffers_.small);
  if (!scale) return {{}, -1};
  if (const std::optional<double> angle = ArmAngleByQuadrants(pose)) {
    auto start = models_.small.FindStart(pose, *scale, {&*angle, 1}, &buffers_.small);
    if (start.correlation >= kSureCorrelation) return start;
  }
  // Within 7.5 degrees of every direction.
  constexpr double kStep = std::numbers::pi / 12;
  constexpr std::array<double, 6> kTurns{0, kStep, 2 * kStep, 3 * kStep, 4 * kStep, 5 * kStep};
  return models_.small.FindStart(pose, *scale, kTurns, &buffers_.small);
}

// Rings whose strokes are no wider than the blur: the print is fitted as a whole. The ring may be
// smaller than it was seen by the given factors.
void LandingSearch::TestSmallRing(const RingFit& ring, const Eigen::Vector2d& diameters_px,
                                  std::span<const double> scales) {
  if (IsTooSmall(diameters_px)) return;
  StageTimer timer(&report_, LandingStage::kCross);
  Reach(LandingStage::kCross, "no cross inside of the ring");
  const std::optional<RingPlace> place = PlaceOf(ring.poses[0].center, diameters_px);
  if (!place || WasTested(*place, &buffers_.tested_small)) return;
  const std::array<bool, 2> allowed = LevelEnough(ring);
  for (int i = 0; i < 2; ++i) {
    if (!allowed[i]) continue;
    // The two poses of a small ring look much the same: what does not fit one fits neither.
    if (!TestSmallPose(ring.poses[i], diameters_px, scales)) return;
  }
}

// Whether too little is left of a ring, or it is seen along its plane.
bool LandingSearch::IsTooSmall(const Eigen::Vector2d& diameters_px) const {
  return diameters_px.x() < kMinMajorPx || diameters_px.y() < 0.7 * models_.options.min_ring_px ||
         diameters_px.y() < kMinAxisRatio * diameters_px.x();
}

// Keeps the pattern if there is one; false when there is none under the ring's other pose either.
bool LandingSearch::TestSmallPose(const CirclePose& pose, const Eigen::Vector2d& diameters_px,
                                  std::span<const double> scales) {
  const SmallPatternFitter::Start start = FindStart(pose, scales);
  if (start.correlation < kMinCorrelation) return false;
  Reach(LandingStage::kMatch, "ring and cross do not look like the pattern");
  auto fit =
      models_.small.Refine(image_, start.camera_from_pattern, SmallPatternFitter::Light::kEven,
                           kFitIterations, &buffers_.small, level_);
  if (!fit || fit->correlation < kMinCorrelationOfEither) return false;
  if (!Agrees(start.camera_from_pattern, fit->location.camera_from_pattern,
              models_.options.pattern.outer_radius_m())) {
    return true;
  }
  Reach(LandingStage::kLocate, "no pose explains the edges of ring and cross");
  const bool is_found = IsSmallPattern(*fit, diameters_px);
  if (!is_found || fit->explained < kWellExplained) {
    const auto evened = FitInShadows(fit->location.camera_from_pattern, diameters_px);
    if (!is_found && !evened) return true;
    if (evened) fit = evened;
  }
  Keep(fit->location, fit->match.seen < kWhole ? CrossMethod::kPartial : CrossMethod::kQuadrants,
       fit->match.Quality(), diameters_px);
  return true;
}

// A small pattern near to 'pose' once the shadows on it are taken out, if there is one.
std::optional<SmallPatternFitter::Fit> LandingSearch::FitInShadows(
    const RigidTransform& pose, const Eigen::Vector2d& diameters_px) {
  auto fit = models_.small.Refine(image_, pose, SmallPatternFitter::Light::kShadows, kFitIterations,
                                  &buffers_.small, level_);
  // Of a print that is cut off too little is left to tell ink from light.
  if (!fit || fit->match.seen < kWhole || fit->explained < kMinExplainedInShadows ||
      fit->match.Quality() < kMinQualityInShadows || !IsSmallPattern(*fit, diameters_px)) {
    return std::nullopt;
  }
  return fit;
}

// Whether there is another sign where a pattern was located, in even light and without the shadows
// on it. Where every part of the print was seen next to its own white, gray values that do not fit
// the whole tell of the light alone.
bool LandingSearch::ShowsOtherSign(const RigidTransform& pose, double quality) {
  using Light = SmallPatternFitter::Light;
  const auto is_other = quality >= kEveryPart ? HasOtherSpokes : IsOtherSign;
  const auto in_even = models_.small.Inspect(image_, pose, Light::kEven, &buffers_.small);
  if (!in_even || !is_other(*in_even)) return false;
  const auto evened = models_.small.Inspect(image_, pose, Light::kShadows, &buffers_.small);
  return !evened || is_other(*evened);
}

void LandingSearch::Locate(const Hypothesis& hypothesis, const Eigen::Vector2d& diameters_px,
                           double reach_px) {
  StageTimer timer(&report_, LandingStage::kLocate);
  Reach(LandingStage::kLocate, "no pose explains the edges of ring and cross");
  constexpr int kIterations = 3;
  const std::optional<PatternLocation> location =
      models_.locator.Locate(image_, hypothesis.camera_from_pattern, reach_px,
                             std::max(2.0, 0.12 * hypothesis.contrast), kIterations, level_);
  if (!location) return;
  const double mean_axis_px = std::sqrt(diameters_px.prod());
  if (location->edge_rms_px > std::min(kMaxEdgeRmsPx, kMaxEdgeRms * mean_axis_px)) return;
  const ImageRegion region{offset_, ViewLevel(diameters_px.x())};
  const PatternView view(models_.camera, location->camera_from_pattern, models_.matcher.extent_m(),
                         region);
  if (!view.valid()) return;
  PatternMatch match = models_.matcher.Match(buffers_.pyramid.ImageAt(region.level), view);
  const auto combine = [](std::array<double, 4>* shares, const std::array<double, 4>& edges) {
    for (int k = 0; k < 4; ++k) {
      if ((*shares)[k] >= 0 && edges[k] >= 0) (*shares)[k] = 0.5 * ((*shares)[k] + edges[k]);
    }
  };
  combine(&match.arm, location->arm_share);
  combine(&match.ring, location->ring_share);
  const double quality = match.Quality();
  if (quality < models_.options.min_quality || match.RingShare() < kMinRingShare) return;
  if (mean_axis_px < kInspectedRingPx && ShowsOtherSign(location->camera_from_pattern, quality)) {
    const auto place = PlaceOf(location->camera_from_pattern.translation, diameters_px);
    if (place) Note(*place, &buffers_.other_signs);
    return;
  }
  Keep(*location, match.seen < kWhole ? CrossMethod::kPartial : hypothesis.method, quality,
       diameters_px);
}

}  // namespace kestrel
