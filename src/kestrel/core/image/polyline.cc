// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/core/image/polyline.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

namespace kestrel {
namespace {

class Curve {
 public:
  Curve(std::span<const Eigen::Vector2d> points, std::size_t offset)
      : points_(points), offset_(offset) {}
  const Eigen::Vector2d& operator[](std::size_t i) const {
    return points_[(i + offset_) % points_.size()];
  }

 private:
  std::span<const Eigen::Vector2d> points_;
  std::size_t offset_;
};

// Returns the index strictly between 'first' and 'last' of the point farthest from their chord, and
// its distance.
std::size_t Farthest(const Curve& curve, std::size_t first, std::size_t last, double* distance) {
  const Eigen::Vector2d chord = curve[last] - curve[first];
  const double norm = chord.norm();
  std::size_t farthest = first;
  *distance = 0;
  for (std::size_t i = first + 1; i < last; ++i) {
    const Eigen::Vector2d offset = curve[i] - curve[first];
    const double d = norm > 1e-9 ? std::abs(chord.x() * offset.y() - chord.y() * offset.x()) / norm
                                 : offset.norm();
    if (d > *distance) {
      *distance = d;
      farthest = i;
    }
  }
  return farthest;
}

// Fits a line to the points from 'first' to 'last' by total least squares, cut at the end points.
LineSegment FitSegment(const Curve& curve, std::size_t first, std::size_t last) {
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  for (std::size_t i = first; i <= last; ++i) mean += curve[i];
  mean /= static_cast<double>(last - first + 1);
  double xx = 0, xy = 0, yy = 0;
  for (std::size_t i = first; i <= last; ++i) {
    const Eigen::Vector2d d = curve[i] - mean;
    xx += d.x() * d.x();
    xy += d.x() * d.y();
    yy += d.y() * d.y();
  }
  const double angle = 0.5 * std::atan2(2 * xy, xx - yy);
  const Eigen::Vector2d direction(std::cos(angle), std::sin(angle));
  return {mean + direction * direction.dot(curve[first] - mean),
          mean + direction * direction.dot(curve[last] - mean)};
}

}  // namespace

void SplitAndMerge(std::span<const Eigen::Vector2d> points, bool closed, double tolerance,
                   double min_length, std::vector<std::size_t>* breaks,
                   std::vector<LineSegment>* segments) {
  if (points.size() < 3) return;
  // A closed curve is opened at the point farthest from its first one, which is surely a corner.
  std::size_t offset = 0;
  if (closed) {
    for (std::size_t i = 1; i < points.size(); ++i) {
      if ((points[i] - points[0]).squaredNorm() > (points[offset] - points[0]).squaredNorm()) {
        offset = i;
      }
    }
  }
  const Curve curve(points, offset);
  const std::size_t end = closed ? points.size() : points.size() - 1;

  // Split: 'breaks' is a stack of the ends that still need a test, then it is reused in place.
  breaks->clear();
  breaks->push_back(0);
  breaks->push_back(end);
  for (std::size_t piece = 0; piece + 1 < breaks->size();) {
    double distance;
    const std::size_t farthest = Farthest(curve, (*breaks)[piece], (*breaks)[piece + 1], &distance);
    if (distance > tolerance) {
      breaks->insert(breaks->begin() + static_cast<std::ptrdiff_t>(piece) + 1, farthest);
    } else {
      ++piece;
    }
  }
  for (std::size_t i = 1; i + 1 < breaks->size();) {
    double distance;
    Farthest(curve, (*breaks)[i - 1], (*breaks)[i + 1], &distance);
    if (distance <= tolerance) {
      breaks->erase(breaks->begin() + static_cast<std::ptrdiff_t>(i));
    } else {
      ++i;
    }
  }
  for (std::size_t i = 0; i + 1 < breaks->size(); ++i) {
    const LineSegment segment = FitSegment(curve, (*breaks)[i], (*breaks)[i + 1]);
    if (segment.length() >= min_length) segments->push_back(segment);
  }
}

}  // namespace kestrel
