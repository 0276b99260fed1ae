// SPDX-License-Identifier: BSD-3-Clause
// The tests of a disc.
#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Geometry>

#include "kestrel/vision/objects/examination/object_examiner.h"
#include "kestrel/vision/objects/location/disc_location.h"

namespace kestrel {
namespace {

constexpr int kDirections = 16;  // in which a disc and its surroundings are looked at
// A ring: gray is ambiguous for the sake of digits, so its hole may be part of the segment. Radius
// of the middle (of the outline's) and least share of it that has the colour.
constexpr double kMiddle = 0.4;
constexpr double kMinColoredMiddle = 0.5;
// Limits for a disc that the image border cuts off. The filling replaces the test of circularity,
// and the disc must fit better: the corner of a triangle may have an ellipse through it.
constexpr double kMinFillOfPart = 0.8;
constexpr double kMaxMisfitOfPart = 0.6;

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

double OutlineTolerance(double radius_px) {
  return ObjectDetectorOptions::kOutlineTolerance * radius_px +
         ObjectDetectorOptions::kOutlineTolerance_px;
}

}  // namespace

ObjectExaminer::Outcome ObjectExaminer::TestDisc(const Segment& segment, const SegmentShape& shape,
                                                 const ObjectClass& object,
                                                 ObjectDetection* detection, ObjectStage* reached) {
  const std::optional<Ellipse> start = StartOfDisc(segment, shape);
  if (!start) return Outcome::kNone;
  *reached = ObjectStage::kShape;
  const auto outline =
      FitDiscOutline(image_, detector_.rays, detector_.focal_px, *start, &workspace_->outline);
  if (!outline) return Outcome::kNone;
  const double radius_px = detector_.focal_px * std::tan(outline->cone.HalfAngles().minCoeff());
  if (!FitsDisc(*outline, radius_px, segment.touches_border)) return Outcome::kNone;
  const auto ellipse = EllipseThrough(workspace_->outline.points);
  if (!ellipse || !IsFilledDisc(segment, *ellipse)) return Outcome::kNone;
  *reached = ObjectStage::kOutline;
  const Eigen::Vector3d row_direction =
      RayAt(start->center + Eigen::Vector2d(1, 0)) - RayAt(start->center - Eigen::Vector2d(1, 0));
  Eigen::Vector3d position =
      LocateDisc(outline->cone, object.size_m / 2, row_direction, hint_.up_in_camera);
  const double distance = position.norm();
  if (!std::isfinite(distance) || !(distance > 0)) return Outcome::kNone;
  detection->misfit = MisfitOfDisc(*outline, radius_px, segment, shape, *ellipse);
  if (segment.touches_border && detection->misfit > kMaxMisfitOfPart) return Outcome::kNone;
  const Outcome outcome = PlaceDisc(outline->cone, position, object);
  if (outcome == Outcome::kNone) return outcome;
  if (outcome == Outcome::kObject) *reached = ObjectStage::kPosition;
  if (!hint_.up_in_camera) {
    // The tilt of the disc is unknown: the centre of the ellipse is taken for that of the disc.
    position = distance * RayAt(ellipse->center);
  }
  // The uncertainty grows as less of the outline is seen.
  const double seen = 1 - outline->gap - outline->outside;
  const double less = 1 / (seen * seen);
  SetLocation(position, object, less * ObjectDetectorOptions::kCenterSigma_px,
              less * ObjectDetectorOptions::kRadiusSigma_px / radius_px, outcome, detection);
  return outcome;
}

// Returns the ellipse to search the outline at; nothing for the shape of something else.
std::optional<Ellipse> ObjectExaminer::StartOfDisc(const Segment& segment,
                                                   const SegmentShape& shape) {
  if (segment.touches_border) {
    FindBorder(segment, image_.size(), &workspace_->border);
    return EllipseThrough(workspace_->border.points);
  }
  const bool is_round = std::abs(shape.circularity - 1) <= detector_.options.max_circularity_error;
  return is_round ? std::optional(shape.ellipse) : std::nullopt;
}

bool ObjectExaminer::FitsDisc(const DiscOutline& outline, double radius_px, bool is_cut_off) const {
  const ObjectDetectorOptions& options = detector_.options;
  return outline.gap <= (is_cut_off ? ObjectDetectorOptions::kMaxCutOffGap : options.max_gap) &&
         outline.outside <= ObjectDetectorOptions::kMaxOutside &&
         outline.fit_share >= ObjectDetectorOptions::kMinOutlineShare &&
         outline.residual_px <= OutlineTolerance(radius_px);
}

bool ObjectExaminer::IsFilledDisc(const Segment& segment, const Ellipse& ellipse) const {
  if (IsHole(ellipse, segment.label)) return false;
  if (ColoredShare(ellipse, kMiddle, segment.label) < kMinColoredMiddle) return false;
  return !segment.touches_border || FilledShare(segment, ellipse, image_.size()) >= kMinFillOfPart;
}

// Compares the disc's place by its size with the ground.
ObjectExaminer::Outcome ObjectExaminer::PlaceDisc(const Cone& cone, const Eigen::Vector3d& position,
                                                  const ObjectClass& object) const {
  const double tolerance = detector_.options.ground_tolerance;
  const std::optional<bool> is_on_ground = IsOnGround(position, object, tolerance);
  if (!is_on_ground) return Outcome::kObject;
  const double distance = position.norm();
  const auto looks_like_disc_at = [&](double there) {
    return LooksLikeDisc(cone, position / distance, there, *hint_.up_in_camera, object.size_m / 2,
                         tolerance, /*slack=*/1 / detector_.focal_px);
  };
  if (*is_on_ground && looks_like_disc_at(*DistanceOnGround(position, object))) {
    return Outcome::kObject;
  }
  return looks_like_disc_at(distance) ? Outcome::kElsewhere : Outcome::kNone;
}

bool ObjectExaminer::IsHole(const Ellipse& outline, ColorLabel label) const {
  // In radii of the outline: search from beyond its blur to beyond the strokes of a letter, and
  // least width of the coloured area. A line is thinner.
  constexpr double kFirst = 1.3;
  constexpr double kLast = 4;
  constexpr double kMinWidth = 0.3;
  constexpr double kMaxShare = 0.5;  // other discs may lie around, but not on all sides
  int shown = 0;
  int same = 0;
  for (int i = 0; i < kDirections; ++i) {
    const double t = 2 * std::numbers::pi * i / kDirections;
    const Eigen::Vector2d radius = outline.At(t) - outline.center;
    const double radius_px = radius.norm();
    const Eigen::Vector2d outward = radius / radius_px;
    const double min_width_px = kMinWidth * radius_px;
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
  const double edge = outline.residual_px / OutlineTolerance(radius_px);
  const double hidden = (1 - (1 - outline.gap) * outline.fit_share) / options.max_gap;
  const double filling =
      segment.touches_border ? 0 : (shape.circularity - 1) / options.max_circularity_error;
  const double uncolored = (1 - ColoredShare(ellipse, kClearOfBlur, segment.label)) / kMaxUncolored;
  return square(edge) + square(hidden) + square(filling) + square(uncolored);
}

}  // namespace kestrel
