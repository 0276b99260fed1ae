// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/objects/object_examiner.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Geometry>

#include "kestrel/vision/objects/disc_location.h"

namespace kestrel {
namespace {

// Log density of a colour that is none of the model's: uniform over the colours.
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

// Returns the share of the ellipse's pixels in the image that belong to the segment.
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
  const ObjectDetectorOptions& options = detector_.options;
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
  detection.color_probabilities = ProbabilitiesOf(detector_.model.colors, shape.mean_color);
  detection.center_px = shape.moments.centroid;
  detection.bearing = RayAt(detection.center_px);

  ObjectStage furthest = ObjectStage::kSize;
  Outcome outcome = Outcome::kNone;
  ObjectDetection found;
  const auto& classes = detector_.model.classes;
  for (std::size_t i = 0; i < classes.size() && outcome != Outcome::kObject; ++i) {
    if (classes[i].color + 1 != segment.label) continue;
    ObjectStage reached = ObjectStage::kSize;
    ObjectDetection candidate = detection;
    const Outcome tested = TestClass(segment, shape, i, &candidate, &reached);
    furthest = std::max(furthest, reached);
    if (tested <= outcome) continue;
    outcome = tested;
    found = candidate;
  }
  for (int stage = static_cast<int>(ObjectStage::kRoundness); stage <= static_cast<int>(furthest);
       ++stage) {
    ++report_->passed[stage];
  }
  if (outcome == Outcome::kNone && TestMerged(segment, shape, &detection)) {
    outcome = Outcome::kObject;
    found = detection;
  }
  if (outcome == Outcome::kObject) report_->detections.push_back(found);
  if (outcome == Outcome::kElsewhere) report_->elsewhere.push_back(found);
  return outcome == Outcome::kObject;
}

ObjectExaminer::Outcome ObjectExaminer::TestClass(const Segment& segment, const SegmentShape& shape,
                                                  std::size_t class_index,
                                                  ObjectDetection* detection,
                                                  ObjectStage* reached) {
  const ObjectClass& object = detector_.model.classes[class_index];
  detection->class_index = class_index;
  detection->class_probability = ClassProbability(object, detection->color_probabilities);
  detection->completeness = segment.touches_border ? Completeness::kCutOff : Completeness::kWhole;
  const bool is_round = std::abs(shape.roundness - 1) <= detector_.options.max_roundness_error;
  if (object.shape != ObjectShape::kBar && !is_round) return Outcome::kNone;
  *reached = ObjectStage::kRoundness;
  switch (object.shape) {
    case ObjectShape::kDisc:
      return TestDisc(segment, shape, object, detection, reached);
    case ObjectShape::kCuboid:
      return TestCuboid(segment, object, detection, reached);
    case ObjectShape::kBar:
      return TestBar(segment, shape, object, detection, reached);
  }
  return Outcome::kNone;
}

ObjectExaminer::Outcome ObjectExaminer::TestDisc(const Segment& segment, const SegmentShape& shape,
                                                 const ObjectClass& object,
                                                 ObjectDetection* detection, ObjectStage* reached) {
  const ObjectDetectorOptions& options = detector_.options;
  Ellipse start = shape.ellipse;
  if (segment.touches_border) {
    FindBorder(segment, image_.size(), &workspace_->border);
    const auto ellipse = EllipseThrough(workspace_->border.points);
    if (!ellipse) return Outcome::kNone;
    start = *ellipse;
  } else if (std::abs(shape.circularity - 1) > options.max_circularity_error) {
    return Outcome::kNone;
  }
  *reached = ObjectStage::kShape;
  const auto outline =
      FitDiscOutline(image_, detector_.rays, detector_.focal_px, start, &workspace_->outline);
  if (!outline) return Outcome::kNone;
  const double radius_px = detector_.focal_px * std::tan(outline->cone.HalfAngles().minCoeff());
  const double max_gap = segment.touches_border ? options.max_cut_off_gap : options.max_gap;
  if (outline->gap > max_gap || outline->outside > options.max_outside ||
      outline->fit_share < options.min_outline_share) {
    return Outcome::kNone;
  }
  if (outline->residual_px > options.outline_tolerance * radius_px + options.outline_tolerance_px) {
    return Outcome::kNone;
  }
  const auto ellipse = EllipseThrough(workspace_->outline.points);
  if (!ellipse || IsHole(*ellipse, segment.label)) return Outcome::kNone;
  // A ring: gray is ambiguous for the sake of digits, so its hole may be part of the segment.
  if (ColoredShare(*ellipse, 0.4, segment.label) < 0.5) return Outcome::kNone;
  if (segment.touches_border) {
    // Replaces the test of circularity of a whole disc.
    constexpr double kMinFill = 0.8;
    if (FilledShare(segment, *ellipse, image_.size()) < kMinFill) return Outcome::kNone;
  }
  *reached = ObjectStage::kOutline;
  const double radius_m = object.size_m / 2;
  const Eigen::Vector3d row_direction =
      RayAt(start.center + Eigen::Vector2d(1, 0)) - RayAt(start.center - Eigen::Vector2d(1, 0));
  Eigen::Vector3d position = LocateDisc(outline->cone, radius_m, row_direction, hint_.up_in_camera);
  const double distance = position.norm();
  if (!std::isfinite(distance) || !(distance > 0)) return Outcome::kNone;
  detection->misfit = MisfitOfDisc(*outline, radius_px, segment, shape, *ellipse);
  // A partial disc must look more like a disc: the corner of a triangle may have an ellipse through
  // it.
  constexpr double kMaxMisfitOfPart = 0.6;
  if (segment.touches_border && detection->misfit > kMaxMisfitOfPart) return Outcome::kNone;
  Outcome outcome = Outcome::kObject;
  // A partial outline determines the distance less well, and its shape must fit better.
  const double tolerance = (segment.touches_border ? 0.7 : 1) * options.ground_tolerance;
  const double distance_tolerance = (segment.touches_border ? 1.4 : 1) * options.ground_tolerance;
  if (const auto is_on_ground = IsOnGround(position, object, distance_tolerance)) {
    const double slack_rad = 1 / detector_.focal_px;
    const auto looks_like_disc_at = [&](double there) {
      return LooksLikeDisc(outline->cone, position / distance, there, *hint_.up_in_camera, radius_m,
                           tolerance, slack_rad);
    };
    if (!*is_on_ground || !looks_like_disc_at(*DistanceOnGround(position, object))) {
      if (!looks_like_disc_at(distance)) return Outcome::kNone;
      outcome = Outcome::kElsewhere;
    }
  }
  if (outcome == Outcome::kObject) *reached = ObjectStage::kPosition;
  if (!hint_.up_in_camera) {
    // The tilt of the disc is unknown: the centre of the ellipse is taken for that of the disc.
    position = distance * RayAt(ellipse->center);
  }
  // The uncertainty grows as less of the outline is seen.
  const double seen = 1 - outline->gap - outline->outside;
  const double less = 1 / (seen * seen);
  SetLocation(position, object, less * options.center_sigma_px,
              less * options.radius_sigma_px / radius_px, outcome, detection);
  return outcome;
}

std::optional<ColorLabel> ObjectExaminer::LabelAt(const Eigen::Vector2d& pixel) const {
  const cv::Point at(cvRound(pixel.x()), cvRound(pixel.y()));
  if (!cv::Rect({}, image_.size()).contains(at)) return std::nullopt;
  return detector_.grid.At(image_.ptr(at.y) + 3 * at.x);
}

bool ObjectExaminer::IsHole(const Ellipse& outline, ColorLabel label) const {
  constexpr int kDirections = 16;
  // In radii of the outline: search from beyond its blur to beyond the strokes of a letter, and
  // least width of the coloured area. A line is thinner.
  constexpr double kFirst = 1.3;
  constexpr double kLast = 4;
  constexpr double kMinWidth = 0.3;
  constexpr double kMinWidthPx = 3;
  constexpr double kMaxShare = 0.5;  // other discs may lie around, but not on all sides
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

double ObjectExaminer::ColoredShare(const Ellipse& outline, double reach, ColorLabel label) const {
  constexpr int kDirections = 16;
  constexpr int kSteps = 4;
  int shown = 0;
  int same = 0;
  for (int i = 0; i < kDirections; ++i) {
    const Eigen::Vector2d radius =
        outline.At(2 * std::numbers::pi * i / kDirections) - outline.center;
    for (int step = 1; step <= kSteps; ++step) {
      const std::optional<ColorLabel> seen =
          LabelAt(outline.center + reach * step / kSteps * radius);
      shown += seen.has_value();
      same += seen == label;
    }
  }
  return static_cast<double>(same) / std::max(1, shown);
}

double ObjectExaminer::MisfitOfDisc(const DiscOutline& outline, double radius_px,
                                    const Segment& segment, const SegmentShape& shape,
                                    const Ellipse& ellipse) const {
  constexpr double kClearOfBlur = 0.7;
  constexpr double kMaxUncolored = 0.3;
  const auto square = [](double x) { return x * x; };
  const ObjectDetectorOptions& options = detector_.options;
  const double edge =
      outline.residual_px / (options.outline_tolerance * radius_px + options.outline_tolerance_px);
  const double hidden = (1 - (1 - outline.gap) * outline.fit_share) / options.max_gap;
  const double filling =
      segment.touches_border ? 0 : (shape.circularity - 1) / options.max_circularity_error;
  const double uncolored = (1 - ColoredShare(ellipse, kClearOfBlur, segment.label)) / kMaxUncolored;
  return square(edge) + square(hidden) + square(filling) + square(uncolored);
}

double ObjectExaminer::ClassProbability(const ObjectClass& object,
                                        const ColorProbabilities& colors) const {
  double all = 1;  // including the probability of background
  for (std::size_t i = 0; i < detector_.model.colors.colors.size(); ++i) {
    const bool has_class = std::ranges::any_of(
        detector_.model.classes,
        [&](const ObjectClass& other) { return other.color == i && other.shape == object.shape; });
    if (!has_class) all -= colors[i];
  }
  return colors[object.color] / all;
}

std::optional<double> ObjectExaminer::DistanceOnGround(const Eigen::Vector3d& position,
                                                       const ObjectClass& object) const {
  const double distance = position.norm();
  return Ground().DistanceNear(position / distance, distance, object.height_m, object.max_height_m);
}

std::optional<bool> ObjectExaminer::IsOnGround(const Eigen::Vector3d& position,
                                               const ObjectClass& object, double tolerance) const {
  if (!Ground().is_known()) return std::nullopt;
  const auto on_ground = DistanceOnGround(position, object);
  return on_ground && std::abs(position.norm() - *on_ground) <=
                          tolerance * *on_ground + detector_.options.ground_tolerance_m;
}

void ObjectExaminer::SetLocation(const Eigen::Vector3d& by_size, const ObjectClass& object,
                                 double center_sigma_px, double relative_sigma, Outcome outcome,
                                 ObjectDetection* detection) const {
  const Eigen::Vector3d ray = by_size.normalized();
  double distance = by_size.norm();
  double sigma_m = relative_sigma * distance;
  if (hint_.up_in_camera) {
    const double descent = -hint_.up_in_camera->dot(ray);
    detection->height = {
        distance * descent + 0.5 * (object.height_m + object.max_height_m),
        std::hypot(sigma_m * descent, 0.5 * (object.max_height_m - object.height_m))};
  }
  const auto on_ground = DistanceOnGround(by_size, object);
  if (on_ground && outcome == Outcome::kObject) {
    const double ground_sigma_m = Ground().DistanceSigma(ray, *on_ground);
    const double total = std::hypot(sigma_m, ground_sigma_m);
    const double gain = sigma_m * sigma_m / (total * total);
    distance += gain * (*on_ground - distance);
    sigma_m *= ground_sigma_m / total;
  }
  detection->bearing = ray;
  detector_.camera.Project(ray, &detection->center_px);
  detection->location = {
      distance * ray,
      LocationCovariance(distance * ray, center_sigma_px / detector_.focal_px, sigma_m / distance)};
}

Eigen::Vector3d ObjectExaminer::RayAt(const Eigen::Vector2d& pixel) const {
  const Eigen::Vector2f at = pixel.cast<float>();
  return detector_.rays.Ray(at.x(), at.y()).cast<double>();
}

}  // namespace kestrel
