// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/landing/landing_search.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Geometry>

namespace kestrel {
namespace {

constexpr std::size_t kMaxCollected = 512;  // candidates of a pass
constexpr std::size_t kMaxTested = 64;      // rings that are remembered
// Of a pass the borders of the highest contrast are looked at, so many: black on white stands out
// of texture, of which there may be any amount.
constexpr std::size_t kMinBorders = 24;
constexpr std::size_t kPixelsPerBorder = 8192;
constexpr double kAlike = 0.05;  // difference of two qualities that says nothing

// Largest standard deviations of the position, shares of the distance. A wrong pose of a print of
// which little is in view bends until the edges scatter little, but then they hardly hold it.
constexpr double kMaxSigma = 0.05;
constexpr double kMaxSigmaOfSmallPart = 0.02;  // of a part of a small print, fitted as a whole
constexpr double kMaxSureSigma = 0.01;         // of a part that ends the search

double RelativeSigma(const PatternLocation& location) {
  return std::sqrt(location.covariance.topLeftCorner<3, 3>().trace()) /
         location.camera_from_pattern.translation.norm();
}

// How often the mirror pose is the right one although it explains the image less well: measured on
// rendered stills, docs/location.md.
constexpr double kMirrorIsRight = 0.05;

// From one pose to the other: translation, then rotation vector, in the camera frame.
Eigen::Matrix<double, 6, 1> Difference(const RigidTransform& from, const RigidTransform& to) {
  const Eigen::AngleAxisd turn(to.rotation * from.rotation.inverse());
  Eigen::Matrix<double, 6, 1> difference;
  difference << to.translation - from.translation, turn.angle() * turn.axis();
  return difference;
}

// Whether two detections are the two poses of one ring, between which the image does not decide.
bool AreMirrorPoses(const LandingDetection& a, const LandingDetection& b) {
  constexpr double kSameCenterPx = 2;
  constexpr double kOtherNormal = 0.99;  // cosine between the normals
  constexpr double kLikeQuality = 0.2;   // the wrong one bends the print out of its place
  const Eigen::Vector3d z = Eigen::Vector3d::UnitZ();
  return std::abs(a.quality - b.quality) < kLikeQuality &&
         (a.center_px - b.center_px).norm() < kSameCenterPx &&
         (a.camera_from_pattern.rotation * z).dot(b.camera_from_pattern.rotation * z) <
             kOtherNormal;
}

}  // namespace

// Near patterns first: they are found at a sixteenth of the cost, and matter most.
const std::array<LandingSearch::Pass, LandingWorkspace::Buffers::kPasses> LandingSearch::kPasses = {
    {
        {.image_level = 3, .tile_level = 5, .min_ring_px = 64, .max_ring_px = 1e9},
        {.image_level = 2, .tile_level = 4, .min_ring_px = 32, .max_ring_px = 400},
        {.image_level = 1, .tile_level = 3, .min_ring_px = 16, .max_ring_px = 200},
        {.image_level = 3, .tile_level = 5, .min_ring_px = 64, .max_ring_px = 1e9, .black = true},
        {.image_level = 2, .tile_level = 4, .min_ring_px = 32, .max_ring_px = 400, .black = true},
        {.image_level = 1, .tile_level = 3, .min_ring_px = 16, .max_ring_px = 200, .black = true},
        {.image_level = 0,
         .tile_level = 1,
         .min_ring_px = 6,
         .max_ring_px = 120,
         .top_hat = true,
         .narrow = true},
        {.image_level = 0, .tile_level = 1, .min_ring_px = 6, .max_ring_px = 120, .closing = true},
        {.image_level = 0, .tile_level = 2, .min_ring_px = 6, .max_ring_px = 120, .narrow = true},
        {.image_level = 0,
         .tile_level = 3,
         .min_ring_px = 6,
         .max_ring_px = 120,
         .not_bright = true},
    }};

LandingSearch::LandingSearch(const LandingModels& models, const cv::Mat& image,
                             const LandingHint& hint, LandingWorkspace::Buffers* buffers)
    : models_(models),
      image_(image),
      hint_(hint),
      buffers_(*buffers),
      focal_px_(models.camera.intrinsics().fx_px) {
  constexpr double kRadians = std::numbers::pi / 180;
  if (hint.up_in_camera) {
    level_ = {*hint.up_in_camera, models.options.level_sigma_deg * kRadians};
  }
}

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
    if (i < kFirstFinePass) most_points = std::max(most_points, buffers_.tracers[i].capacity());
  }
  buffers_.candidates.reserve(kMaxCollected);
  buffers_.rays.reserve(2 * LandingWorkspace::Buffers::kMaxRays);
  buffers_.arcs.Reserve(most_points);
  buffers_.cross_lines.Reserve();
  buffers_.partial.Reserve(most_points);
  buffers_.tested_small.reserve(kMaxTested);
  buffers_.tested_large.reserve(kMaxTested);
  buffers_.other_signs.reserve(kMaxTested);
}

