// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/landing/landing_search.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numbers>
#include <span>

#include "kestrel/landing/pattern_pose.h"

namespace kestrel {
namespace {

constexpr std::size_t kMaxRays = 48;
constexpr double kToleranceRingPx = 3.5;  // paper, section 2.3
// Edges of the print are found to a tenth of a pixel, blurred ones to a few; the nearest edges of
// anything else scatter over the whole reach of the search.
constexpr double kMaxEdgeRmsPx = 1.0;
// Axes (diameters) below which a stroke is hardly wider than the blur, everywhere or somewhere.
constexpr double kSmallRingPx = 30;
constexpr double kThinRingPx = 13;
constexpr double kMaxBoardRingPx = 50;   // major axis of a ring that the board shows
constexpr double kInspectedRingPx = 64;  // major axis below which it is looked for other signs
constexpr double kMinMajorPx = 9;        // of the smallest ring
// Differences of the residuals inside of a small ring, on it and around it, share of the contrast.
constexpr double kMaxMoreInside = 0.085;
constexpr double kMaxMoreOnRing = 0.12;
constexpr double kMaxMoreOutside = 0.15;
// Darkness of what only other signs have, share of the contrast.
constexpr double kMinCrossCorrelation = 0.7;
constexpr double kMaxOtherSpokes = 0.55;
constexpr double kMaxFrameCorners = 0.14;
constexpr double kMaxBoardDarkness = 0.35;
constexpr double kSmallMargin = 0.08;            // of the quality of a small pattern
constexpr double kMinCorrelation = 0.35;         // of a start of a small pattern
constexpr double kSureCorrelation = 0.6;         // of a start that quadrants give
constexpr double kMinCorrelationOfEither = 0.7;  // of the poses of a small pattern
constexpr double kMinFittedCorrelation = 0.82;   // of a small pattern
// Candidates of a pass that are looked at, those of the highest contrast: a bound of the time that
// a frame full of texture costs.
constexpr std::size_t kMaxCandidates = 6;
constexpr std::size_t kMaxCollected = 512;
constexpr std::size_t kMaxTested = 64;  // small rings that are remembered
constexpr std::array<double, 1> kOneScale{1.0};
// Edges and contrasts of the ring that are where a circle has them: a frame of another shape has
// some of them.
constexpr double kMinRingShare = 0.85;
constexpr double kMinRingContrast = 5;  // gray values
constexpr double kWhole = 0.75;         // share of the print in view that is no partial pattern

// Adds the time of its life to a stage.
class StageTimer {
 public:
  StageTimer(LandingReport* report, LandingStage stage)
      : total_(report->stage_ns[static_cast<int>(stage)]),
        start_(std::chrono::steady_clock::now()) {}
  ~StageTimer() { total_ += (std::chrono::steady_clock::now() - start_).count(); }

