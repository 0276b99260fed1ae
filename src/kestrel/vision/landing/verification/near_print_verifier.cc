// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/landing/verification/near_print_verifier.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "kestrel/vision/landing/image_properties.h"
#include "kestrel/vision/landing/location/pattern_pose.h"
#include "kestrel/vision/landing/print_places.h"
#include "kestrel/vision/landing/score/gray_doubts.h"
#include "kestrel/vision/landing/verification/cross.h"

namespace kestrel {
namespace {

// Least contrast of the arms of a print that is aligned, as a share of the ring's. A pose beside
// the print, or a shadow, may take the rest.
constexpr double kLeastArms = 0.2;
// Distance of the centres of two rings that count as the same where one was seen to be something
// else, as a share of the shorter axis.
constexpr double kSameSign = 0.12;
// Search reach for the edges of a ring without a cross, times the usual reach. Where much of the
// ring is cut off or hidden, the rest hardly constrains its far side.
constexpr std::array<double, 2> kRefinedReaches{1.5, 2.5};
constexpr int kRefinements = 4;
constexpr double kPredictedReach = 0.12;  // share of the diameter, for a predicted ring
constexpr double kCrossReach = 0.03;      // the same, for a ring that follows from the cross
constexpr double kMinStep = 0.12;  // least step of an edge, share of the print's contrast per pixel
// Shifts of a print's middle, as seen by its edges, that count as noise: below this many standard
// deviations of that middle the pose's projection is kept, above it the middle moves towards the
// edges.
constexpr double kSureCenter = 4;

// Returns the level of the pyramid at which a ring is about 40 to 80 pixels wide.
int ViewLevel(double diameter_px) {
  return std::clamp(static_cast<int>(std::floor(std::log2(diameter_px / 40))), 0, 4);
}

// Returns the image of the middle of the print: where the pose has it, moved towards where the
// edges around it have it as far as the difference exceeds chance (James-Stein estimator).
Eigen::Vector2d CenterPx(const PatternLocation& location, const PrintAlignment& alignment) {
  Eigen::Vector2d by_edges;
  if (!alignment.warp.Project(Eigen::Vector2d::Zero(), &by_edges)) return location.center_px;
  const Eigen::Vector2d shift = by_edges - location.center_px;
  const double chance = kSureCenter * alignment.center_sigma_px;
  const double more =
      1 - chance * chance / std::max(shift.squaredNorm(), std::numeric_limits<double>::min());
  return location.center_px + std::max(0.0, more) * shift;
}

double MeanDiameter(const PrintFinding& finding) { return std::sqrt(finding.diameters_px.prod()); }

RigidTransform Turned(const RigidTransform& pose, double angle) {
  const Eigen::Quaterniond turn(Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ()));
  return {pose.rotation * turn, pose.translation};
}

}  // namespace

void NearPrintBuffers::Reserve() {
  tested.Reserve();
  refused.Reserve();
}

