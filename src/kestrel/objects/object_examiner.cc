// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/objects/object_examiner.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Geometry>

namespace kestrel {
namespace {

// What a colour that is none of the model's would have as its density: even over the colours.
constexpr double kBackgroundLogDensity = -8;

// Naive Bayes with equal priors (paper, section 3.6 for scores, 3.2 for colours).
ColorProbabilities ProbabilitiesOf(const ColorModel& model, const Hsv& color) {
  ColorProbabilities probabilities{};
  double best = kBackgroundLogDensity;
  for (const ColorMixture& mixture : model.colors) {
    best = std::max(best, mixture.LogLikelihood(color));
  }
  double total = std::exp(kBackgroundLogDensity - best);
  for (std::size_t i = 0; i < model.colors.size(); ++i) {
    probabilities[i] = std::exp(model.colors[i].LogLikelihood(color) - best);
    total += probabilities[i];
  }
  for (double& p : probabilities) p /= total;
  return probabilities;
}

// Share of the ellipse's pixels in the image that are the segment's.
double FilledShare(const Segment& segment, const Ellipse& ellipse, const cv::Size& image) {
  const Eigen::Vector2d along = ellipse.major_axis() / ellipse.semi_major;
  const Eigen::Vector2d across = ellipse.minor_axis() / ellipse.semi_minor;
  const auto is_inside = [&](int u, int v) {
    const Eigen::Vector2d offset = Eigen::Vector2d(u, v) - ellipse.center;
    return std::hypot(along.dot(offset), across.dot(offset)) <= 1;
  };
  const auto first = [&](double x) {
    return std::max(0, static_cast<int>(x - ellipse.semi_major));
  };
  const auto last = [&](double x, int size) {
    return std::min(size - 1, static_cast<int>(x + ellipse.semi_major));
  };
  int all = 0;
  for (int v = first(ellipse.center.y()); v <= last(ellipse.center.y(), image.height); ++v) {
    for (int u = first(ellipse.center.x()); u <= last(ellipse.center.x(), image.width); ++u) {
      all += is_inside(u, v);
    }
  }
  const auto filled = std::ranges::count_if(
      segment.pixels, [&](const PixelPosition& at) { return is_inside(at.u, at.v); });
  return static_cast<double>(filled) / std::max(1, all);
}

}  // namespace

bool ObjectExaminer::Run(const Segment& segment) {
  const ObjectDetectorOptions& options = detector_.options_;
  const auto count = [&](ObjectStage stage) { ++report_->passed[static_cast<int>(stage)]; };
  count(ObjectStage::kSegmented);
  if (static_cast<int>(segment.pixels.size()) < options.min_pixels) return false;
  count(ObjectStage::kSize);
  const SegmentShape shape = MeasureShape(image_, segment);
  ObjectDetection detection;
  detection.ellipse = shape.ellipse;
  detection.roundness = shape.roundness;
  detection.circularity = shape.circularity;
  detection.pixels = static_cast<int>(segment.pixels.size());
  detection.mean_color = shape.mean_color;
  detection.color_probabilities = ProbabilitiesOf(detector_.model_.colors, shape.mean_color);
  detection.center_px = shape.moments.centroid;
  detection.bearing = RayAt(detection.center_px);

  ObjectStage furthest = ObjectStage::kSize;
  bool is_object = false;
  const auto& classes = detector_.model_.classes;
  for (std::size_t i = 0; i < classes.size() && !is_object; ++i) {
    if (classes[i].color + 1 != segment.label) continue;
    ObjectStage reached = ObjectStage::kSize;
    is_object = TestClass(segment, shape, i, &detection, &reached);
    furthest = std::max(furthest, reached);
  }
  for (int stage = static_cast<int>(ObjectStage::kRoundness); stage <= static_cast<int>(furthest);
       ++stage) {
    ++report_->passed[stage];
  }
  if (!is_object) is_object = TestMerged(segment, shape, &detection);
  if (is_object) report_->detections.push_back(detection);
  return is_object;
}

bool ObjectExaminer::TestClass(const Segment& segment, const SegmentShape& shape,
                               std::size_t class_index, ObjectDetection* detection,
                               ObjectStage* reached) {
  const ObjectClass& object = detector_.model_.classes[class_index];
  detection->class_index = class_index;
  detection->class_probability = detection->color_probabilities[object.color];
  detection->completeness = segment.touches_border ? Completeness::kCutOff : Completeness::kWhole;
  const bool is_round = std::abs(shape.roundness - 1) <= detector_.options_.max_roundness_error;
  if (object.shape != ObjectShape::kBar && !is_round) return false;
  *reached = ObjectStage::kRoundness;
  switch (object.shape) {
    case ObjectShape::kDisc:
      return TestDisc(segment, shape, object, detection, reached);
    case ObjectShape::kCuboid:
      return TestCuboid(segment, object, detection, reached);
    case ObjectShape::kBar:
      return TestBar(segment, shape, object, detection, reached);
  }
  return false;
}

bool ObjectExaminer::TestDisc(const Segment& segment, const SegmentShape& shape,
                              const ObjectClass& object, ObjectDetection* detection,
                              ObjectStage* reached) {
  const ObjectDetectorOptions& options = detector_.options_;
  Ellipse start = shape.ellipse;
  if (segment.touches_border) {
    FindBorder(segment, image_.size(), &workspace_->border);
    const auto ellipse = EllipseThrough(workspace_->border.points);
    if (!ellipse) return false;
    start = *ellipse;
  } else if (std::abs(shape.circularity - 1) > options.max_circularity_error) {
    return false;
  }
  *reached = ObjectStage::kShape;
  const auto outline =
      FitDiscOutline(image_, detector_.rays_, detector_.focal_px_, start, &workspace_->outline);
  if (!outline) return false;
  const double radius_px = detector_.focal_px_ * std::tan(outline->cone.HalfAngles().minCoeff());
  const double max_gap = segment.touches_border ? options.max_cut_off_gap : options.max_gap;
  if (outline->gap > max_gap || outline->outside > options.max_outside ||
      outline->fit_share < options.min_outline_share) {
    return false;
  }
  if (outline->residual_px > options.outline_tolerance * radius_px + options.outline_tolerance_px) {
    return false;
  }
  const auto ellipse = EllipseThrough(workspace_->outline.points);
  if (!ellipse || IsHole(*ellipse, segment.label) || IsRing(*ellipse, segment.label)) return false;
  if (segment.touches_border) {
    // What circularity says of a whole disc.
    constexpr double kMinFill = 0.8;
    if (FilledShare(segment, *ellipse, image_.size()) < kMinFill) return false;
  }
  *reached = ObjectStage::kOutline;
  const double radius_m = object.size_m / 2;
  const Eigen::Vector3d row_direction =
      RayAt(start.center + Eigen::Vector2d(1, 0)) - RayAt(start.center - Eigen::Vector2d(1, 0));
  Eigen::Vector3d position = LocateDisc(outline->cone, radius_m, row_direction, hint_.up_in_camera);
  const double distance = position.norm();
  if (!std::isfinite(distance) || !(distance > 0)) return false;
  if (const auto on_ground = DistanceOnGround(position, object)) {
    // A part of an outline says less: its size must say more.
    const double tolerance =
        segment.touches_border ? 0.5 * options.ground_tolerance : options.ground_tolerance;
    const double slack_rad = 1 / detector_.focal_px_;
    if (!IsOnGround(distance, *on_ground) ||
        !LooksLikeDisc(outline->cone, position / distance, *on_ground, *hint_.up_in_camera,
                       radius_m, tolerance, slack_rad)) {
      return false;
    }
  }
  *reached = ObjectStage::kPosition;
  if (!hint_.up_in_camera) {
    // Which way the disc is tilted is not known: its centre is taken for that of the ellipse.
    position = distance * RayAt(ellipse->center);
  }
  // The less of the outline is seen, the less it says.
  const double seen = 1 - outline->gap - outline->outside;
  const double less = 1 / (seen * seen);
  SetLocation(position, object, less * options.center_sigma_px,
              less * options.radius_sigma_px / radius_px, detection);
  return true;
}

std::optional<ColorLabel> ObjectExaminer::LabelAt(const Eigen::Vector2d& pixel) const {
  const cv::Point at(cvRound(pixel.x()), cvRound(pixel.y()));
  if (!cv::Rect({}, image_.size()).contains(at)) return std::nullopt;
  return detector_.grid_.At(image_.ptr(at.y) + 3 * at.x);
}

bool ObjectExaminer::IsHole(const Ellipse& outline, ColorLabel label) const {
  constexpr int kDirections = 16;
  // Times the outline: from beyond its blur to beyond the strokes of a letter, and how broad what
  // has the colour must be. A line is not.
  constexpr double kFirst = 1.3;
  constexpr double kLast = 4;
  constexpr double kMinWidth = 0.3;
  constexpr double kMinWidthPx = 3;
  constexpr double kMaxShare = 0.5;  // other discs lie around, but not on all sides
  int shown = 0;
  int same = 0;
  for (int i = 0; i < kDirections; ++i) {
    const double t = 2 * std::numbers::pi * i / kDirections;
    const Eigen::Vector2d radius = outline.At(t) - outline.center;
    const double radius_px = radius.norm();
    const Eigen::Vector2d outward = radius / radius_px;
    const double min_width_px = std::max(kMinWidthPx, kMinWidth * radius_px);
    int width_px = 0;
    bool is_shown = false;
    for (double r = kFirst * radius_px; r < kLast * radius_px && width_px < min_width_px; ++r) {
      const std::optional<ColorLabel> seen = LabelAt(outline.center + r * outward);
      if (!seen) break;
      is_shown = true;
      width_px = seen == label ? width_px + 1 : 0;
    }
    shown += is_shown;
    same += width_px >= min_width_px;
  }
  return same > kMaxShare * shown;
}

// Gray is ambiguous for the sake of digits: the hole of a ring may be part of the segment.
bool ObjectExaminer::IsRing(const Ellipse& outline, ColorLabel label) const {
  constexpr int kDirections = 16;
  constexpr std::array kShares = {0.1, 0.2, 0.3, 0.4};  // of the outline: clear of its blur
  constexpr double kMinShare = 0.5;
  int shown = 0;
  int same = 0;
  for (int i = 0; i < kDirections; ++i) {
    const Eigen::Vector2d radius =
        outline.At(2 * std::numbers::pi * i / kDirections) - outline.center;
    for (const double share : kShares) {
      const std::optional<ColorLabel> seen = LabelAt(outline.center + share * radius);
      shown += seen.has_value();
      same += seen == label;
    }
  }
  return same < kMinShare * shown;
}

// Several discs of one colour that touch make one segment. It is no disc, but as solid as one, and
// larger where the size of one is known.
bool ObjectExaminer::TestMerged(const Segment& segment, const SegmentShape& shape,
                                ObjectDetection* detection) const {
  constexpr double kMaxCircularityError = 0.4;  // three discs in a row have 0.35
  constexpr double kMinCount = 1.2;
  constexpr double kMaxCount = 8;
  constexpr double kMaxAspect = 4;  // three discs in a row have 3
  if (segment.touches_border || std::abs(shape.circularity - 1) > kMaxCircularityError ||
      shape.ellipse.semi_major > kMaxAspect * shape.ellipse.semi_minor) {
    return false;
  }
  const auto& classes = detector_.model_.classes;
  for (std::size_t i = 0; i < classes.size(); ++i) {
    if (classes[i].color + 1 != segment.label || classes[i].shape != ObjectShape::kDisc) continue;
    const std::optional<double> one_px = PixelsOnGround(detection->bearing, classes[i]);
    const double count = one_px ? shape.moments.area / *one_px : kMinCount;
    if (count < kMinCount || count > kMaxCount) continue;
    detection->class_index = i;
    detection->class_probability = detection->color_probabilities[classes[i].color];
    detection->completeness = Completeness::kMerged;
    return true;
  }
  return false;
}

std::optional<double> ObjectExaminer::PixelsOnGround(const Eigen::Vector3d& ray,
                                                     const ObjectClass& object) const {
  const auto distance = Ground().DistanceNear(ray, 0, object.height_m, object.max_height_m);
  if (!distance) return std::nullopt;
  const Eigen::Vector2d angles =
      ConeOfCircle(*distance * ray, *hint_.up_in_camera, object.size_m / 2).HalfAngles();
  return std::numbers::pi * detector_.focal_px_ * detector_.focal_px_ * angles.prod();
}

std::optional<double> ObjectExaminer::DistanceOnGround(const Eigen::Vector3d& position,
                                                       const ObjectClass& object) const {
  const double distance = position.norm();
  return Ground().DistanceNear(position / distance, distance, object.height_m, object.max_height_m);
}

bool ObjectExaminer::IsOnGround(double distance, double on_ground) const {
  const ObjectDetectorOptions& options = detector_.options_;
  return std::abs(distance - on_ground) <=
         options.ground_tolerance * on_ground + options.ground_tolerance_m;
}

void ObjectExaminer::SetLocation(const Eigen::Vector3d& by_size, const ObjectClass& object,
                                 double center_sigma_px, double relative_sigma,
                                 ObjectDetection* detection) const {
  const Eigen::Vector3d ray = by_size.normalized();
  double distance = by_size.norm();
  double sigma_m = relative_sigma * distance;
  if (const auto on_ground = DistanceOnGround(by_size, object)) {
    const double ground_sigma_m = Ground().DistanceSigma(ray, *on_ground);
    const double total = std::hypot(sigma_m, ground_sigma_m);
    const double gain = sigma_m * sigma_m / (total * total);
    distance += gain * (*on_ground - distance);
    sigma_m *= ground_sigma_m / total;
  }
  detection->bearing = ray;
  detector_.camera_.Project(ray, &detection->center_px);
  detection->location = {distance * ray,
                         LocationCovariance(distance * ray, center_sigma_px / detector_.focal_px_,
                                            sigma_m / distance)};
}

Eigen::Vector3d ObjectExaminer::RayAt(const Eigen::Vector2d& pixel) const {
  const Eigen::Vector2f at = pixel.cast<float>();
  return detector_.rays_.Ray(at.x(), at.y()).cast<double>();
}

}  // namespace kestrel
