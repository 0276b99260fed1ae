// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/calibration/lens/lens_coverage.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "kestrel/core/base/robust_statistics.h"
#include "kestrel/core/geometry/angles.h"

namespace kestrel {
namespace {

constexpr double kNearly = 0.99;  // share of all edges

double NearlyLargest(std::vector<double> values) {
  if (values.empty()) return 0;
  return QuantileInPlace(values, kNearly, QuantileRank::kLower);
}

// The field, of 'count', that contains a coordinate; integer coordinates are centres of pixels.
int FieldOf(double coordinate, int size_px, int count) {
  return std::clamp(static_cast<int>((coordinate + 0.5) * count / size_px), 0, count - 1);
}

}  // namespace

std::vector<std::string> LensCoverage::EmptyParts() const {
  constexpr int kRight = kColumns - 1, kBottom = kRows - 1;
  std::vector<std::string> parts;
  const auto corner = [&](int column, int row, const char* name) {
    if (EdgesAt(column, row) == 0) parts.push_back(name);
  };
  corner(0, 0, "upper left corner");
  corner(kRight, 0, "upper right corner");
  corner(0, kBottom, "lower left corner");
  corner(kRight, kBottom, "lower right corner");
  int left = 0, right = 0, top = 0, bottom = 0;
  for (int row = 1; row < kBottom; ++row) {
    left += EdgesAt(0, row);
    right += EdgesAt(kRight, row);
  }
  for (int column = 1; column < kRight; ++column) {
    top += EdgesAt(column, 0);
    bottom += EdgesAt(column, kBottom);
  }
  if (left == 0) parts.push_back("left side");
  if (right == 0) parts.push_back("right side");
  if (top == 0) parts.push_back("top");
  if (bottom == 0) parts.push_back("bottom");
  return parts;
}

int LensCoverage::fields() const {
  return static_cast<int>(edges.size() - std::count(edges.begin(), edges.end(), 0));
}

std::string LensCoverage::InWords() const {
  std::string words = fmt::format(
      "edges lie in {} of {} fields of the image, to {:.0f} degrees from the optical axis",
      fields(), edges.size(), max_angle_deg);
  std::vector<std::string> empty = EmptyParts();
  if (empty.empty()) return words;
  constexpr int kCorners = 4;
  if (empty.size() >= kCorners && empty[kCorners - 1].ends_with("corner")) {
    empty.erase(empty.begin() + 1, empty.begin() + kCorners);
    empty.front() = "corners";
  }
  const bool is_one = empty.size() == 1 && empty.front() != "corners";
  return words + fmt::format(
                     "; the {} of the image hold{} no edges: distortion beyond {:.0f} "
                     "degrees is extrapolated",
                     fmt::join(empty, " and the "), is_one ? "s" : "", max_angle_deg);
}

LensCoverage CoverageOf(std::span<const LensView> views, const CameraModel& camera) {
  LensCoverage coverage;
  const Eigen::Vector2d middle(0.5 * (camera.width_px() - 1), 0.5 * (camera.height_px() - 1));
  std::vector<double> angles, distances;
  for (const LensView& view : views) {
    for (const LensEdge& edge : view.edges) {
      const int column = FieldOf(edge.pixel.x(), camera.width_px(), LensCoverage::kColumns);
      const int row = FieldOf(edge.pixel.y(), camera.height_px(), LensCoverage::kRows);
      ++coverage.edges[row * LensCoverage::kColumns + column];
      distances.push_back((edge.pixel - middle).norm() / middle.norm());
      Eigen::Vector3d ray;
      if (camera.Unproject(edge.pixel, &ray) == ProjectionStatus::kOutsideModel) continue;
      angles.push_back(std::atan2(ray.head<2>().norm(), ray.z()));
    }
  }
  coverage.max_angle_deg = Degrees(NearlyLargest(angles));
  coverage.reach = NearlyLargest(distances);
  return coverage;
}

}  // namespace kestrel