LandingReport LandingSearch::Run() {
  MakeRoom();
  buffers_.tested_small.clear();
  buffers_.tested_large.clear();
  buffers_.other_signs.clear();
  report_.reason = "no outline that could be a ring";
  if (TestPrediction()) return report_;
  if (ChooseRegion(hint_.center_sigma_m)) {
    SearchRegion();
  } else {
    report_.reason = "the hint points out of the image";
  }
  return report_;
}

void LandingSearch::SearchRegion() {
  BuildPyramid();
  // Closed areas are the cheaper way to the ring, arcs the surer one.
  const auto run = [this](std::size_t first, std::size_t last, auto test) {
    for (std::size_t i = first; i < last && !is_sure_; ++i) {
      if (Suits(kPasses[i])) test(i);
    }
  };
  const auto trace_and_test = [this](std::size_t i) {
    Trace(i);
    TestAreas(i);
  };
  const auto test_arcs = [this](std::size_t i) { TestArcs(i); };
  const auto test_cut_areas = [this](std::size_t i) { TestCutAreas(i); };
  run(0, kCoarsePasses, trace_and_test);
  run(0, kCoarsePasses, test_arcs);
  run(kCoarsePasses, kFirstFinePass, [this](std::size_t i) {
    Trace(i);
    TestArcs(i);
  });
  const bool low = !hint_.altitude_m || *hint_.altitude_m <= models_.options.max_partial_altitude_m;
  if (low) run(0, kPartialPasses, [this](std::size_t i) { TestPartial(i); });
  run(kFirstFinePass, kPasses.size(), trace_and_test);
  run(kCoarsePasses - 1, kCoarsePasses, test_cut_areas);
  run(kFirstFinePass, kPasses.size(), test_cut_areas);
  run(kFirstFinePass, kPasses.size(), test_arcs);
}

void LandingSearch::BuildPyramid(int last_level) {
  StageTimer timer(&report_, LandingStage::kBinarize);
  buffers_.pyramid.Build(searched_, last_level);
}

// Diameter of a ring that faces the camera.
double LandingSearch::ExpectedRingPx(const Eigen::Vector3d& center) const {
  const double radius = models_.options.pattern.outer_radius_m();
  const Eigen::Vector3d across = radius * center.unitOrthogonal();
  Eigen::Vector2d a, b;
  if (models_.camera.Project(center + across, &a) == ProjectionStatus::kOutsideModel ||
      models_.camera.Project(center - across, &b) == ProjectionStatus::kOutsideModel) {
    return 2 * focal_px_ * std::atan2(radius, center.norm());
  }
  return (a - b).norm();
}

