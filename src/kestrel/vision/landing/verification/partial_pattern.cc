// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/landing/verification/partial_pattern.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Geometry>
#include <Eigen/LU>

namespace kestrel {
namespace {

// In the plane at unit distance, where the unit is the height of the camera.
constexpr double kLineTolerance = 0.02;  // distance of a point from its line
constexpr double kMinLineLength = 0.12;  // length of a line
constexpr double kMaxPlaneReach = 4;     // radius of the part of the plane that is used
constexpr std::size_t kMaxSegments = 60;
constexpr std::size_t kMaxBars = 16;
constexpr std::size_t kMaxPoses = 4;
constexpr double kLeastBarLength = 0.8;  // in its widths
constexpr double kMaxBarWidth = 1.5;
constexpr double kMaxWidthRatio = 1.4;  // ratio of the two bars' widths
constexpr double kBarReach = 1.2;       // half lengths of an arm from the middle to that of a bar
constexpr double kParallel = 0.99;      // cosine
constexpr double kRightAngle = 0.14;    // cosine

double CrossProduct(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

// Columns: x, y and the normal (away from the ground) of the plane, in the camera frame.
Eigen::Matrix3d PlaneAxes(const Eigen::Vector3d& up) {
  Eigen::Matrix3d axes;
  axes.col(2) = up;
  axes.col(0) = up.unitOrthogonal();
  axes.col(1) = axes.col(2).cross(axes.col(0));
  return axes;
}

class Finder {
 public:
  Finder(const RayTable& rays, const ImageRegion& region, const LandingPattern& pattern,
         const Eigen::Vector3d& up, PartialPatternWorkspace* workspace)
      : rays_(rays),
        region_(region),
        pattern_(pattern),
        axes_(PlaneAxes(up)),
        workspace_(*workspace) {}

  // Cuts a border into straight lines. The camera sees the plane from above, so black lies on the
  // right of a border both in the image and in the plane.
  void CollectLines(const GridPoint* points, std::size_t count) {
    workspace_.plane.clear();
    constexpr std::size_t kStride = 2;
    for (std::size_t i = 0; i < count; i += kStride) {
      const Eigen::Vector2d pixel =
          region_.ToFull(Eigen::Vector2d(points[i].x - 0.5, points[i].y - 0.5));
      const Eigen::Vector3d ray =
          axes_.transpose() *
          rays_.Ray(static_cast<float>(pixel.x()), static_cast<float>(pixel.y())).cast<double>();
      const Eigen::Vector2d place = ray.head<2>() / std::max(-ray.z(), 1e-9);
      if (ray.z() < 0 && place.squaredNorm() < kMaxPlaneReach * kMaxPlaneReach) {
        workspace_.plane.push_back(place);
      } else {
        Cut(false);
      }
    }
    Cut(workspace_.plane.size() * kStride + kStride > count);
  }

  void CollectBars() {
    std::vector<LineSegment>& segments = workspace_.segments;
    KeepLongest(&segments, kMaxSegments, [](const LineSegment& s) { return s.length(); });
    for (const LineSegment& a : segments) {
      for (const LineSegment& b : segments) {
        // The two borders of a bar run in opposite directions, each on the right of the other,
        // where black lies.
        const Eigen::Vector2d direction = a.direction();
        if (direction.dot(b.direction()) > -kParallel) continue;
        const Eigen::Vector2d across(direction.y(), -direction.x());
        const double width = across.dot(0.5 * (b.start + b.end) - a.start);
        const double low = std::max(0.0, direction.dot(b.end - a.start));
        const double high = std::min(a.length(), direction.dot(b.start - a.start));
        if (width <= 0 || high - low < kLeastBarLength * width || width > kMaxBarWidth) continue;
        workspace_.bars.push_back({a.start + 0.5 * (low + high) * direction + 0.5 * width * across,
                                   direction, width, high - low});
      }
    }
    KeepLongest(&workspace_.bars, kMaxBars,
                [](const PartialPatternWorkspace::Bar& bar) { return bar.length; });
  }

  void CollectCrosses() {
    const auto& bars = workspace_.bars;
    for (std::size_t i = 0; i < bars.size(); ++i) {
      for (std::size_t j = i + 1; j < bars.size(); ++j) {
        if (workspace_.poses.size() == kMaxPoses) return;
        AddCross(bars[i], bars[j]);
      }
    }
  }

 private:
  void Cut(bool closed) {
    SplitAndMerge(workspace_.plane, closed, kLineTolerance, kMinLineLength, &workspace_.breaks,
                  &workspace_.segments);
    workspace_.plane.clear();
  }

  template <typename Items, typename Key>
  static void KeepLongest(Items* items, std::size_t most, Key key) {
    const std::size_t kept = std::min(items->size(), most);
    std::partial_sort(items->begin(), items->begin() + static_cast<std::ptrdiff_t>(kept),
                      items->end(),
                      [&key](const auto& a, const auto& b) { return key(a) > key(b); });
    items->resize(kept);
  }

  void AddCross(const PartialPatternWorkspace::Bar& a, const PartialPatternWorkspace::Bar& b) {
    if (std::abs(a.direction.dot(b.direction)) > kRightAngle) return;
    if (std::max(a.width, b.width) > kMaxWidthRatio * std::min(a.width, b.width)) return;
    // The point where the axes meet, and its distance from the bars: both bars must be parts of one
    // cross.
    const double along =
        CrossProduct(b.middle - a.middle, b.direction) / CrossProduct(a.direction, b.direction);
    const Eigen::Vector2d center = a.middle + along * a.direction;
    const double width = 0.5 * (a.width + b.width);
    const double reach = kBarReach * pattern_.arm_half_length_m / pattern_.arm_width_m * width;
    if (std::abs(along) > reach || (center - b.middle).norm() > reach) return;
    const double height = pattern_.arm_width_m / width;
    RigidTransform pose;
    Eigen::Matrix3d rotation;
    rotation.col(0) = axes_ * Eigen::Vector3d(a.direction.x(), a.direction.y(), 0);
    rotation.col(2) = axes_.col(2);
    rotation.col(1) = rotation.col(2).cross(rotation.col(0));
    pose.rotation = Eigen::Quaterniond(rotation);
    pose.translation = axes_ * Eigen::Vector3d(height * center.x(), height * center.y(), -height);
    workspace_.poses.push_back(pose);
  }

  const RayTable& rays_;
  const ImageRegion& region_;
  const LandingPattern& pattern_;
  Eigen::Matrix3d axes_;
  PartialPatternWorkspace& workspace_;
};

}  // namespace

void PartialPatternWorkspace::Reserve(std::size_t border_points) {
  plane.reserve(border_points);
  breaks.reserve(border_points + 1);
  segments.reserve(border_points);
  bars.reserve(kMaxSegments * kMaxSegments);
  poses.reserve(kMaxPoses);
}

void FindPartialPatterns(const BorderTracer& tracer, const RayTable& rays,
                         const ImageRegion& region, const LandingPattern& pattern,
                         const Eigen::Vector3d& up_in_camera, PartialPatternWorkspace* workspace) {
  workspace->segments.clear();
  workspace->bars.clear();
  workspace->poses.clear();
  Finder finder(rays, region, pattern, up_in_camera, workspace);
  for (const Border& border : tracer.borders()) {
    finder.CollectLines(tracer.begin(border), border.count);
  }
  finder.CollectBars();
  finder.CollectCrosses();
}

}  // namespace kestrel