void NearPrintVerifier::Test(const RingCandidate& ring) {
  RingPlace place{{}, ring.diameters_px, ring.reach_px};
  if (search_.models.camera.Project(ring.poses[0].center, &place.center_px) ==
          ProjectionStatus::kOutsideModel ||
      buffers_.refused.Holds(place, kSameSign) ||
      buffers_.tested.Holds(place, RingMemory::kSameStart)) {
    return;
  }
  buffers_.tested.Note(place);
  search_.log.Reach(LandingStage::kCross, "no cross inside of the ring");
  const PriorKnowledge::Order order = search_.prior.OrderOf(ring.poses);
  const double diameter_px = ring.diameters_px.x();
  bool has_cross = false, is_doubtful = false;
  for (const int pose : order.poses) {
    const auto print = FindCross(PatternPose(ring.poses[pose], 0), diameter_px);
    has_cross |= print.has_value();
    if (!print || !TestPrint(*print, ring.diameters_px, ring.reach_px, ring.poses, order)) continue;
    if (search_.choice.IsClear()) return;
    is_doubtful = true;
  }
  for (const double farther : kRefinedReaches) {
    if (has_cross && !is_doubtful) return;
    bool is_whole = false;
    for (const int pose : order.poses) {
      const auto refined = RefineRing(ring.poses[pose], farther * ring.reach_px, kRefinements);
      if (!refined) continue;
      is_whole |= refined->is_whole;
      const auto print = FindCross(refined->camera_from_target, diameter_px);
      has_cross |= print.has_value();
      if (print && TestPrint(*print, ring.diameters_px, ring.reach_px, ring.poses, order)) return;
    }
    // When nearly the whole ring is in place and shows no cross, a wider search shows none either.
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
  const RigidTransform& pose = refined->camera_from_target;
  const CirclePose ring{pose.translation, pose.rotation * Eigen::Vector3d::UnitZ()};
  const Eigen::Vector2d diameters_px =
      RingDiametersPx(search_.models.camera, search_.models.options.pattern.outer_radius_m(), ring);
  if (IsSmallRing(diameters_px)) return;
  search_.image.Prepare(ViewLevel(diameters_px.x()));
  const std::optional<Hypothesis> print = FindCross(pose, diameters_px.x());
  if (!print) return;
  const double reach_px = std::max(RingReach::kLeastPx, RingReach::kSure * diameters_px.x());
  TestPrint(*print, diameters_px, reach_px, {&ring, 1}, {});
}

void NearPrintVerifier::TestCross(const RigidTransform& pose, const ImageRegion& region) {
  search_.log.Reach(LandingStage::kCross, "lines of a cross without the pattern around them");
  const double angle =
      std::atan2(search_.models.options.pattern.outer_radius_m(), pose.translation.norm());
  const double diameter_px = 2 * search_.models.camera.intrinsics().fx_px * angle;
  const PatternView view(search_.models.camera, pose, search_.models.ring_probe.extent_m(), region);
  if (!view.valid()) return;
  const auto arms = FindArms(search_.image.At(region.level), view, search_.models.options.pattern);
  if (!arms || arms->contrast < GrayContrast::kLeastRing) return;
  const double reach_px = std::max(RingReach::kLeastPx, region.scale() + kCrossReach * diameter_px);
  const CirclePose ring{pose.translation, pose.rotation * Eigen::Vector3d::UnitZ()};
  TestPrint({Turned(pose, arms->angle), arms->contrast}, Eigen::Vector2d::Constant(diameter_px),
            reach_px, {&ring, 1}, {});
}

// Returns the print whose ring lies as that of 'ring', turned as the cross inside, if it has arms.
std::optional<NearPrintVerifier::Hypothesis> NearPrintVerifier::FindCross(
    const RigidTransform& ring, double diameter_px) {
  const SearchLog::Timer timer = search_.log.Time(LandingStage::kCross);
  const ImageRegion region = search_.image.RegionAt(ViewLevel(diameter_px));
  const cv::Mat image = search_.image.At(region.level);
  const RingProbe& probe = search_.models.ring_probe;
  const PatternView view(search_.models.camera, ring, probe.extent_m(), region);
  if (!view.valid()) return std::nullopt;
  const double contrast = probe.Contrast(image, view);
  if (contrast < GrayContrast::kLeastRing) return std::nullopt;
  const auto arms = FindArms(image, view, search_.models.options.pattern);
  if (!arms || arms->contrast < kLeastArms * contrast) return std::nullopt;
  return Hypothesis{Turned(ring, arms->angle), contrast};
}

// Fits a ring to the edges of both of its circles before its inside is examined: where the ring is
// cut off or broken, its first estimate hardly constrains the far side.
std::optional<RingLocation> NearPrintVerifier::RefineRing(const CirclePose& ring, double reach_px,
                                                          int iterations) {
  const SearchLog::Timer timer = search_.log.Time(LandingStage::kRing);
  return search_.models.locator.LocateRing(search_.image.whole(), PatternPose(ring, 0), reach_px,
                                           GrayContrast::kLeastRing / 2, iterations,
                                           search_.prior.LevelPrior(ring.normal));
}

// True when the print is accepted as the pattern. Whether it looks like the pattern is decided by
// the image alone; the lens decides only where it is.
bool NearPrintVerifier::TestPrint(const Hypothesis& print, const Eigen::Vector2d& diameters_px,
                                  double reach_px, std::span<const CirclePose> rings,
                                  const PriorKnowledge::Order& order) {
  const SearchLog::Timer timer = search_.log.Time(LandingStage::kLocate);
  search_.log.Reach(LandingStage::kMatch, "ring and cross have too few edges");
  const ImageRegion region = search_.image.RegionAt(ViewLevel(diameters_px.x()));
  const cv::Mat image = search_.image.At(region.level);
  PrintAlignment alignment{PlaneWarp(search_.models.camera, print.camera_from_target,
                                     search_.models.locator.outline().radius_m()),
                           {}};
  const double min_step = std::max<double>(GrayContrast::kLeast, kMinStep * print.contrast);
  if (!AlignPrint(search_.image.whole(), image, region, search_.models.locator.outline().all(),
                  reach_px, min_step, &alignment)) {
    return false;
  }
  search_.log.Reach(LandingStage::kLocate, "no pose explains the edges");
  const PatternView view(alignment.warp, search_.models.ink.extent_m(), region);
  if (!view.valid()) return false;
  PrintFinding finding;
  finding.diameters_px = diameters_px;
  const double seen = search_.models.ink.Doubt(image, view, &finding.doubts);
  finding.kind = seen < PrintPlaces::kWhole ? PrintKind::kPart : PrintKind::kByEdges;
  finding.method = seen < PrintPlaces::kWhole ? DetectionMethod::kPartial : DetectionMethod::kRing;
  finding.doubts[PrintDoubt::kHidden] = 1 - seen;
  DoubtEdges(alignment, &finding);
  bool is_found = false;
  for (std::size_t i = 0; i < rings.size(); ++i) {
    if (!search_.choice.MayAccept(finding.kind, finding.doubts)) break;
    if (is_found && order.one_is_right) break;
    const CirclePose& ring = rings[order.poses[i]];
    is_found |= Locate(alignment, WithArmOf(alignment, ring), finding);
  }
  if (!is_found) Refuse(finding, alignment, reach_px);
  return is_found;
}

// Returns the print whose ring lies as 'ring', turned so that its arm points as in the image.
RigidTransform NearPrintVerifier::WithArmOf(const PrintAlignment& alignment,
                                            const CirclePose& ring) const {
  RigidTransform pose = PatternPose(ring, 0);
  Eigen::Vector2d pixel;
  Eigen::Vector3d ray;
  if (!alignment.warp.Project({search_.models.options.pattern.arm_half_length_m, 0}, &pixel) ||
      search_.models.camera.Unproject(pixel, &ray) == ProjectionStatus::kOutsideModel) {
    return alignment.warp.pose();
  }
  const double distance = ring.normal.dot(ring.center) / ring.normal.dot(ray);
  const Eigen::Vector3d arm = pose.rotation.conjugate() * (distance * ray - ring.center);
  return PatternPose(ring, std::atan2(arm.y(), arm.x()));
}

// Locates the print near 'initial'. True when it is accepted as the pattern.
bool NearPrintVerifier::Locate(const PrintAlignment& alignment, const RigidTransform& initial,
                               PrintFinding finding) {
  const Eigen::Vector3d normal = initial.rotation * Eigen::Vector3d::UnitZ();
  const std::optional<PatternLocation> location =
      search_.models.locator.Locate(alignment.edges, initial, search_.prior.LevelPrior(normal));
  if (!location) return false;
  finding.location = *location;
  finding.seen = {alignment.warp.pose(), alignment.warp.displacement(), alignment.warp.radius_m()};
  finding.seen_rms_px = alignment.edge_rms_px;
  finding.center_px = CenterPx(*location, alignment);
  finding.doubts[PrintDoubt::kMisfit] = LogShare(location->edge_rms_px / MeanDiameter(finding));
  DoubtView(finding.diameters_px, finding.relative_sigma(), &finding.doubts);
  finding.log_odds = PrintLogOdds(finding.kind, finding.doubts);
  finding.by_hint = search_.prior.LogOddsOfDistance(location->camera_from_target.translation);
  return search_.choice.Add(finding);
}

// Records that a ring whose edges were found is something else.
void NearPrintVerifier::Refuse(const PrintFinding& finding, const PrintAlignment& alignment,
                               double reach_px) {
  search_.log.Reach(LandingStage::kLocate, MainDoubt(finding.kind, finding.doubts));
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
  finding->doubts[PrintDoubt::kScatter] = LogShare(alignment.edge_rms_px / MeanDiameter(*finding));
}

}  // namespace kestrel
