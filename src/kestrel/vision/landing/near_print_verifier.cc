// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/landing/near_print_verifier.h"

#include <algorithm>
#include <cmath>

#include "kestrel/vision/landing/gray_doubts.h"
#include "kestrel/vision/landing/pattern_pose.h"

namespace kestrel {
namespace {

constexpr double kMinRingContrast = 5;    // gray values
constexpr double kMinInsideContrast = 6;  // gray values
constexpr double kLinesRingPx = 150;      // larger than that is looked at by lines first (2.4)
// Agreement from which a pose is worth locating: one that lies beside the print may miss an arm,
// and be brought to it by the edges.
constexpr double kWorthLocating = 0.4;
// How near the centres of two rings are that are the same, of the shorter axis: where one was
// tested, and where one was seen to be something else.
constexpr double kSameStart = 0.05;
constexpr double kSameSign = 0.12;
// How far from where a ring was seen its edges are looked for when there is no cross in it: where
// much of it is cut off or hidden, the rest tells little of its far side. Times the usual reach.
constexpr std::array<double, 2> kRefinedReaches{1.5, 2.5};
constexpr int kRefinements = 4;
constexpr double kPredictedReach = 0.12;  // of the diameter, of a predicted ring
constexpr double kSureReach = 0.02;       // the same of one whose edges are in place
constexpr double kCrossReach = 0.03;      // the same of a ring that the cross says
constexpr double kLeastReachPx = 2;
constexpr double kMinStep = 0.12;  // of an edge, of the print's contrast per pixel
constexpr double kLeastStep = 2;   // the same, gray values per pixel
constexpr double kWhole = 0.75;    // share of the print in view that is no part
// The middle of a print is where the edges around it have it, where the pose has it elsewhere by
// more than chance: standard deviations.
constexpr double kSureCenter = 4;

// Level of the pyramid at which a ring has about 40 to 80 pixels.
int ViewLevel(double diameter_px) {
  return std::clamp(static_cast<int>(std::floor(std::log2(diameter_px / 40))), 0, 4);
}

// Where the image has the middle of the print: where the pose has it and, as far as that is more
// than chance (James and Stein's estimate), where the edges around it do.
Eigen::Vector2d CenterPx(const PatternLocation& location, const PrintAlignment& alignment) {
  Eigen::Vector2d by_edges;
  if (!alignment.warp.Project(Eigen::Vector2d::Zero(), &by_edges)) return location.center_px;
  const Eigen::Vector2d shift = by_edges - location.center_px;
  const double chance = kSureCenter * alignment.center_sigma_px;
  const double more = 1 - chance * chance / std::max(shift.squaredNorm(), 1e-12);
  return location.center_px + std::max(0.0, more) * shift;
}

double MeanDiameter(const PrintFinding& finding) { return std::sqrt(finding.diameters_px.prod()); }

double LogShare(double length_px, double of_px) {
  constexpr double kLeast = 1e-4;
  return std::log(std::max(kLeast, length_px / of_px));
}

}  // namespace

void NearPrintBuffers::Reserve() {
  cross_lines.Reserve();
  tested.Reserve();
  refused.Reserve();
}

NearPrintVerifier::NearPrintVerifier(const LandingModels& models, const PriorKnowledge& prior,
                                     SearchedImage* image, NearPrintBuffers* buffers,
                                     DetectionChoice* choice, SearchLog* log)
    : models_(models),
      prior_(prior),
      image_(*image),
      buffers_(*buffers),
      choice_(*choice),
      log_(*log) {}

void NearPrintVerifier::Test(const RingCandidate& ring) {
  RingPlace place{{}, ring.diameters_px, ring.reach_px};
  if (models_.camera.Project(ring.poses[0].center, &place.center_px) ==
          ProjectionStatus::kOutsideModel ||
      buffers_.refused.Holds(place, kSameSign) || buffers_.tested.Holds(place, kSameStart)) {
    return;
  }
  buffers_.tested.Note(place);
  log_.Reach(LandingStage::kCross, "no cross inside of the ring");
  const PriorKnowledge::Order order = prior_.OrderOf(ring.poses);
  const double diameter_px = ring.diameters_px.x();
  bool has_cross = false;
  for (const int pose : order.poses) {
    std::optional<Hypothesis> print = FindCross(ring.poses[pose], diameter_px);
    if (print) print = Compare(print->camera_from_pattern, print->method, diameter_px);
    has_cross |= print.has_value();
    if (print && TestPrint(*print, ring.diameters_px, ring.reach_px, ring.poses, order)) return;
  }
  for (const double farther : kRefinedReaches) {
    if (has_cross) return;
    bool is_whole = false;
    for (const int pose : order.poses) {
      const auto refined = RefineRing(ring.poses[pose], farther * ring.reach_px, kRefinements);
      if (!refined) continue;
      is_whole |= refined->is_whole;
      const std::optional<Hypothesis> print =
          FindCrossInRefined(refined->camera_from_pattern, diameter_px);
      has_cross |= print.has_value();
      if (print && TestPrint(*print, ring.diameters_px, ring.reach_px, ring.poses, order)) return;
    }
    // Once all of a ring is in its place and shows no cross, nothing else shows one.
    if (is_whole && !has_cross) {
      place.reach_px *= kRefinedReaches.back();
      buffers_.refused.Note(place);
      return;
    }
  }
}

void NearPrintVerifier::TestPredicted(const CirclePose& predicted,
                                      const Eigen::Vector2d& predicted_px) {
  constexpr int kIterations = 3;
  const auto refined = RefineRing(predicted, kPredictedReach * predicted_px.x(), kIterations);
  if (!refined) return;
  const RigidTransform& pose = refined->camera_from_pattern;
  const CirclePose ring{pose.translation, pose.rotation * Eigen::Vector3d::UnitZ()};
  const Eigen::Vector2d diameters_px =
      RingDiametersPx(models_.camera, models_.options.pattern.outer_radius_m(), ring);
  if (IsSmallRing(diameters_px)) return;
  image_.Prepare(ViewLevel(diameters_px.x()));
  const std::optional<Hypothesis> print = FindCross(ring, diameters_px.x());
  if (!print) return;
  const double reach_px = std::max(kLeastReachPx, kSureReach * diameters_px.x());
  TestPrint(*print, diameters_px, reach_px, {&ring, 1}, {});
}

void NearPrintVerifier::TestCross(const RigidTransform& pose, const ImageRegion& region) {
  log_.Reach(LandingStage::kCross, "lines of a cross without the pattern around them");
  const double angle =
      std::atan2(models_.options.pattern.outer_radius_m(), pose.translation.norm());
  const double diameter_px = 2 * models_.camera.intrinsics().fx_px * angle;
  const std::optional<Hypothesis> print = Compare(pose, CrossMethod::kPartial, diameter_px);
  if (!print) return;
  const double reach_px = std::max(kLeastReachPx, region.scale() + kCrossReach * diameter_px);
  const CirclePose ring{pose.translation, pose.rotation * Eigen::Vector3d::UnitZ()};
  TestPrint(*print, Eigen::Vector2d::Constant(diameter_px), reach_px, {&ring, 1}, {});
}

// The print whose ring lies as 'ring', turned by the cross inside; not compared with the image yet.
std::optional<NearPrintVerifier::Hypothesis> NearPrintVerifier::FindCross(const CirclePose& ring,
                                                                          double diameter_px) {
  constexpr int kThinningSize = 32, kLinesSize = 64;
  const SearchLog::Timer timer = log_.Time(LandingStage::kCross);
  const LandingPattern& pattern = models_.options.pattern;
  const ImageRegion region = image_.RegionAt(ViewLevel(diameter_px));
  const cv::Mat image = image_.At(region.level);
  const PatternView view(models_.camera, PatternPose(ring, 0), models_.matcher.extent_m(), region);
  if (!view.valid()) return std::nullopt;
  const double contrast = models_.matcher.RingContrast(image, view);
  if (contrast < kMinRingContrast) return std::nullopt;
  const auto print = [&](const Cross& cross, CrossMethod method) {
    return Hypothesis{PatternPose(ring, cross.arm_angle), method, contrast};
  };
  // Where the lines of a large cross are broken, thinning stands in: on the rectified inside it is
  // not slow at any size.
  if (diameter_px > kLinesRingPx) {
    const auto inside = RectifyInside(image, view, pattern, kLinesSize, kMinInsideContrast);
    const auto cross =
        inside ? FindCrossByLines(*inside, pattern, &buffers_.cross_lines) : std::nullopt;
    if (cross) return print(*cross, CrossMethod::kLines);
  }
  const auto inside = RectifyInside(image, view, pattern, kThinningSize, kMinInsideContrast);
  const auto cross = inside ? FindCrossByThinning(*inside) : std::nullopt;
  if (cross) return print(*cross, CrossMethod::kThinning);
  return std::nullopt;
}

// Where the ring is cut off or broken, what is known of it says little about its far side: the
// edges of both of its circles bring it into place before its inside is looked at.
std::optional<RingLocation> NearPrintVerifier::RefineRing(const CirclePose& ring, double reach_px,
                                                          int iterations) {
  const SearchLog::Timer timer = log_.Time(LandingStage::kRing);
  return models_.locator.LocateRing(image_.whole(), PatternPose(ring, 0), reach_px,
                                    kMinRingContrast / 2, iterations,
                                    prior_.LevelPrior(ring.normal));
}

std::optional<NearPrintVerifier::Hypothesis> NearPrintVerifier::FindCrossInRefined(
    const RigidTransform& ring, double diameter_px) {
  const SearchLog::Timer timer = log_.Time(LandingStage::kCross);
  const ImageRegion region = image_.RegionAt(ViewLevel(diameter_px));
  const cv::Mat image = image_.At(region.level);
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

// What is not at all like the print is not worth locating.
std::optional<NearPrintVerifier::Hypothesis> NearPrintVerifier::Compare(const RigidTransform& pose,
                                                                        CrossMethod method,
                                                                        double diameter_px) {
  const SearchLog::Timer timer = log_.Time(LandingStage::kMatch);
  log_.Reach(LandingStage::kMatch, "ring and cross do not look like the pattern");
  const ImageRegion region = image_.RegionAt(ViewLevel(diameter_px));
  const PatternView view(models_.camera, pose, models_.matcher.extent_m(), region);
  if (!view.valid()) return std::nullopt;
  const PatternMatch match = models_.matcher.Match(image_.At(region.level), view);
  if (match.Agreement() < kWorthLocating) return std::nullopt;
  return Hypothesis{pose, method, match.contrast};
}

// Whether the print is the pattern: whether it looks so is a question to the image, where it is one
// to the lens.
bool NearPrintVerifier::TestPrint(const Hypothesis& print, const Eigen::Vector2d& diameters_px,
                                  double reach_px, std::span<const CirclePose> rings,
                                  const PriorKnowledge::Order& order) {
  const SearchLog::Timer timer = log_.Time(LandingStage::kLocate);
  log_.Reach(LandingStage::kLocate, "ring and cross have too few edges");
  const ImageRegion region = image_.RegionAt(ViewLevel(diameters_px.x()));
  const cv::Mat image = image_.At(region.level);
  PrintAlignment alignment{
      PlaneWarp(models_.camera, print.camera_from_pattern, models_.locator.outline().radius_m()),
      {}};
  const double min_step = std::max(kLeastStep, kMinStep * print.contrast);
  if (!AlignPrint(image_.whole(), image, region, models_.locator.outline().all(), reach_px,
                  min_step, &alignment)) {
    return false;
  }
  const PatternView view(alignment.warp, models_.ink.extent_m(), region);
  if (!view.valid()) return false;
  PrintFinding finding;
  finding.diameters_px = diameters_px;
  const double seen = models_.ink.Doubt(image, view, &finding.doubts);
  finding.kind = seen < kWhole ? PrintKind::kPart : PrintKind::kByEdges;
  finding.method = seen < kWhole ? CrossMethod::kPartial : print.method;
  finding.doubts[PrintDoubt::kHidden] = 1 - seen;
  DoubtEdges(alignment, &finding);
  bool is_found = false;
  for (std::size_t i = 0; i < rings.size(); ++i) {
    if (!choice_.MayAccept(finding.kind, finding.doubts)) break;
    if (is_found && order.one_is_right) break;
    const CirclePose& ring = rings[order.poses[i]];
    is_found |= Locate(alignment, WithArmOf(alignment, ring), finding);
  }
  if (!is_found) Refuse(finding, alignment, reach_px);
  return is_found;
}

// The print whose ring lies as 'ring', turned as it is in the image.
RigidTransform NearPrintVerifier::WithArmOf(const PrintAlignment& alignment,
                                            const CirclePose& ring) const {
  RigidTransform pose = PatternPose(ring, 0);
  Eigen::Vector2d pixel;
  Eigen::Vector3d ray;
  if (!alignment.warp.Project({models_.options.pattern.arm_half_length_m, 0}, &pixel) ||
      models_.camera.Unproject(pixel, &ray) == ProjectionStatus::kOutsideModel) {
    return alignment.warp.pose();
  }
  const double distance = ring.normal.dot(ring.center) / ring.normal.dot(ray);
  const Eigen::Vector3d arm = pose.rotation.conjugate() * (distance * ray - ring.center);
  return PatternPose(ring, std::atan2(arm.y(), arm.x()));
}

// Whether the print, located near 'initial', is the pattern.
bool NearPrintVerifier::Locate(const PrintAlignment& alignment, const RigidTransform& initial,
                               PrintFinding finding) {
  const Eigen::Vector3d normal = initial.rotation * Eigen::Vector3d::UnitZ();
  const std::optional<PatternLocation> location =
      models_.locator.Locate(alignment.edges, initial, prior_.LevelPrior(normal));
  if (!location) return false;
  finding.location = *location;
  finding.seen = {alignment.warp.pose(), alignment.warp.displacement()};
  finding.seen_rms_px = alignment.edge_rms_px;
  finding.center_px = CenterPx(*location, alignment);
  finding.doubts[PrintDoubt::kMisfit] = LogShare(location->edge_rms_px, MeanDiameter(finding));
  DoubtView(finding.diameters_px, finding.relative_sigma(), &finding.doubts);
  finding.log_odds = PrintLogOdds(finding.kind, finding.doubts);
  finding.told = prior_.LogOddsOfDistance(location->camera_from_pattern.translation);
  return choice_.Add(finding);
}

// Notes that a ring whose edges were found is something else.
void NearPrintVerifier::Refuse(const PrintFinding& finding, const PrintAlignment& alignment,
                               double reach_px) {
  log_.Reach(LandingStage::kLocate, MainDoubt(finding.kind, finding.doubts));
  RingPlace place{{}, finding.diameters_px, reach_px};
  if (alignment.warp.Project(Eigen::Vector2d::Zero(), &place.center_px)) {
    buffers_.refused.Note(place);
  }
}

void NearPrintVerifier::DoubtEdges(const PrintAlignment& alignment, PrintFinding* finding) {
  const PartShares edge_shares = alignment.EdgeShares();
  const PartShares::Means edges = edge_shares.MeansInView();
  const bool shows_arms = *std::max_element(edge_shares.arm.begin(), edge_shares.arm.end()) >= 0;
  finding->doubts[PrintDoubt::kArmEdges] = shows_arms ? 1 - edges.arms : 0;
  finding->doubts[PrintDoubt::kWorstArmEdges] = shows_arms ? 1 - edges.worst_arm : 0;
  finding->doubts[PrintDoubt::kScatter] = LogShare(alignment.edge_rms_px, MeanDiameter(*finding));
}

}  // namespace kestrel