 private:
  std::int64_t& total_;
  std::chrono::steady_clock::time_point start_;
};

// Level of the pyramid at which a ring has about 40 to 80 pixels.
int ViewLevel(double diameter_px) {
  return std::clamp(static_cast<int>(std::floor(std::log2(diameter_px / 40))), 0, 4);
}

// Whether a fitted pose is still that of the ring it started from.
bool Agrees(const RigidTransform& start, const RigidTransform& fitted, double radius_m) {
  const double distance = start.translation.norm();
  return std::abs(fitted.translation.norm() - distance) < 0.25 * distance &&
         (fitted.translation.normalized() - start.translation / distance).norm() <
             0.4 * radius_m / distance;
}

// Whether two detections are the two poses of one ring, between which the image does not decide.
bool AreMirrorPoses(const LandingDetection& a, const LandingDetection& b) {
  constexpr double kAlike = 0.05;  // difference of the qualities
  constexpr double kSameCenterPx = 2;
  constexpr double kOtherNormal = 0.99;  // cosine between the normals
  const Eigen::Vector3d z = Eigen::Vector3d::UnitZ();
  return std::abs(a.quality - b.quality) < kAlike &&
         (a.center_px - b.center_px).norm() < kSameCenterPx &&
         (a.camera_from_pattern.rotation * z).dot(b.camera_from_pattern.rotation * z) <
             kOtherNormal;
}

bool IsOtherSign(const SmallPatternFitter::OtherSigns& others) {
  return others.spokes > kMaxOtherSpokes || others.frame_corners > kMaxFrameCorners ||
         others.cross_correlation < kMinCrossCorrelation ||
         others.board_darkness > kMaxBoardDarkness;
}

// What is asked of the quality of a small pattern beyond that of a near one.
double SmallMargin(const Eigen::Vector2d& diameters_px) {
  return kSmallMargin * std::clamp((36 - std::sqrt(diameters_px.prod())) / 16, 0.0, 1.0);
}

}  // namespace

// Near patterns first: they are found at a sixteenth of the cost, and matter most.
const std::array<LandingSearch::Pass, LandingWorkspace::Buffers::kPasses> LandingSearch::kPasses = {
    {
        {3, 5, 64, 1e9},
        {2, 4, 32, 400},
        {1, 3, 16, 200},
        {0, 1, 6, 120, true},
        {0, 2, 6, 60, false, false},
        {0, 3, 6, 60, false, true},
    }};

LandingSearch::LandingSearch(const LandingModels& models, const cv::Mat& image,
                             const LandingHint& hint, LandingWorkspace::Buffers* buffers)
    : models_(models),
      image_(image),
      hint_(hint),
      buffers_(*buffers),
      focal_px_(models.camera.intrinsics().fx_px) {}

void LandingSearch::Reach(LandingStage stage, std::string_view reason_if_it_ends_here) {
  ++report_.candidates[static_cast<int>(stage)];
  if (stage < report_.reached) return;
  report_.reached = stage;
  report_.reason = reason_if_it_ends_here;
}

// Makes room for all that a search of an image of this size may need: runs what depends on the size
// alone, reserves what depends on what is in the image.
void LandingSearch::MakeRoom() {
  if (buffers_.width_px == image_.cols && buffers_.height_px == image_.rows) return;
  buffers_.width_px = image_.cols;
  buffers_.height_px = image_.rows;
  buffers_.pyramid.Build(image_);
  std::size_t most_points = 0;
  for (std::size_t i = 0; i < kPasses.size(); ++i) {
    const cv::Mat image = buffers_.pyramid.ImageAt(kPasses[i].image_level);
    buffers_.tracers[i].Reserve(image.cols, image.rows);
    if (!image.empty()) Binarize(kPasses[i]);
    if (i < kCoarsePasses) most_points = std::max(most_points, buffers_.tracers[i].capacity());
  }
  buffers_.candidates.reserve(kMaxCollected);
  buffers_.rays.reserve(2 * kMaxRays);
  buffers_.arcs.Reserve(most_points);
  buffers_.cross_lines.Reserve();
  buffers_.partial.Reserve(most_points);
  buffers_.small.Reserve();
  buffers_.tested.reserve(kMaxTested);
}

LandingReport LandingSearch::Run() {
  MakeRoom();
  buffers_.tested.clear();
  report_.reason = "no outline that could be a ring";
  if (!ChooseRegion()) {
    report_.reason = "the hint points out of the image";
    return report_;
  }
  {
    StageTimer timer(&report_, LandingStage::kBinarize);
    buffers_.pyramid.Build(searched_);
  }
  // Closed areas are the cheaper way to the ring, arcs the surer one.
  const auto run = [this](std::size_t first, std::size_t last, auto test) {
    for (std::size_t i = first; i < last && !report_.detection; ++i) {
      if (Suits(kPasses[i])) test(i);
    }
  };
  const auto trace_and_test = [this](std::size_t i) {
    Trace(i);
    TestAreas(i);
  };
  run(0, kCoarsePasses, trace_and_test);
  run(0, kCoarsePasses, [this](std::size_t i) { TestArcs(i); });
  const bool low = !hint_.altitude_m || *hint_.altitude_m <= models_.options.max_partial_altitude_m;
  if (low) run(0, kPartialPasses, [this](std::size_t i) { TestPartial(i); });
  run(kCoarsePasses, kPasses.size(), trace_and_test);
  return report_;
}

// Sets the part of the image that the hint leaves and the size of the ring that it says. False when
// that part is empty.
bool LandingSearch::ChooseRegion() {
  searched_ = image_;
  if (!hint_.center_in_camera) return true;
  const Eigen::Vector3d& center = *hint_.center_in_camera;
  const double distance = center.norm();
  Eigen::Vector2d pixel;
  if (!(distance > 0) ||
      models_.camera.Project(center, &pixel) == ProjectionStatus::kOutsideModel) {
    return false;
  }
  const double px_per_m = focal_px_ / distance;
  expected_ring_px_ = 2 * models_.options.pattern.outer_radius_m() * px_per_m;
  // The board, and three standard deviations of where its centre may be.
  const double reach = 1.2 * expected_ring_px_ + 3 * hint_.center_sigma_m * px_per_m + 8;
  // Whole tiles of the coarsest pass that may be used, so that a crop is seen as the image is.
  constexpr int kAlign = 32;
  const auto align = [](double value) {
    return static_cast<int>(std::floor(value / kAlign)) * kAlign;
  };
  const int x0 = std::max(0, align(pixel.x() - reach));
  const int y0 = std::max(0, align(pixel.y() - reach));
  const int x1 = std::min(image_.cols, align(pixel.x() + reach) + kAlign);
  const int y1 = std::min(image_.rows, align(pixel.y() + reach) + kAlign);
  if (x1 - x0 < kAlign || y1 - y0 < kAlign) return false;
  offset_ = {x0, y0};
  searched_ = image_(cv::Rect(x0, y0, x1 - x0, y1 - y0));
  return true;
}

// Whether a pass finds rings of the expected size; the coarsest ones see them too small.
bool LandingSearch::Suits(const Pass& pass) const {
  if (expected_ring_px_ == 0) return true;
  return 1.5 * pass.min_ring_px <= expected_ring_px_ && expected_ring_px_ <= 1.2 * pass.max_ring_px;
}

// Whether a ring is where the hint says that it may be; a metre of the altitude is not trusted.
bool LandingSearch::IsPlausible(const CirclePose& ring) const {
  const double distance = ring.center.norm();
  if (hint_.center_in_camera) {
    const double expected = hint_.center_in_camera->norm();
    const double tolerance = 0.25 * expected + 3 * hint_.center_sigma_m;
    if (std::abs(distance - expected) > tolerance) return false;
  }
  if (!hint_.altitude_m) return true;
  const double below = hint_.up_in_camera ? -hint_.up_in_camera->dot(ring.center) : distance;
  const double least = 0.7 * *hint_.altitude_m - 1;
  const double most = 1.4 * *hint_.altitude_m + 1;
  return below >= least && (!hint_.up_in_camera || below <= most);
}

void LandingSearch::Trace(std::size_t pass_index) {
  const Pass& pass = kPasses[pass_index];
  const cv::Mat image = buffers_.pyramid.ImageAt(pass.image_level);
  BorderTracer& tracer = buffers_.tracers[pass_index];
  if (image.empty()) {
    tracer.Clear();
    return;
  }
  Binarize(pass);
  StageTimer timer(&report_, LandingStage::kAreas);
  const double scale = 1 << pass.image_level;
  BorderLimits limits;
  limits.min_extent = std::max(4, static_cast<int>(0.7 * pass.min_ring_px / scale));
  limits.min_count = 4 * static_cast<std::size_t>(limits.min_extent);
  limits.max_extent = static_cast<int>(std::min(16000.0, 1.2 * pass.max_ring_px / scale));
  tracer.Trace(buffers_.binary, cv::Rect(0, 0, image.cols, image.rows), limits);
}

void LandingSearch::Binarize(const Pass& pass) {
  StageTimer timer(&report_, LandingStage::kBinarize);
  const cv::Mat image = buffers_.pyramid.ImageAt(pass.image_level);
  buffers_.threshold.Measure(buffers_.pyramid, pass.image_level, pass.tile_level);
  const int contrast = std::clamp(buffers_.threshold.ContrastQuantile(0.7), 12, 32);
  buffers_.threshold.Binarize(image, cv::Rect(0, 0, image.cols, image.rows), contrast,
                              &buffers_.binary);
  if (pass.not_bright) InvertBits(buffers_.binary.bright, &buffers_.binary.dark);
  if (pass.closing) CloseBits(&buffers_.binary.dark, &buffers_.scratch);
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
  for (std::size_t i = 0; i < tracer.borders().size() && candidates.size() + 2 <= kMaxCollected;
       ++i) {
    const Border& border = tracer.borders()[i];
    const std::optional<DarkArea> area =
        TestDarkArea(tracer, border, std::max(4.0, 0.7 * pass.min_ring_px / scale));
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
    const bool small = 2 * area->outline.semi_major * scale < kSmallRingPx;
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
  const std::size_t kept = std::min(candidates.size(), kMaxCandidates);
  std::partial_sort(
      candidates.begin(), candidates.begin() + static_cast<std::ptrdiff_t>(kept), candidates.end(),
      [](const RingCandidate& a, const RingCandidate& b) { return a.contrast > b.contrast; });
  candidates.resize(kept);
}

void LandingSearch::TestCandidate(const RingCandidate& candidate, std::size_t pass_index) {
  const ImageRegion region{offset_, kPasses[pass_index].image_level};
  Reach(LandingStage::kRing, "no border lies on the image of a circle");
  const bool small =
      IsSmall(2 * region.scale() *
              Eigen::Vector2d(candidate.outer_edge.semi_major, candidate.outer_edge.semi_minor));
  const std::optional<RingFit> ring = candidate.board || small ? FitToOutline(candidate, region)
                                                               : FitToBorder(candidate, pass_index);
  if (!ring) return;
  if (!IsPlausible(ring->poses[0])) return;
  const LandingPattern& pattern = models_.options.pattern;
  const bool inner = !candidate.board && !small && candidate.edge == RingEdge::kInner;
  const double to_outer = inner ? pattern.outer_radius_m() / pattern.inner_radius_m() : 1.0;
  const Eigen::Vector2d diameters_px = 2 * to_outer * focal_px_ * ring->cone.HalfAngles();
  // A print with a dark border shows less white than the board's size, and an outline that grew
  // together with what is beside it is larger than the ring.
  constexpr std::array<double, 3> kBoardScales{1.0, 1.08, 1.17};
  constexpr std::array<double, 2> kAreaScales{1.0, 1.12};
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
    TestRing(*ring, diameters_px, std::max(2.0, 0.8 * region.scale() + 0.02 * diameters_px.x()));
  }
}

std::optional<RingFit> LandingSearch::FitToBorder(const RingCandidate& candidate,
                                                  std::size_t pass_index) {
  StageTimer timer(&report_, LandingStage::kRing);
  const ImageRegion region{offset_, kPasses[pass_index].image_level};
  const BorderTracer& tracer = buffers_.tracers[pass_index];
  const Border& border = tracer.borders()[candidate.border];
  const GridPoint* points = tracer.begin(border);
  const std::size_t step = std::max<std::size_t>(1, border.count / kMaxRays);
  buffers_.rays.clear();
  for (std::size_t i = 0; i < border.count; i += step) {
    const Eigen::Vector2d pixel =
        region.ToFull(Eigen::Vector2d(points[i].x - 0.5, points[i].y - 0.5));
    const Eigen::Vector3f ray =
        models_.rays.Ray(static_cast<float>(pixel.x()), static_cast<float>(pixel.y()));
    if (ray.squaredNorm() > 0.5f) buffers_.rays.push_back(ray.cast<double>());
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

// The ring that the moments of an outline say: for outlines of few pixels, and for the board.
std::optional<RingFit> LandingSearch::FitToOutline(const RingCandidate& candidate,
                                                   const ImageRegion& region) {
  StageTimer timer(&report_, LandingStage::kRing);
  constexpr int kRays = 16;
  buffers_.rays.clear();
  for (int i = 0; i < kRays; ++i) {
    const Eigen::Vector2d pixel =
        region.ToFull(candidate.outer_edge.At(i * 2 * std::numbers::pi / kRays));
    const Eigen::Vector3f ray =
        models_.rays.Ray(static_cast<float>(pixel.x()), static_cast<float>(pixel.y()));
    if (ray.squaredNorm() < 0.5f) return std::nullopt;
    buffers_.rays.push_back(ray.cast<double>());
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
    FindArcRings(buffers_.tracers[pass_index], models_.rays, region, 0.7 * scale / focal_px_,
                 kMinCoverage, &buffers_.arcs);
  }
  for (const ArcRing& arcs : buffers_.arcs.rings) {
    Reach(LandingStage::kRing, "no border lies on the image of a circle");
    const bool inner = arcs.edge == RingEdge::kInner;
    const double radius_m = inner ? pattern.inner_radius_m() : pattern.outer_radius_m();
    const RingFit ring{arcs.cone, CirclePosesFromCone(arcs.cone, radius_m, arcs.toward)};
    if (!IsPlausible(ring.poses[0])) continue;
    const Eigen::Vector2d diameters_px =
        2 * pattern.outer_radius_m() / radius_m * focal_px_ * ring.cone.HalfAngles();
    if (IsSmall(diameters_px)) {
      TestSmallRing(ring, diameters_px, kOneScale);
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

bool LandingSearch::IsSmall(const Eigen::Vector2d& diameters_px) const {
  return diameters_px.x() < kSmallRingPx || diameters_px.y() < kThinRingPx;
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
  std::array<std::optional<Hypothesis>, 2> hypotheses;
  {
    StageTimer timer(&report_, LandingStage::kCross);
    Reach(LandingStage::kCross, "no cross inside of the ring");
    const std::array<bool, 2> allowed = LevelEnough(ring);
    for (int i = 0; i < 2; ++i) {
      if (allowed[i]) hypotheses[i] = TestPose(ring.poses[i], diameters_px.x());
    }
    const bool none = !hypotheses[0] && !hypotheses[1];
    for (int i = 0; i < 2 && none; ++i) {
      if (!allowed[i]) continue;
      hypotheses[i] = TestRefinedPose(ring.poses[i], diameters_px.x(), reach_px);
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
    const auto inside = RectifyInside(image, view, pattern, 40, kMinContrast);
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

std::optional<LandingSearch::Hypothesis> LandingSearch::TestPose(const CirclePose& pose,
                                                                 double diameter_px) {
  const ImageRegion region{offset_, ViewLevel(diameter_px)};
  const cv::Mat image = buffers_.pyramid.ImageAt(region.level);
  const double extent_m = models_.matcher.extent_m();
  const PatternView view(models_.camera, PatternPose(pose, 0), extent_m, region);
  if (!view.valid() || models_.matcher.RingContrast(image, view) < kMinRingContrast) {
    return std::nullopt;
  }
  const std::optional<VerifiedCross> cross = VerifyCross(image, view, diameter_px);
  if (!cross) return std::nullopt;
  return Compare(PatternPose(pose, cross->cross.arm_angle), cross->method, diameter_px);
}

// Where the ring is cut off or broken, what is known of it says little about its far side: the
// edges of both of its circles bring it into place before its inside is looked at.
std::optional<LandingSearch::Hypothesis> LandingSearch::TestRefinedPose(const CirclePose& pose,
                                                                        double diameter_px,
                                                                        double reach_px) {
  constexpr int kIterations = 4;
  const std::optional<RigidTransform> refined = models_.locator.LocateRing(
      image_, PatternPose(pose, 0), 1.5 * reach_px, kMinRingContrast / 2, kIterations);
  if (!refined) return std::nullopt;
  const ImageRegion region{offset_, ViewLevel(diameter_px)};
  const cv::Mat image = buffers_.pyramid.ImageAt(region.level);
  const PatternView view(models_.camera, *refined, models_.matcher.extent_m(), region);
  if (!view.valid() || models_.matcher.RingContrast(image, view) < kMinRingContrast) {
    return std::nullopt;
  }
  const std::optional<Cross> cross =
      FindCrossByProfile(image, view, models_.options.pattern, kMinRingContrast / 2);
  if (!cross) return std::nullopt;
  RigidTransform turned = *refined;
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
  if (quality < 0.7 * models_.options.min_quality) return std::nullopt;
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

// Whether nearly the same small ring was tested before, as another pass saw it; notes it if not.
bool LandingSearch::WasTested(const RingFit& ring, const Eigen::Vector2d& diameters_px) {
  constexpr double kSamePlace = 0.12;  // of its diameters
  constexpr double kSameSize = 0.1;
  SmallRingPlace place{Eigen::Vector2d::Zero(), diameters_px};
  if (models_.camera.Project(ring.poses[0].center, &place.center) ==
      ProjectionStatus::kOutsideModel) {
    return true;
  }
  const auto same = [&](const SmallRingPlace& other) {
    return (place.center - other.center).norm() < kSamePlace * diameters_px.y() &&
           ((place.diameters - other.diameters).array().abs() < kSameSize * place.diameters.array())
               .all();
  };
  std::vector<SmallRingPlace>& tested = buffers_.tested;
  if (std::any_of(tested.begin(), tested.end(), same)) return true;
  if (tested.size() < tested.capacity()) tested.push_back(place);
  return false;
}

// Rings whose strokes are no wider than the blur: the print is fitted as a whole. The ring may be
// smaller than it was seen by the given factors.
void LandingSearch::TestSmallRing(const RingFit& ring, const Eigen::Vector2d& diameters_px,
                                  std::span<const double> scales) {
  if (diameters_px.x() < kMinMajorPx || diameters_px.y() < 0.7 * models_.options.min_ring_px) {
    return;
  }
  StageTimer timer(&report_, LandingStage::kCross);
  Reach(LandingStage::kCross, "no cross inside of the ring");
  if (WasTested(ring, diameters_px)) return;
  const std::array<bool, 2> allowed = LevelEnough(ring);
  for (int i = 0; i < 2; ++i) {
    if (!allowed[i]) continue;
    const auto find_start = [&](std::optional<double> arm_angle) {
      return models_.small.FindStart(image_, ring.poses[i], scales, arm_angle, &buffers_.small);
    };
    SmallPatternFitter::Start start{{}, -1};
    if (const auto arm_angle = ArmAngleByQuadrants(ring.poses[i])) start = find_start(arm_angle);
    if (start.correlation < kSureCorrelation) start = find_start(std::nullopt);
    // The two poses of a small ring look much the same: what does not fit one fits neither.
    if (start.correlation < kMinCorrelation) return;
    Reach(LandingStage::kMatch, "ring and cross do not look like the pattern");
    constexpr int kIterations = 8;
    const auto fit =
        models_.small.Refine(image_, start.camera_from_pattern, kIterations, &buffers_.small);
    if (!fit || fit->correlation < kMinCorrelationOfEither) return;
    if (!Agrees(start.camera_from_pattern, fit->location.camera_from_pattern,
                models_.options.pattern.outer_radius_m())) {
      continue;
    }
    const double quality = fit->match.Quality();
    Reach(LandingStage::kLocate, "no pose explains the edges of ring and cross");
    // What the print does not explain is spread evenly where the print is: a sign with another
    // figure in the ring leaves more inside, one in another frame more on the ring and around it.
    // So few pixels tell less than the edges of a near pattern: more is asked of them.
    const double on_print = std::max(fit->inside_residual, fit->ring_residual);
    if (quality < models_.options.min_quality + SmallMargin(diameters_px) ||
        fit->correlation < kMinFittedCorrelation ||
        fit->inside_residual - fit->ring_residual > kMaxMoreInside ||
        fit->ring_residual - fit->inside_residual > kMaxMoreOnRing ||
        fit->white_residual > on_print + kMaxMoreOutside || IsOtherSign(fit->others)) {
      continue;
    }
    Keep(fit->location, fit->match.seen < kWhole ? CrossMethod::kPartial : CrossMethod::kQuadrants,
         quality, diameters_px);
  }
}

void LandingSearch::Locate(const Hypothesis& hypothesis, const Eigen::Vector2d& diameters_px,
                           double reach_px) {
  StageTimer timer(&report_, LandingStage::kLocate);
  Reach(LandingStage::kLocate, "no pose explains the edges of ring and cross");
  constexpr int kIterations = 3;
  const std::optional<PatternLocation> location =
      models_.locator.Locate(image_, hypothesis.camera_from_pattern, reach_px,
                             std::max(2.0, 0.12 * hypothesis.contrast), kIterations);
  if (!location || location->edge_rms_px > kMaxEdgeRmsPx) return;
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
  if (diameters_px.x() < kInspectedRingPx) {
    const auto others =
        models_.small.Inspect(image_, location->camera_from_pattern, &buffers_.small);
    if (others && IsOtherSign(*others)) return;
  }
  Keep(*location, match.seen < kWhole ? CrossMethod::kPartial : hypothesis.method, quality,
       diameters_px);
}

// Makes the location the detection, unless there is a better one. Where the image supports two
// poses of the same ring alike, the other is told as well.
void LandingSearch::Keep(const PatternLocation& location, CrossMethod method, double quality,
                         const Eigen::Vector2d& diameters_px) {
  LandingDetection detection;
  detection.camera_from_pattern = location.camera_from_pattern;
  detection.covariance = location.covariance;
  detection.method = method;
  detection.quality = quality;
  detection.ring_semi_major_px = 0.5 * diameters_px.x();
  detection.ring_semi_minor_px = 0.5 * diameters_px.y();
  if (models_.camera.Project(detection.camera_from_pattern.translation, &detection.center_px) ==
      ProjectionStatus::kOutsideModel) {
    return;
  }
  Reach(LandingStage::kFound, {});
  std::optional<LandingDetection>& best = report_.detection;
  const bool better = !best || quality > best->quality;
  if (best && AreMirrorPoses(*best, detection)) {
    LandingDetection& winner = better ? detection : *best;
    winner.mirror_camera_from_pattern =
        better ? best->camera_from_pattern : detection.camera_from_pattern;
  }
  if (better) best = detection;
}

}  // namespace kestrel
