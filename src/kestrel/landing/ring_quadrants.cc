// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/landing/ring_quadrants.h"

#include <algorithm>
#include <cmath>

#include "kestrel/image/border_moments.h"

namespace kestrel {
namespace {

constexpr std::size_t kMaxAreas = 512;
constexpr std::size_t kMaxRings = 256;
constexpr int kMaxExtent = 40;  // px; larger quadrants have strokes that do not grow together
constexpr int kMinArea = 6;     // px
constexpr double kMinEllipticity = 0.75;
constexpr double kSameArea = 1.7;  // largest ratio of two quadrants
// Of the area that the centroids say: the threshold takes the white beside the strokes away.
constexpr double kLeastArea = 0.25;
constexpr double kMostArea = 1.6;

// A quadrant of the print in the frame of its two arms: metres, square metres.
struct PrintQuadrant {
  double centroid = 0;  // along either arm
  double area = 0;

  // Summed over cells, from the sides of the arms to the ring.
  explicit PrintQuadrant(const LandingPattern& pattern) {
    constexpr int kCells = 64;
    const double radius = pattern.inner_radius_m();
    const double cell = radius / kCells;
    const double first = 0.5 * pattern.arm_width_m;
    double sum = 0;
    for (double y = first + 0.5 * cell; y < radius; y += cell) {
      for (double x = first + 0.5 * cell; std::hypot(x, y) < radius; x += cell) {
        area += cell * cell;
        sum += x * cell * cell;
      }
    }
    if (area > 0) centroid = sum / area;
  }
};

bool AreAlike(double a, double b) { return a <= kSameArea * b && b <= kSameArea * a; }

// The white areas that may be quadrants, from top to bottom.
void CollectAreas(const BorderTracer& tracer, std::vector<WhiteArea>* areas) {
  areas->clear();
  for (const Border& border : tracer.borders()) {
    if (border.signed_area > -kMinArea || areas->size() == areas->capacity()) continue;
    const int extent = std::max(border.max.x - border.min.x, border.max.y - border.min.y);
    if (extent > kMaxExtent) continue;
    const RegionMoments moments = ComputeBorderMoments(tracer.begin(border), border.count);
    if (moments.Ellipticity() < kMinEllipticity) continue;
    areas->push_back({moments.centroid, moments.area, static_cast<double>(extent)});
  }
  std::sort(areas->begin(), areas->end(),
            [](const WhiteArea& a, const WhiteArea& b) { return a.centroid.y() < b.centroid.y(); });
}

// The outer edge of a ring whose plane is seen so that the arms' directions, one metre each, are
// the columns of 'image_from_plane'.
Ellipse RingOf(const Eigen::Vector2d& center, const Eigen::Matrix2d& image_from_plane,
               double radius_m) {
  RegionMoments disc;
  disc.centroid = center;
  disc.covariance = 0.25 * radius_m * radius_m * image_from_plane * image_from_plane.transpose();
  return EllipseFromMoments(disc);
}

}  // namespace

void RingQuadrantsWorkspace::Reserve() {
  areas.reserve(kMaxAreas);
  rings.reserve(kMaxRings);
}

void FindQuadrantRings(const BorderTracer& tracer, const LandingPattern& pattern,
                       RingQuadrantsWorkspace* workspace) {
  std::vector<WhiteArea>& areas = workspace->areas;
  std::vector<Ellipse>& rings = workspace->rings;
  rings.clear();
  CollectAreas(tracer, &areas);
  const PrintQuadrant quadrant(pattern);
  // 'a' and 'b' face each other, 'c' lies beside both.
  for (auto a = areas.begin(); a != areas.end(); ++a) {
    for (auto b = a + 1; b != areas.end(); ++b) {
      const double reach = 2.5 * std::max(a->extent, b->extent) + 4;
      const Eigen::Vector2d apart = b->centroid - a->centroid;
      if (apart.y() > reach) break;
      if (std::abs(apart.x()) > reach || !AreAlike(a->area, b->area)) continue;
      const Eigen::Vector2d center = a->centroid + 0.5 * apart;
      for (auto c = areas.begin(); c != areas.end() && rings.size() < rings.capacity(); ++c) {
        const Eigen::Vector2d beside = c->centroid - center;
        if (beside.y() > reach) break;
        if (c == a || c == b || beside.y() < -reach || !AreAlike(a->area, c->area)) continue;
        // The diagonals of the quadrants are as long as an arm's direction times this.
        Eigen::Matrix2d diagonals;
        diagonals << 0.5 * apart, beside;
        const Eigen::Matrix2d image_from_plane = diagonals / (std::sqrt(2.0) * quadrant.centroid);
        const double expected = std::abs(image_from_plane.determinant()) * quadrant.area;
        const double mean = (a->area + b->area + c->area) / 3;
        if (mean < kLeastArea * expected || mean > kMostArea * expected) continue;
        rings.push_back(RingOf(center, image_from_plane, pattern.outer_radius_m()));
      }
    }
  }
}

}  // namespace kestrel
