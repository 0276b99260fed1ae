// SPDX-License-Identifier: BSD-3-Clause
// Touching discs of one colour: one segment, several objects.
#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/LU>

#include "kestrel/vision/objects/examination/object_examiner.h"
#include "kestrel/vision/objects/shapes/touching_discs.h"

namespace kestrel {

bool ObjectExaminer::TestMerged(const Segment& segment, const SegmentShape& shape,
                                ObjectDetection* detection) {
  constexpr double kMaxCircularityError = 0.4;  // three discs in a row have 0.35
  constexpr double kMinCount = 1.5;             // two discs that seem to overlap
  if (segment.touches_border || std::abs(shape.circularity - 1) > kMaxCircularityError) {
    return false;
  }
  const PlaneBelow plane(hint_.up_in_camera.value_or(-detection->bearing));
  const auto on_plane = [&](const Eigen::Vector2d& pixel) { return plane.PointOf(RayAt(pixel)); };
  const Eigen::Vector2d& center = shape.moments.centroid;
  Eigen::Matrix2d scale;
  for (int i = 0; i < 2; ++i) {
    scale.col(i) = on_plane(center + Eigen::Vector2d::Unit(i)) - on_plane(center);
  }
  const double pixel_area = std::abs(scale.determinant());
  const auto& classes = detector_.model.classes;
  std::optional<double> radius;
  for (std::size_t i = 0; i < classes.size(); ++i) {
    if (classes[i].color + 1 != segment.label || classes[i].shape != ObjectShape::kDisc) continue;
    const std::optional<double> expected = RadiusBelow(classes[i]);
    const double count =
        expected ? shape.moments.area * pixel_area / (std::numbers::pi * *expected * *expected)
                 : kMinCount;
    if (!(count >= kMinCount)) continue;
    if (!radius) radius = RadiusOfDiscsIn(segment, on_plane, std::sqrt(pixel_area));
    if (!radius) return false;
    if (expected && std::abs(*radius / *expected - 1) > detector_.options.ground_tolerance) {
      continue;
    }
    detection->class_index = i;
    detection->class_probability = ClassProbability(classes[i], detection->color_probabilities);
    detection->completeness = Completeness::kMerged;
    return true;
  }
  return false;
}

template <class OnPlane>
std::optional<double> ObjectExaminer::RadiusOfDiscsIn(const Segment& segment,
                                                      const OnPlane& on_plane, double pixel) {
  FindBorder(segment, image_.size(), &workspace_->border);
  AddDiagonalEnds(segment, &workspace_->border);
  for (Eigen::Vector2d& point : workspace_->border.points) point = on_plane(point);
  workspace_->inside.clear();
  const std::size_t colored = segment.pixels.size() - segment.ambiguous_pixels;
  for (std::size_t i = 0; i < colored; i += 1 + colored / kTouchingDiscsPoints) {
    workspace_->inside.push_back(on_plane({segment.pixels[i].u, segment.pixels[i].v}));
  }
  return RadiusOfTouchingDiscs(workspace_->inside, workspace_->border.points, pixel);
}

std::optional<double> ObjectExaminer::RadiusBelow(const ObjectClass& disc) const {
  if (!Ground().is_known() || *hint_.camera_height_m <= disc.height_m) return std::nullopt;
  return 0.5 * disc.size_m / (*hint_.camera_height_m - disc.height_m);
}

}  // namespace kestrel
