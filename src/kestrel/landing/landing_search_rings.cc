// SPDX-License-Identifier: BSD-3-Clause
// How the search of an image comes to rings: closed dark areas, the white board, arcs, the
// cross alone.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "kestrel/landing/landing_search.h"
#include "kestrel/landing/pattern_pose.h"

namespace kestrel {
namespace {

constexpr double kToleranceRingPx = 3.5;  // paper, section 2.3
// Axes (diameters) below which a stroke is hardly wider than the blur, everywhere or somewhere.
constexpr double kSmallRingPx = 30;
constexpr double kThinRingPx = 13;
constexpr double kMaxBoardRingPx = 50;  // major axis of a ring that the board shows
// Candidates of a pass that are looked at, those of the highest contrast: a bound of the time that
// a frame full of texture costs.
constexpr std::size_t kMaxCandidates = 4;
// Borders at full resolution that are cut into arcs: of texture so fine any number bend like rings.
constexpr std::size_t kMaxArcBorders = 8;
constexpr int kMaxHullExtent = 62;       // px, of borders that need not be convex
constexpr double kMinSmallContrast = 5;  // gray values
constexpr std::array<double, 1> kOneScale{1.0};
// An outline that grew together with what is beside it is larger than the ring.
constexpr std::array<double, 2> kAreaScales{1.0, 1.12};
// How far from an area's outline the edges of the ring may be, of its diameter.
constexpr double kSure = 0.02;
constexpr double kUnsure = 0.1;
constexpr double kPredicted = 0.12;  // the same of a predicted ring
// Times which a predicted ring is large enough for its edges, which tell more than its fit as a
// whole: areas seem larger by as much.
constexpr double kNearlyLarge = 1.1;

double ReachPx(const Eigen::Vector2d& diameters_px, const ImageRegion& region, double unsure) {
  return std::max(2.0, 0.8 * region.scale() + unsure * diameters_px.x());
}

void KeepBest(std::vector<RingCandidate>* candidates) {
  const std::size_t kept = std::min(candidates->size(), kMaxCandidates);
  std::partial_sort(candidates->begin(), candidates->begin() + static_cast<std::ptrdiff_t>(kept),
                    candidates->end(), [](const RingCandidate& a, const RingCandidate& b) {
                      return a.contrast > b.contrast;
                    });
  candidates->resize(kept);
}

}  // namespace

// Where a good prediction says that the ring is, it is found without a search. A wrong one shows
// no ring there, and costs little. Whether the pattern was found.
bool LandingSearch::TestPrediction() {
  if (!hint_.center_in_camera || !hint_.up_in_camera || !ChooseRegion(0)) return false;
  const CirclePose ring{*hint_.center_in_camera, *hint_.up_in_camera};
  if (!(ring.center.dot(ring.normal) < 0)) return false;  // seen from below, or not a number
  const Eigen::Vector2d diameters_px = DiametersPx(ring);
  if (!IsSmall(kNearlyLarge * diameters_px)) TestPredictedRing(ring, diameters_px);
  if (!report_.detection && IsSmall(diameters_px) && !IsTooSmall(diameters_px)) {
    StageTimer timer(&report_, LandingStage::kCross);
    TestSmallPose(ring, diameters_px, kOneScale);
  }
  return is_sure_;
}

// The edges of a large ring are near to where it is predicted.
void LandingSearch::TestPredictedRing(const CirclePose& predicted,
                                      const Eigen::Vector2d& predicted_px) {
  std::optional<RigidTransform> refined;
  {
    StageTimer timer(&report_, LandingStage::kRing);
    constexpr int kIterations = 3;
    refined = RefineRing(predicted, kPredicted * predicted_px.x(), kIterations);
  }
  if (!refined) return;
  const CirclePose ring{refined->translation, refined->rotation * Eigen::Vector3d::UnitZ()};
  const Eigen::Vector2d diameters_px = DiametersPx(ring);
  if (IsSmall(kNearlyLarge * diameters_px) || !IsPlausible(ring)) return;
  BuildPyramid(ViewLevel(diameters_px.x()));
  std::optional<Hypothesis> hypothesis;
  {
    StageTimer timer(&report_, LandingStage::kCross);
    hypothesis = FindCross(ring, diameters_px.x());
  }
  if (hypothesis) Locate(*hypothesis, diameters_px, std::max(2.0, kSure * diameters_px.x()));
}

void LandingSearch::TestAreas(std::size_t pass_index) {
  CollectCandidates(pass_index);
  for (const RingCandidate& candidate : buffers_.candidates) TestCandidate(candidate, pass_index);
}

// The outlines of a pass that may be a ring, those of the highest contrast first.
void LandingSearch::CollectCandidates(std::size_t pass_index) {
  StageTimer timer(&report_, LandingStage::kAreas);
  const Pass& pass = kPasses[pass_index];
  const LandingPattern& pattern = models_.options.pattern;
  const double scale = 1 << pass.image_level;
  const cv::Mat image = buffers_.pyramid.ImageAt(pass.image_level);
  const BorderTracer& tracer = buffers_.tracers[pass_index];
  std::vector<RingCandidate>& candidates = buffers_.candidates;
  candidates.clear();
  for (std::size_t i = 0;
       i < tracer.borders().size() && candidates.size() + 2 <= candidates.capacity(); ++i) {
    const Border& border = tracer.borders()[i];
    const std::optional<DarkArea> area =
        TestDarkArea(tracer, border, std::max(4.0, 0.7 * pass.min_ring_px / scale),
                     pass.image_level == 0 ? kMaxHullExtent : 0);
    if (!area) continue;
    RingCandidate candidate;
    candidate.border = i;
    candidate.edge = area->edge;
    candidate.outer_edge = area->outline;
    if (area->edge == RingEdge::kInner) {
      candidate.outer_edge.Scale(pattern.outer_radius_m() / pattern.inner_radius_m());
    }
    Reach(LandingStage::kAreas, "no ring stands out of its surroundings");
    candidate.contrast = RingContrast(image, candidate.outer_edge, pattern);
    const bool small =
        IsSmall(2 * scale * Eigen::Vector2d(area->outline.semi_major, area->outline.semi_minor));
    if (candidate.contrast > 0 && (small || area->ellipticity >= kMinEllipticity)) {
      candidates.push_back(candidate);
    }
    if (pass.image_level > 1 || area->edge == RingEdge::kOuter) continue;
    // The second moments of a square are those of a circle of 1 / sqrt(3) times its side.
    candidate.board = true;
    candidate.outer_edge = area->outline;
    candidate.outer_edge.Scale(pattern.outer_radius_m() * std::sqrt(3.0) / pattern.board_size_m);
    const Ellipse& ring = candidate.outer_edge;
    if (area->ellipticity < kMinEllipticity || 2 * ring.semi_major * scale > kMaxBoardRingPx ||
        2 * ring.semi_minor * scale < models_.options.min_ring_px) {
      continue;
    }
    candidate.contrast = BoardContrast(image, ring);
    if (candidate.contrast > 0) candidates.push_back(candidate);
  }
  KeepBest(&candidates);
}

// Adds the ray of a pixel to those that a ring is fitted to; false when the lens has none there.
bool LandingSearch::AddRay(const Eigen::Vector2d& pixel) {
  const Eigen::Vector3f ray =
      models_.rays.Ray(static_cast<float>(pixel.x()), static_cast<float>(pixel.y()));
  if (ray.squaredNorm() < 0.5f) return false;
  buffers_.rays.push_back(ray.cast<double>());
  return true;
}

void LandingSearch::TestCandidate(const RingCandidate& candidate, std::size_t pass_index) {
  const ImageRegion region{offset_, kPasses[pass_index].image_level};
  Reach(LandingStage::kRing, "no border lies on the image of a circle");
  const bool small =
      IsSmall(2 * region.scale() *
              Eigen::Vector2d(candidate.outer_edge.semi_major, candidate.outer_edge.semi_minor));
  std::optional<RingFit> ring;
  if (!candidate.board && !small) ring = FitToBorder(candidate, pass_index);
  const bool by_border = ring.has_value();
  if (!ring) ring = FitToOutline(candidate, region);
  if (!ring || !IsPlausible(ring->poses[0])) return;
  const Eigen::Vector2d diameters_px = DiametersPx(ring->poses[0]);
  // A print with a dark border shows less white than the board's size.
  constexpr std::array<double, 3> kBoardScales{1.0, 1.08, 1.17};
  if (small) {
    TestSmallRing(*ring, diameters_px,
                  candidate.board ? std::span<const double>(kBoardScales) : kAreaScales);
  } else if (candidate.board) {
    for (const double scale : kBoardScales) {
      RingFit scaled = *ring;
      for (CirclePose& pose : scaled.poses) pose.center /= scale;
      TestRing(scaled, diameters_px, std::max(2.0, 0.06 * diameters_px.x()));
    }
  } else {
    // Dirt around the ring on which no circle lies makes the outline less sure.
    TestRing(*ring, diameters_px, ReachPx(diameters_px, region, by_border ? kSure : kUnsure));
  }
}

std::optional<RingFit> LandingSearch::FitToBorder(const RingCandidate& candidate,
                                                  std::size_t pass_index) {
  StageTimer timer(&report_, LandingStage::kRing);
  const ImageRegion region{offset_, kPasses[pass_index].image_level};
  const BorderTracer& tracer = buffers_.tracers[pass_index];
  const Border& border = tracer.borders()[candidate.border];
  const GridPoint* points = tracer.begin(border);
  const std::size_t step =
      std::max<std::size_t>(1, border.count / LandingWorkspace::Buffers::kMaxRays);
  buffers_.rays.clear();
  for (std::size_t i = 0; i < border.count; i += step) {
    AddRay(region.ToFull(Eigen::Vector2d(points[i].x - 0.5, points[i].y - 0.5)));
  }
  const double scale = region.scale();
  const double radius_px = candidate.outer_edge.semi_major * scale;
  const double tolerance_px =
      std::max(std::min(kToleranceRingPx, 0.05 * radius_px + 0.6 * scale), scale);
  const LandingPattern& pattern = models_.options.pattern;
  return FitRing(
      buffers_.rays,
      candidate.edge == RingEdge::kOuter ? pattern.outer_radius_m() : pattern.inner_radius_m(),
      tolerance_px / focal_px_);
}

// Small rings that the image border cuts off: their moments say nothing, and their arcs are too
// short to stand out from those of everything else in the image.
void LandingSearch::TestCutAreas(std::size_t pass_index) {
  constexpr double kTolerancePx = 0.8;  // of an outline that ends in corners of pixels
  constexpr int kMaxFits = 16;          // a bound of the time that a frame full of texture costs
  const ImageRegion region{offset_, kPasses[pass_index].image_level};
  const LandingPattern& pattern = models_.options.pattern;
  const BorderTracer& tracer = buffers_.tracers[pass_index];
  int fits = 0;
  for (const Border& border : tracer.borders()) {
    const int extent = std::max(border.max.x - border.min.x, border.max.y - border.min.y);
    if (border.signed_area < 0 || extent > kMaxHullExtent || !IsCutOff(tracer, border)) continue;
    if (++fits > kMaxFits) return;
    std::optional<RingFit> ring;
    {
      StageTimer timer(&report_, LandingStage::kRing);
      std::array<Eigen::Vector2d, 4 * kMaxHullExtent> outline;
      const std::size_t count = OutlineInView(tracer, border, outline);
      buffers_.rays.clear();
      for (std::size_t i = 0; i < count; i += 1 + count / LandingWorkspace::Buffers::kMaxRays) {
        AddRay(region.ToFull(outline[i]));
      }
      ring = FitRing(buffers_.rays, pattern.outer_radius_m(),
                     kTolerancePx * region.scale() / focal_px_);
    }
    if (!ring || !IsPlausible(ring->poses[0])) continue;
    Reach(LandingStage::kRing, "no border lies on the image of a circle");
    if (!StandsOut(ring->poses[0])) continue;
    const Eigen::Vector2d diameters_px = DiametersPx(ring->poses[0]);
    if (IsSmall(diameters_px)) {
      TestSmallRing(*ring, diameters_px, kAreaScales);
    } else {
      TestRing(*ring, diameters_px, ReachPx(diameters_px, region, kSure));
    }
  }
}

// The ring that the moments of an outline say: for outlines of few pixels, and for the board.
std::optional<RingFit> LandingSearch::FitToOutline(const RingCandidate& candidate,
                                                   const ImageRegion& region) {
  StageTimer timer(&report_, LandingStage::kRing);
  constexpr int kRays = 16;
  buffers_.rays.clear();
  for (int i = 0; i < kRays; ++i) {
    const Eigen::Vector2d point = candidate.outer_edge.At(i * 2 * std::numbers::pi / kRays);
    if (!AddRay(region.ToFull(point))) return std::nullopt;
  }
  return FitRing(buffers_.rays, models_.options.pattern.outer_radius_m(), 1 / focal_px_);
}

void LandingSearch::TestArcs(std::size_t pass_index) {
  const ImageRegion region{offset_, kPasses[pass_index].image_level};
  const LandingPattern& pattern = models_.options.pattern;
  const double scale = region.scale();
  {
    StageTimer timer(&report_, LandingStage::kRing);
    constexpr double kMinCoverage = 0.25;
    BorderTracer& tracer = buffers_.tracers[pass_index];
    if (region.level == 0) tracer.KeepStrongest(searched_, kMaxArcBorders);
    FindArcRings(tracer, models_.rays, region, 0.7 * scale / focal_px_, kMinCoverage,
                 &buffers_.arcs);
  }
  for (const ArcRing& arcs : buffers_.arcs.rings) {
    Reach(LandingStage::kRing, "no border lies on the image of a circle");
    const bool inner = arcs.edge == RingEdge::kInner;
    const double radius_m = inner ? pattern.inner_radius_m() : pattern.outer_radius_m();
    const RingFit ring{arcs.cone, CirclePosesFromCone(arcs.cone, radius_m, arcs.toward)};
    if (!IsPlausible(ring.poses[0])) continue;
    const Eigen::Vector2d diameters_px = DiametersPx(ring.poses[0]);
    if (IsSmall(diameters_px)) {
      if (StandsOut(ring.poses[0])) TestSmallRing(ring, diameters_px, kOneScale);
    } else {
      TestRing(ring, diameters_px, std::max(2.0, scale + 0.025 * diameters_px.x()));
    }
  }
}

// The cross alone, where the camera is so low that no ring is in view.
void LandingSearch::TestPartial(std::size_t pass_index) {
  const ImageRegion region{offset_, kPasses[pass_index].image_level};
  const LandingPattern& pattern = models_.options.pattern;
  {
    StageTimer timer(&report_, LandingStage::kCross);
    // Without an attitude the camera is taken to look straight down.
    const Eigen::Vector3d up = hint_.up_in_camera.value_or(-Eigen::Vector3d::UnitZ());
    FindPartialPatterns(buffers_.tracers[pass_index], models_.rays, region, pattern, up,
                        &buffers_.partial);
  }
  for (const RigidTransform& pose : buffers_.partial.poses) {
    const double distance = pose.translation.norm();
    if (distance > models_.options.max_partial_altitude_m ||
        !IsPlausible({pose.translation, pose.rotation * Eigen::Vector3d::UnitZ()})) {
      continue;
    }
    Reach(LandingStage::kCross, "lines of a cross without the pattern around them");
    const double diameter_px = 2 * focal_px_ * std::atan2(pattern.outer_radius_m(), distance);
    const std::optional<Hypothesis> hypothesis = Compare(pose, CrossMethod::kPartial, diameter_px);
    if (!hypothesis) continue;
    Locate(*hypothesis, Eigen::Vector2d::Constant(diameter_px),
           std::max(2.0, region.scale() + 0.03 * diameter_px));
  }
}

// Whether a small ring is darker than what is around it.
bool LandingSearch::StandsOut(const CirclePose& ring) const {
  const PatternView view(models_.camera, PatternPose(ring, 0), models_.matcher.extent_m(),
                         {offset_, 0});
  return view.valid() && models_.matcher.RingContrast(searched_, view) >= kMinSmallContrast;
}

// Axes of the ring as the image shows it, px, the longer one first: near its rim a fisheye lens
// stretches what it shows. By its angles where it leaves the lens.
Eigen::Vector2d LandingSearch::DiametersPx(const CirclePose& ring) const {
  constexpr int kPoints = 8;
  const double radius = models_.options.pattern.outer_radius_m();
  const Eigen::Vector3d a = ring.normal.unitOrthogonal();
  const Eigen::Vector3d b = ring.normal.cross(a);
  Eigen::Matrix<double, 2, kPoints> pixels;
  for (int i = 0; i < kPoints; ++i) {
    const double angle = i * 2 * std::numbers::pi / kPoints;
    Eigen::Vector2d pixel;
    if (models_.camera.Project(ring.center + radius * (std::cos(angle) * a + std::sin(angle) * b),
                               &pixel) == ProjectionStatus::kOutsideModel) {
      const double distance = ring.center.norm();
      const double foreshortening = std::abs(ring.normal.dot(ring.center)) / distance;
      return 2 * focal_px_ * std::atan2(radius, distance) * Eigen::Vector2d(1, foreshortening);
    }
    pixels.col(i) = pixel;
  }
  pixels.colwise() -= pixels.rowwise().mean().eval();
  const Eigen::Matrix2d moments = pixels * pixels.transpose() / kPoints;
  const double mean = 0.5 * moments.trace();
  const double spread = std::sqrt(std::max(0.0, mean * mean - moments.determinant()));
  // The second moment of a circle along its diameter is half of its squared radius.
  return 2 * std::numbers::sqrt2 *
         Eigen::Vector2d(std::sqrt(mean + spread), std::sqrt(std::max(0.0, mean - spread)));
}

bool LandingSearch::IsSmall(const Eigen::Vector2d& diameters_px) const {
  return diameters_px.x() < kSmallRingPx || diameters_px.y() < kThinRingPx;
}

}  // namespace kestrel