// Sets the part of the image that the hint leaves, when its centre has this standard deviation, and
// the size of the ring that it says. False when that part is empty.
bool LandingSearch::ChooseRegion(double sigma_m) {
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
  expected_ring_px_ = ExpectedRingPx(center);
  // The board, and three standard deviations of where its centre may be.
  const double reach = 1.2 * expected_ring_px_ + 3 * sigma_m * px_per_m + 8;
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

// Whether a ring is where the hint says that it may be. The altitude may be that above the ground
// on which a vehicle stands.
bool LandingSearch::IsPlausible(const CirclePose& ring) const {
  const double distance = ring.center.norm();
  if (hint_.center_in_camera) {
    const double expected = hint_.center_in_camera->norm();
    const double tolerance = 0.25 * expected + 3 * hint_.center_sigma_m;
    if (std::abs(distance - expected) > tolerance) return false;
  }
  if (!hint_.altitude_m) return true;
  const double below = hint_.up_in_camera ? -hint_.up_in_camera->dot(ring.center) : distance;
  constexpr double kMaxVehicleHeight = 3;
  const double least = 0.7 * *hint_.altitude_m - kMaxVehicleHeight;
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
  limits.narrow = pass.narrow;
  tracer.Trace(buffers_.binary, cv::Rect(0, 0, image.cols, image.rows), limits);
  const std::size_t by_size = image.total() / kPixelsPerBorder;
  tracer.KeepStrongest(image, std::max(kMinBorders, by_size));
}

void LandingSearch::Binarize(const Pass& pass) {
  StageTimer timer(&report_, LandingStage::kBinarize);
  const cv::Mat image = buffers_.pyramid.ImageAt(pass.image_level);
  buffers_.threshold.Measure(buffers_.pyramid, pass.image_level, pass.tile_level);
  const int contrast = std::clamp(buffers_.threshold.ContrastQuantile(0.7), 12, 32);
  using Dark = LocalThreshold::Dark;
  if (pass.top_hat) {
    buffers_.top_hat.Binarize(image, contrast, &buffers_.binary);
  } else {
    buffers_.threshold.Binarize(image, contrast, &buffers_.binary,
                                pass.black ? Dark::kBlack : Dark::kBelowMean);
  }
  if (pass.not_bright) InvertBits(buffers_.binary.bright, &buffers_.binary.dark);
  if (pass.closing) CloseBits(&buffers_.binary.dark, &buffers_.scratch);
}

// Whether 'a' explains the image better than 'b'. Of poses that agree alike with the part of a
// print that is in view, the one is right whose edges lie nearer.
bool LandingSearch::IsBetter(const Found& a, const Found& b) {
  const LandingDetection& one = a.detection;
  const LandingDetection& other = b.detection;
  const bool partial = one.method == CrossMethod::kPartial && other.method == CrossMethod::kPartial;
  const bool by_edges = a.edge_rms_px > 0 && b.edge_rms_px > 0;
  if (partial && by_edges && std::abs(one.quality - other.quality) < kAlike) {
    return a.edge_rms_px < b.edge_rms_px;
  }
  return one.quality > other.quality;
}

// Of the two poses of one ring: shares of contrasts that are in their place are the same under
// both, how near to it they are is not.
bool LandingSearch::IsBetterMirror(const Found& a, const Found& b) {
  if (a.edge_rms_px > 0 && b.edge_rms_px > 0) return a.edge_rms_px < b.edge_rms_px;
  if (a.gray_rms > 0 && b.gray_rms > 0) return a.gray_rms < b.gray_rms;
  return IsBetter(a, b);
}

// Makes the location the detection, unless there is a better one.
void LandingSearch::Keep(const PatternLocation& location, CrossMethod method, double quality,
                         const Eigen::Vector2d& diameters_px) {
  const double sigma = RelativeSigma(location);
  const bool is_part = method == CrossMethod::kPartial;
  const bool by_edges = location.edges > 0;
  if (!(sigma <= (is_part && !by_edges ? kMaxSigmaOfSmallPart : kMaxSigma))) return;
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
  if (KeepBetter({detection, location.edge_rms_px, location.gray_rms})) {
    is_sure_ = !is_part || sigma <= kMaxSureSigma;
  }
  ReportBest();
}

// Whether what was found is the best so far.
bool LandingSearch::KeepBetter(const Found& found) {
  if (best_ && AreMirrorPoses(best_->detection, found.detection)) {
    const bool better = IsBetterMirror(found, *best_);
    mirror_ = better ? best_ : found;
    if (better) best_ = found;
    return better;
  }
  if (best_ && !IsBetter(found, *best_)) return false;
  if (mirror_ && !AreMirrorPoses(mirror_->detection, found.detection)) mirror_.reset();
  best_ = found;
  return true;
}

// Where the image supports two poses of the same ring alike, the other is told as well, and the
// covariance is that of both together.
void LandingSearch::ReportBest() {
  report_.detection = best_->detection;
  if (!mirror_) return;
  LandingDetection& detection = *report_.detection;
  detection.mirror_camera_from_pattern = mirror_->detection.camera_from_pattern;
  const Eigen::Matrix<double, 6, 1> difference =
      Difference(detection.camera_from_pattern, *detection.mirror_camera_from_pattern);
  detection.covariance += kMirrorIsRight * difference * difference.transpose();
}

}  // namespace kestrel
