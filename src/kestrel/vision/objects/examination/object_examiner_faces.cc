// SPDX-License-Identifier: BSD-3-Clause
// Objects with corners: cuboids, by their upper face, and bars.
#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "kestrel/vision/objects/examination/object_examiner.h"
#include "kestrel/vision/objects/shapes/color_edge.h"
#include "kestrel/vision/objects/shapes/cuboid_silhouette.h"

namespace kestrel {
namespace {

bool IsWithin(double value, double expected, double factor) {
  return value <= expected * factor && expected <= value * factor;
}

}  // namespace

ObjectExaminer::Outcome ObjectExaminer::TestCuboid(const Segment& segment,
                                                   const ObjectClass& object,
                                                   ObjectDetection* detection,
                                                   ObjectStage* reached) {
  // Share of white pixels in a visible cuboid, those of its digit: a fiftieth to a third, more
  // where the paint is bleached.
  constexpr double kMinDigitShare = 0.015;
  const auto pixels = static_cast<double>(segment.pixels.size());
  const double digit_share = segment.ambiguous_pixels / pixels;
  if (digit_share < kMinDigitShare) return Outcome::kNone;
  if (!hint_.up_in_camera) {
    const auto found = FindCuboidFace(image_, segment, &workspace_->face);
    return found ? TestFace(*found, object, detection, reached) : Outcome::kNone;
  }
  const ObjectDetection before = *detection;
  const Outcome outcome =
      TestSilhouette(segment, object, hint_.camera_height_m, detection, reached);
  if (outcome == Outcome::kObject || !hint_.camera_height_m) return outcome;
  // The given height may be wrong. A cuboid of another size may fit, but it is not on that ground.
  *detection = before;
  const Outcome of_any_size = TestSilhouette(segment, object, std::nullopt, detection, reached);
  return of_any_size == Outcome::kElsewhere ? of_any_size : Outcome::kNone;
}

ObjectExaminer::Outcome ObjectExaminer::TestSilhouette(const Segment& segment,
                                                       const ObjectClass& object,
                                                       std::optional<double> camera_height_m,
                                                       ObjectDetection* detection,
                                                       ObjectStage* reached) {
  constexpr double kMaxResidual = 0.12;
  const PlaneBelow plane(*hint_.up_in_camera);
  const auto on_plane = [&](const Eigen::Vector2d& pixel) { return plane.PointOf(RayAt(pixel)); };
  SegmentBorder& border = workspace_->border;
  FindBorder(segment, image_.size(), &border);
  for (Eigen::Vector2d& point : border.points) point = on_plane(point);
  for (Eigen::Vector2d& point : border.cut) point = on_plane(point);
  Eigen::Vector2d digit = Eigen::Vector2d::Zero();
  for (const PixelPosition& at : segment.pixels.last(segment.ambiguous_pixels)) {
    digit += Eigen::Vector2d(at.u, at.v) / segment.ambiguous_pixels;
  }
  CuboidSilhouette silhouette{
      border.points, border.cut, on_plane(digit), object.height_m / object.size_m, {}};
  if (camera_height_m && *camera_height_m > object.height_m) {
    silhouette.half_side = 0.5 * object.size_m / (*camera_height_m - object.height_m);
  }
  const auto fit = FitCuboid(silhouette);
  if (!fit || fit->residual > kMaxResidual) return Outcome::kNone;
  FaceCorners corners;
  for (int i = 0; i < 4; ++i) {
    const Eigen::Vector3d ray = plane.RayTo(fit->corners[i]);
    if (detector_.camera.Project(ray, &corners[i]) != ProjectionStatus::kOk) return Outcome::kNone;
  }
  detection->misfit = std::pow(fit->residual / kMaxResidual, 2);
  return TestFace(corners, object, detection, reached);
}

ObjectExaminer::Outcome ObjectExaminer::TestFace(const FaceCorners& found,
                                                 const ObjectClass& object,
                                                 ObjectDetection* detection, ObjectStage* reached) {
  // In a blurred image the refined sides may not form a square; the silhouette may still be right.
  Outcome outcome = Outcome::kNone;
  const ObjectDetection before = *detection;
  const std::optional<FaceCorners> refined = RefineCorners(image_, found);
  for (const std::optional<FaceCorners>& corners : {refined, std::optional(found)}) {
    const auto digit = corners ? CutOutDigit(image_, *corners) : std::nullopt;
    if (!digit) continue;
    *reached = std::max(*reached, ObjectStage::kOutline);
    std::array<Eigen::Vector3d, 4> rays;
    std::ranges::transform(*corners, rays.begin(),
                           [&](const auto& corner) { return RayAt(corner); });
    ObjectDetection candidate = before;
    if (corners != refined) candidate.misfit += 1;
    const Outcome located = LocateFace(rays, object, &candidate);
    if (located <= outcome) continue;
    outcome = located;
    *detection = candidate;
    detection->digits = detector_.digits.Classify(*digit);
    detection->completeness = Completeness::kWhole;  // the upper face is whole
    if (outcome == Outcome::kObject) break;
  }
  if (outcome == Outcome::kObject) *reached = ObjectStage::kPosition;
  return outcome;
}

ObjectExaminer::Outcome ObjectExaminer::TestBar(const Segment& segment, const SegmentShape& shape,
                                                const ObjectClass& object,
                                                ObjectDetection* detection, ObjectStage* reached) {
  constexpr double kMinFill = 0.75;
  constexpr double kMaxAspectFactor = 2;
  // The middle of a partial bar is unknown.
  if (segment.touches_border) return Outcome::kNone;
  const Ellipse& ellipse = shape.ellipse;
  const double box_px = 3 * ellipse.semi_major * ellipse.semi_minor;
  if (shape.moments.area < kMinFill * box_px) return Outcome::kNone;
  const double aspect = ellipse.semi_major / ellipse.semi_minor;
  if (!IsWithin(aspect, object.size_m / object.width_m, kMaxAspectFactor)) return Outcome::kNone;
  *reached = ObjectStage::kOutline;
  const Outcome outcome = LocateFace(RectangleAround(segment, shape), object, detection);
  if (outcome == Outcome::kObject) *reached = ObjectStage::kPosition;
  return outcome;
}

// Returns the distance from 'side', a point on the ground, to the end of the colour in the
// direction 'outward': the mean over places up to 'reach' beside it; 0 where no edge is clear.
template <class RayTo>
double ObjectExaminer::EdgeShift(const RayTo& ray_to, const Eigen::Vector2d& side,
                                 const Eigen::Vector2d& outward, double reach) const {
  constexpr int kPlaces = 4;  // on either side
  double sum = 0;
  int count = 0;
  for (int i = -kPlaces; i <= kPlaces; ++i) {
    const Eigen::Vector2d at =
        side + reach * i / kPlaces * Eigen::Vector2d(-outward.y(), outward.x());
    const double step = 0.01 * ray_to(at).norm();
    Eigen::Vector2d pixel;
    Eigen::Vector2d further;
    const CameraModel& camera = detector_.camera;
    if (camera.Project(ray_to(at), &pixel) != ProjectionStatus::kOk ||
        camera.Project(ray_to(at + step * outward), &further) != ProjectionStatus::kOk) {
      continue;
    }
    const double step_px = (further - pixel).norm();
    const auto edge = FindColorEdge(image_, pixel, (further - pixel) / step_px);
    if (!edge) continue;
    sum += edge->offset_px * step / step_px;
    ++count;
  }
  return count > 0 ? sum / count : 0;
}

// Returns the rectangle around the segment, on the ground where the attitude is known: the nearer
// half of a long object is larger in the image, so its centroid is not its middle.
std::array<Eigen::Vector3d, 4> ObjectExaminer::RectangleAround(const Segment& segment,
                                                               const SegmentShape& shape) const {
  constexpr double kMiddlePart = 0.1;
  const Eigen::Vector3d up = hint_.up_in_camera.value_or(-RayAt(shape.moments.centroid));
  const auto on_plane = [&](const Eigen::Vector2d& pixel) {
    const Eigen::Vector3d ray = RayAt(pixel);
    return Eigen::Vector3d(ray / std::max(kMinDescent, -up.dot(ray)));
  };
  const Eigen::Vector3d origin = on_plane(shape.ellipse.center);
  const Eigen::Vector3d end =
      on_plane(shape.ellipse.center + shape.ellipse.semi_major * shape.ellipse.major_axis());
  const Eigen::Vector3d along = (end - origin).normalized();
  const Eigen::Vector3d across = up.cross(along).normalized();
  const auto place = [&](const Eigen::Vector2d& at) {
    const Eigen::Vector3d offset = on_plane(at) - origin;
    return Eigen::Vector2d(along.dot(offset), across.dot(offset));
  };
  Eigen::AlignedBox2d extent;
  FindBorderPixels(segment, &workspace_->border);
  for (Eigen::Vector2d& at : workspace_->border.points) {
    at = place(at);
    extent.extend(at);
  }
  // A shaking camera with a rolling shutter bends long objects, so the middle part gives the
  // middle.
  const double middle = extent.center().x();
  const double reach = kMiddlePart / 2 * extent.sizes().x();
  Eigen::AlignedBox2d middle_part;
  for (const Eigen::Vector2d& at : workspace_->border.points) {
    if (std::abs(at.x() - middle) <= reach) middle_part.extend(at);
  }
  if (!middle_part.isEmpty()) {
    extent.min().y() = middle_part.min().y();
    extent.max().y() = middle_part.max().y();
  }
  const auto ray_to = [&](const Eigen::Vector2d& at) {
    return Eigen::Vector3d(origin + at.x() * along + at.y() * across);
  };
  const Eigen::Vector2d center = extent.center();
  const Eigen::Vector2d half = 0.5 * extent.sizes();
  for (const double side : {-1.0, 1.0}) {
    const double tip =
        EdgeShift(ray_to, center + Eigen::Vector2d(side * half.x(), 0), {side, 0}, 0.5 * half.y());
    const double flank =
        EdgeShift(ray_to, center + Eigen::Vector2d(0, side * half.y()), {0, side}, reach);
    Eigen::Vector2d& corner = side < 0 ? extent.min() : extent.max();
    corner += side * Eigen::Vector2d(tip, flank);
  }
  std::array<Eigen::Vector3d, 4> corners;
  constexpr std::array kOrder = {Eigen::AlignedBox2d::BottomLeft, Eigen::AlignedBox2d::BottomRight,
                                 Eigen::AlignedBox2d::TopRight, Eigen::AlignedBox2d::TopLeft};
  for (int i = 0; i < 4; ++i) {
    const Eigen::Vector2d corner = extent.corner(kOrder[i]);
    corners[i] = ray_to(corner).normalized();
  }
  return corners;
}

ObjectExaminer::Outcome ObjectExaminer::LocateFace(const std::array<Eigen::Vector3d, 4>& rays,
                                                   const ObjectClass& object,
                                                   ObjectDetection* detection) const {
  constexpr double kMaxSkew = 0.15;
  constexpr double kMaxSideRatio = 1.15;
  const ObjectDetectorOptions& options = detector_.options;
  const bool is_bar = object.shape == ObjectShape::kBar;
  const Eigen::Vector3d up = hint_.up_in_camera.value_or(-detection->bearing);
  const auto face = RectangleOnPlane(rays, up);
  if (!face || !(face->sides.minCoeff() > 0)) return Outcome::kNone;
  const double side_ratio = face->sides.maxCoeff() / face->sides.minCoeff();
  // Without the attitude a square may appear as any parallelogram.
  if (!is_bar && hint_.up_in_camera && (face->skew > kMaxSkew || side_ratio > kMaxSideRatio)) {
    return Outcome::kNone;
  }
  const double length = is_bar ? face->sides.maxCoeff() : std::sqrt(face->sides.prod());
  const Eigen::Vector3d position = object.size_m / length * face->center;
  const bool is_on_ground = IsOnGround(position, object, options.ground_tolerance).value_or(true);
  const Outcome outcome = is_on_ground ? Outcome::kObject : Outcome::kElsewhere;
  detection->misfit +=
      is_bar ? std::pow(
                   (side_ratio * object.width_m / object.size_m - 1) / options.ground_tolerance, 2)
             : std::pow(face->skew / kMaxSkew, 2) +
                   std::pow((side_ratio - 1) / (kMaxSideRatio - 1), 2);
  const double radius_px = 0.5 * detector_.focal_px * object.size_m / position.norm();
  SetLocation(position, object, ObjectDetectorOptions::kCenterSigma_px,
              ObjectDetectorOptions::kRadiusSigma_px / radius_px, outcome, detection);
  return outcome;
}

}  // namespace kestrel
