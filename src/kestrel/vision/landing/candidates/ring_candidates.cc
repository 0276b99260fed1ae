// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/landing/candidates/ring_candidates.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "kestrel/vision/landing/image_properties.h"
#include "kestrel/vision/landing/location/pattern_pose.h"

namespace kestrel {
namespace {

constexpr double kToleranceRingPx = 3.5;  // paper, section 2.3
// Axes (diameters) below which strokes are hardly wider than the blur, everywhere or in places.
constexpr double kSmallRingPx = 30;
constexpr double kThinRingPx = 13;
constexpr double kMaxBoardRingPx = 50;  // largest major axis of a ring that is found by its board
constexpr std::size_t kMaxCollected = 512;
// Bounds on the time for a frame full of texture: number of outlines of a pass (those of the
// highest contrast), of pieces of cut-off areas, and of borders that are cut into arcs.
constexpr std::size_t kMaxOutlines = 4;
constexpr int kMaxCutFits = 16;
constexpr std::size_t kMaxArcBorders = 8;
constexpr int kMaxHullExtent = 62;  // px, of borders that need not be convex
// An outline that has grown together with something beside it is larger than the ring.
constexpr std::array<double, 2> kAreaScales{1.0, 1.12};
// A print with a dark border shows less white than the board's size.
constexpr std::array<double, 3> kBoardScales{1.0, 1.08, 1.17};
// Reach around an outline that no circle fits, because of dirt around the ring; around the ring of
// a board, and around one of arcs.
constexpr double kUnsure = 0.1;
constexpr double kOfBoard = 0.06;
constexpr double kOfArcs = 0.025;

double ReachPx(const Eigen::Vector2d& diameters_px, const ImageRegion& region, double unsure) {
  return std::max(RingReach::kLeastPx, 0.8 * region.scale() + unsure * diameters_px.x());
}

}  // namespace

Eigen::Vector2d RingDiametersPx(const CameraModel& camera, double radius_m,
                                const CirclePose& ring) {
  constexpr int kPoints = 8;
  const Eigen::Vector3d a = ring.normal.unitOrthogonal();
  const Eigen::Vector3d b = ring.normal.cross(a);
  Eigen::Matrix<double, 2, kPoints> pixels;
  for (int i = 0; i < kPoints; ++i) {
    const double angle = i * 2 * std::numbers::pi / kPoints;
    Eigen::Vector2d pixel;
    if (camera.Project(ring.center + radius_m * (std::cos(angle) * a + std::sin(angle) * b),
                       &pixel) == ProjectionStatus::kOutsideModel) {
      const double distance = ring.center.norm();
      const double foreshortening = std::abs(ring.normal.dot(ring.center)) / distance;
      return 2 * camera.intrinsics().fx_px * std::atan2(radius_m, distance) *
             Eigen::Vector2d(1, foreshortening);
    }
    pixels.col(i) = pixel;
  }
  pixels.colwise() -= pixels.rowwise().mean().eval();
  const Eigen::Matrix2d moments = pixels * pixels.transpose() / kPoints;
  const double mean = 0.5 * moments.trace();
  const double spread = std::sqrt(std::max(0.0, mean * mean - moments.determinant()));
  // The second moment of a circle (its outline) along a diameter is half of the squared radius.
  return 2 * std::numbers::sqrt2 *
         Eigen::Vector2d(std::sqrt(mean + spread), std::sqrt(std::max(0.0, mean - spread)));
}

bool IsSmallRing(const Eigen::Vector2d& diameters_px) {
  return diameters_px.x() < kSmallRingPx || diameters_px.y() < kThinRingPx;
}

void RingFinderBuffers::Reserve(std::size_t most_border_points) {
  outlines.reserve(kMaxCollected);
  rays.reserve(2 * kMaxRays);
  arcs.Reserve(most_border_points);
  candidates.reserve(std::max<std::size_t>(kMaxCutFits, kMaxOutlines * kBoardScales.size()));
}

RingFinder::RingFinder(const LandingModels& models, RingFinderBuffers* buffers, SearchLog* log)
    : models_(models),
      focal_px_(models.camera.intrinsics().fx_px),
      buffers_(*buffers),
      log_(*log) {}

void RingFinder::Add(const RingFit& ring, const Eigen::Vector2d& diameters_px, bool is_small,
                     double reach_px, std::span<const double> scales) {
  buffers_.candidates.push_back({ring.poses, diameters_px, is_small, reach_px, scales});
}

std::span<const RingCandidate> RingFinder::FindInAreas(SearchedImage* image, std::size_t pass) {
  buffers_.candidates.clear();
  const ImageRegion region = image->RegionAt(kPasses[pass].image_level);
  const BorderTracer& tracer = image->Borders(pass);
  CollectOutlines(image->At(region.level), tracer, kPasses[pass]);
  for (const Outline& outline : buffers_.outlines) AddOutline(outline, tracer, region);
  return buffers_.candidates;
}

// Collects the outlines that may be a ring, those of the highest contrast first.
void RingFinder::CollectOutlines(const cv::Mat& image, const BorderTracer& tracer,
                                 const SearchPass& pass) {
  const SearchLog::Timer timer = log_.Time(LandingStage::kAreas);
  const LandingPattern& pattern = models_.options.pattern;
  const double scale = 1 << pass.image_level;
  std::vector<Outline>& outlines = buffers_.outlines;
  outlines.clear();
  for (std::size_t i = 0; i < tracer.borders().size() && outlines.size() + 2 <= outlines.capacity();
       ++i) {
    const Border& border = tracer.borders()[i];
    const std::optional<DarkArea> area = TestDarkArea(
        tracer, border, std::max(4.0, SearchPass::kThinnest * pass.min_ring_px / scale),
        pass.image_level == 0 ? kMaxHullExtent : 0);
    if (!area) continue;
    log_.Reach(LandingStage::kAreas, "no ring stands out of its surroundings");
    Outline ring{area->outline, area->edge, /*board=*/false, i};
    if (area->edge == RingEdge::kInner) {
      ring.outer_edge.Scale(pattern.outer_radius_m() / pattern.inner_radius_m());
    }
    ring.contrast = RingContrast(image, ring.outer_edge, pattern);
    const bool small = IsSmallRing(
        2 * scale * Eigen::Vector2d(area->outline.semi_major, area->outline.semi_minor));
    const bool is_elliptic = area->ellipticity >= kMinEllipticity;
    if (ring.contrast > 0 && (small || is_elliptic)) outlines.push_back(ring);

    if (pass.image_level > 1 || area->edge == RingEdge::kOuter || !is_elliptic) continue;
    // A square has the second moments of a circle of 1 / sqrt(3) times its side as radius.
    Outline board{area->outline, area->edge, /*board=*/true, i};
    board.outer_edge.Scale(pattern.outer_radius_m() * std::sqrt(3.0) / pattern.board_size_m);
    if (2 * board.outer_edge.semi_major * scale > kMaxBoardRingPx ||
        2 * board.outer_edge.semi_minor * scale < models_.options.min_ring_px) {
      continue;
    }
    board.contrast = BoardContrast(image, board.outer_edge);
    if (board.contrast > 0) outlines.push_back(board);
  }
  const std::size_t kept = std::min(outlines.size(), kMaxOutlines);
  std::partial_sort(outlines.begin(), outlines.begin() + static_cast<std::ptrdiff_t>(kept),
                    outlines.end(),
                    [](const Outline& a, const Outline& b) { return a.contrast > b.contrast; });
  outlines.resize(kept);
}

void RingFinder::AddOutline(const Outline& outline, const BorderTracer& tracer,
                            const ImageRegion& region) {
  const SearchLog::Timer timer = log_.Time(LandingStage::kRing);
  log_.Reach(LandingStage::kRing, "no border lies on the image of a circle");
  const Ellipse& edge = outline.outer_edge;
  const bool small =
      IsSmallRing(2 * region.scale() * Eigen::Vector2d(edge.semi_major, edge.semi_minor));
  std::optional<RingFit> ring;
  if (!outline.board && !small) ring = FitToBorder(outline, tracer, region);
  const bool by_border = ring.has_value();
  if (!ring) ring = FitToOutline(outline, region);
  if (!ring) return;
  const Eigen::Vector2d diameters_px =
      RingDiametersPx(models_.camera, models_.options.pattern.outer_radius_m(), ring->poses[0]);
  if (small) {
    Add(*ring, diameters_px, small, 0,
        outline.board ? std::span<const double>(kBoardScales) : kAreaScales);
  } else if (outline.board) {
    for (const double scale : kBoardScales) {
      RingFit scaled = *ring;
      for (CirclePose& pose : scaled.poses) pose.center /= scale;
      Add(scaled, diameters_px, small, std::max(RingReach::kLeastPx, kOfBoard * diameters_px.x()),
          kOneScale);
    }
  } else {
    Add(*ring, diameters_px, small,
        ReachPx(diameters_px, region, by_border ? RingReach::kSure : kUnsure), kOneScale);
  }
}

// Adds the ray of a pixel to those that a ring is fitted to; false when the lens has no ray there.
bool RingFinder::AddRay(const Eigen::Vector2d& pixel) {
  const Eigen::Vector3f ray =
      models_.rays.Ray(static_cast<float>(pixel.x()), static_cast<float>(pixel.y()));
  if (ray.squaredNorm() < 0.5f) return false;
  buffers_.rays.push_back(ray.cast<double>());
  return true;
}

std::optional<RingFit> RingFinder::FitToBorder(const Outline& outline, const BorderTracer& tracer,
                                               const ImageRegion& region) {
  const Border& border = tracer.borders()[outline.border];
  const GridPoint* points = tracer.begin(border);
  const std::size_t step = std::max<std::size_t>(1, border.count / RingFinderBuffers::kMaxRays);
  buffers_.rays.clear();
  for (std::size_t i = 0; i < border.count; i += step) {
    AddRay(region.ToFull(Eigen::Vector2d(points[i].x - 0.5, points[i].y - 0.5)));
  }
  const double scale = region.scale();
  const double radius_px = outline.outer_edge.semi_major * scale;
  const double tolerance_px =
      std::max(std::min(kToleranceRingPx, 0.05 * radius_px + 0.6 * scale), scale);
  const LandingPattern& pattern = models_.options.pattern;
  const double radius_m =
      outline.edge == RingEdge::kOuter ? pattern.outer_radius_m() : pattern.inner_radius_m();
  return FitRing(buffers_.rays, radius_m, tolerance_px / focal_px_);
}

// Fits a ring to the ellipse of an outline's moments: for outlines of few pixels, and for the
// board.
std::optional<RingFit> RingFinder::FitToOutline(const Outline& outline, const ImageRegion& region) {
  constexpr int kRays = 16;
  buffers_.rays.clear();
  for (int i = 0; i < kRays; ++i) {
    const Eigen::Vector2d point = outline.outer_edge.At(i * 2 * std::numbers::pi / kRays);
    if (!AddRay(region.ToFull(point))) return std::nullopt;
  }
  return FitRing(buffers_.rays, models_.options.pattern.outer_radius_m(), 1 / focal_px_);
}

// Finds small rings that the image border cuts off. Their moments are useless, and their arcs are
// too short to stand out from others in the image.
std::span<const RingCandidate> RingFinder::FindInCutAreas(SearchedImage* image, std::size_t pass) {
  constexpr double kTolerancePx = 0.8;  // tolerance of an outline that ends in corners of pixels
  buffers_.candidates.clear();
  const ImageRegion region = image->RegionAt(kPasses[pass].image_level);
  const double radius_m = models_.options.pattern.outer_radius_m();
  const BorderTracer& tracer = image->Borders(pass);
  const SearchLog::Timer timer = log_.Time(LandingStage::kRing);
  int fits = 0;
  for (const Border& border : tracer.borders()) {
    const int extent = std::max(border.max.x - border.min.x, border.max.y - border.min.y);
    if (border.signed_area < 0 || extent > kMaxHullExtent || !IsCutOff(tracer, border)) continue;
    if (++fits > kMaxCutFits) break;
    std::array<Eigen::Vector2d, 4 * kMaxHullExtent> outline;
    const std::size_t count = OutlineInView(tracer, border, outline);
    buffers_.rays.clear();
    for (std::size_t i = 0; i < count; i += 1 + count / RingFinderBuffers::kMaxRays) {
      AddRay(region.ToFull(outline[i]));
    }
    const std::optional<RingFit> ring =
        FitRing(buffers_.rays, radius_m, kTolerancePx * region.scale() / focal_px_);
    if (!ring) continue;
    log_.Reach(LandingStage::kRing, "no border lies on the image of a circle");
    if (!StandsOut(*image, ring->poses[0])) continue;
    const Eigen::Vector2d diameters_px = RingDiametersPx(models_.camera, radius_m, ring->poses[0]);
    Add(*ring, diameters_px, IsSmallRing(diameters_px),
        ReachPx(diameters_px, region, RingReach::kSure), kAreaScales);
  }
  return buffers_.candidates;
}

std::span<const RingCandidate> RingFinder::FindInArcs(SearchedImage* image, std::size_t pass) {
  constexpr double kMinCoverage = 0.25;
  constexpr double kTolerancePx = 0.7;  // distance of an arc from its circle, pixels of the pass
  buffers_.candidates.clear();
  const ImageRegion region = image->RegionAt(kPasses[pass].image_level);
  const LandingPattern& pattern = models_.options.pattern;
  const BorderTracer& tracer = image->Borders(pass);
  const SearchLog::Timer timer = log_.Time(LandingStage::kRing);
  std::span<const Border> borders = tracer.borders();
  // At full resolution, texture as fine as the pixels contains many arcs like those of rings.
  if (region.level == 0) borders = borders.first(std::min(borders.size(), kMaxArcBorders));
  FindArcRings(tracer, borders, models_.rays, region, kTolerancePx * region.scale() / focal_px_,
               kMinCoverage, &buffers_.arcs);
  for (const ArcRing& arcs : buffers_.arcs.rings) {
    log_.Reach(LandingStage::kRing, "no border lies on the image of a circle");
    const double radius_m =
        arcs.edge == RingEdge::kInner ? pattern.inner_radius_m() : pattern.outer_radius_m();
    const RingFit ring{arcs.cone, CirclePosesFromCone(arcs.cone, radius_m, arcs.toward)};
    const Eigen::Vector2d diameters_px =
        RingDiametersPx(models_.camera, pattern.outer_radius_m(), ring.poses[0]);
    const bool small = IsSmallRing(diameters_px);
    if (small && !StandsOut(*image, ring.poses[0])) continue;
    Add(ring, diameters_px, small,
        std::max(RingReach::kLeastPx, region.scale() + kOfArcs * diameters_px.x()), kOneScale);
  }
  return buffers_.candidates;
}

// True when a small ring is darker than its surroundings.
bool RingFinder::StandsOut(const SearchedImage& image, const CirclePose& ring) const {
  const PatternView view(models_.camera, PatternPose(ring, 0), models_.ring_probe.extent_m(),
                         image.RegionAt(0));
  return view.valid() && models_.ring_probe.Contrast(image.At(0), view) >= GrayContrast::kLeastRing;
}

}  // namespace kestrel
