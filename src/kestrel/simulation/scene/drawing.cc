// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/simulation/scene/drawing.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace kestrel {
namespace {

Drawing::Edge EdgeOf(const Drawing::Ring& ring, const Eigen::Vector2d& point) {
  const Eigen::Vector2d offset = point - ring.center;
  const double radius = offset.norm();
  const Eigen::Vector2d outward =
      radius > 0 ? Eigen::Vector2d(offset / radius) : Eigen::Vector2d(1, 0);
  const double to_outer = radius - ring.outer_radius;
  const double to_inner = ring.inner_radius - radius;
  if (ring.inner_radius > 0 && to_inner > to_outer) return {to_inner, -outward};
  return {to_outer, outward};
}

Drawing::Edge EdgeOf(const Drawing::Bar& bar, const Eigen::Vector2d& point) {
  const Eigen::Vector2d across(-bar.axis.y(), bar.axis.x());
  const Eigen::Vector2d offset = point - bar.center;
  const double along_axis = offset.dot(bar.axis);
  const double across_axis = offset.dot(across);
  const double to_end = std::abs(along_axis) - bar.half_length;
  const double to_side = std::abs(across_axis) - bar.half_width;
  const Eigen::Vector2d end_normal = std::copysign(1.0, along_axis) * bar.axis;
  const Eigen::Vector2d side_normal = std::copysign(1.0, across_axis) * across;
  if (to_end > 0 && to_side > 0) {
    const double distance = std::sqrt(to_end * to_end + to_side * to_side);
    return {distance, (to_end * end_normal + to_side * side_normal) / distance};
  }
  return to_end > to_side ? Drawing::Edge{to_end, end_normal} : Drawing::Edge{to_side, side_normal};
}

// Calls 'visit' with the ends of each side.
template <class Visit>
void ForEachSide(const Drawing::Polygon& polygon, const Visit& visit) {
  for (const auto& loop : polygon.loops) {
    for (std::size_t i = 0; i < loop.size(); ++i) visit(loop[i], loop[(i + 1) % loop.size()]);
  }
}

Drawing::Edge EdgeOf(const Drawing::Polygon& polygon, const Eigen::Vector2d& point) {
  bool inside = false;
  double nearest2 = std::numeric_limits<double>::infinity();
  Eigen::Vector2d outward(1, 0);
  ForEachSide(polygon, [&](const Eigen::Vector2d& from, const Eigen::Vector2d& to) {
    const Eigen::Vector2d side = to - from;
    const Eigen::Vector2d offset = point - from;
    // The side crosses the ray from the point along x.
    if ((from.y() > point.y()) != (to.y() > point.y()) &&
        (offset.x() * side.y() < side.x() * offset.y()) == (side.y() > 0)) {
      inside = !inside;
    }
    const double along = std::clamp(offset.dot(side) / side.squaredNorm(), 0.0, 1.0);
    const Eigen::Vector2d away = offset - along * side;
    if (away.squaredNorm() >= nearest2) return;
    nearest2 = away.squaredNorm();
    outward = away;
  });
  const double distance = std::sqrt(nearest2);
  if (distance > 0) outward /= distance;
  return inside ? Drawing::Edge{-distance, -outward} : Drawing::Edge{distance, outward};
}

}  // namespace

Drawing& Drawing::Add(const Shape& shape) {
  if (const auto* const ring = std::get_if<Ring>(&shape)) {
    Bound(ring->center, ring->outer_radius);
  } else if (const auto* const bar = std::get_if<Bar>(&shape)) {
    Bound(bar->center, std::hypot(bar->half_length, bar->half_width));
  } else {
    for (const auto& loop : std::get<Polygon>(shape).loops) {
      for (const Eigen::Vector2d& corner : loop) Bound(corner, 0);
    }
  }
  steps_.emplace_back(shape, /*is_erased=*/false);
  return *this;
}

void Drawing::Bound(const Eigen::Vector2d& center, double radius) {
  if (bound_radius_ < 0) bound_center_ = center;
  bound_radius_ = std::max(bound_radius_, (center - bound_center_).norm() + radius);
}

Drawing& Drawing::Erase(const Shape& shape) {
  steps_.emplace_back(shape, /*is_erased=*/true);
  return *this;
}

Drawing::Edge Drawing::NearestEdge(const Eigen::Vector2d& point) const {
  const Eigen::Vector2d offset = point - bound_center_;
  const double far = 2 * bound_radius_;
  if (bound_radius_ > 0 && offset.squaredNorm() > far * far) {
    const double range = offset.norm();
    return {range - bound_radius_, offset / range};
  }
  Edge nearest{std::numeric_limits<double>::infinity(), Eigen::Vector2d(1, 0)};
  for (const Step& step : steps_) {
    const Edge edge = std::visit([&point](const auto& s) { return EdgeOf(s, point); }, step.shape);
    if (step.erase) {
      if (-edge.distance > nearest.distance) nearest = {-edge.distance, -edge.normal};
    } else if (edge.distance < nearest.distance) {
      nearest = edge;
    }
  }
  return nearest;
}

double Coverage(double distance, double width) {
  return std::clamp(0.5 - distance / std::max(width, 1e-12), 0.0, 1.0);
}

}  // namespace kestrel
