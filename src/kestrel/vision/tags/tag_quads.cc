// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/tags/tag_quads.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

namespace kestrel {
namespace {

constexpr PlaneBorders::Passes kQuadPasses{{
    {.image_level = 3,
     .tile_level = 5,
     .min_px = 96,
     .max_px = 1 << 13,
     .least_extent = 12,
     .at_rim = true},
    {.image_level = 2,
     .tile_level = 4,
     .min_px = 44,
     .max_px = 400,
     .least_extent = 11,
     .at_rim = true},
    {.image_level = 1,
     .tile_level = 3,
     .min_px = 22,
     .max_px = 200,
     .least_extent = 11,
     .at_rim = true},
    {.image_level = 0,
     .tile_level = 2,
     .min_px = 7,
     .max_px = 90,
     .least_extent = 7,
     .at_rim = true},
}};

constexpr std::size_t kMostQuads = 160;  // in a pass

using PlanePoints = std::vector<Eigen::Vector2d>;

struct PlaneLine {
  Eigen::Vector2d normal;
  double offset;  // normal . point
  double rms;
};

// Index of the point for which 'value' is largest.
template <class Value>
int Farthest(const PlanePoints& border, const Value& value) {
  int best = 0;
  double most = value(border[0]);
  for (int i = 1; i < static_cast<int>(border.size()); ++i) {
    const double here = value(border[i]);
    if (here > most) {
      most = here;
      best = i;
    }
  }
  return best;
}

// The corners of a quadrangle, in the order of the border: the ends of a diagonal, and the points
// farthest from it on both sides.
std::array<int, 4> RoughCorners(const PlanePoints& border) {
  Eigen::Vector2d middle = Eigen::Vector2d::Zero();
  for (int i = 0; i < static_cast<int>(border.size()); ++i) middle += border[i];
  middle /= static_cast<double>(border.size());
  const auto from = [](const Eigen::Vector2d& place) {
    return [place](const Eigen::Vector2d& point) { return (point - place).squaredNorm(); };
  };
  const int first = Farthest(border, from(middle));
  const int opposite = Farthest(border, from(border[first]));
  const Eigen::Vector2d diagonal = border[opposite] - border[first];
  const Eigen::Vector2d across(-diagonal.y(), diagonal.x());
  const int left =
      Farthest(border, [&](const Eigen::Vector2d& point) { return across.dot(point); });
  const int right =
      Farthest(border, [&](const Eigen::Vector2d& point) { return -across.dot(point); });
  std::array<int, 4> corners{first, opposite, left, right};
  std::sort(corners.begin(), corners.end());
  return corners;
}

// Fits a line to the points between two corners that lie near the straight way from one to the
// other; the ends, which are round, do not count. Elsewhere the border may leave that way: a light
// cell that blurs into the light around the tag is a gap in its dark frame. False where most of the
// side is such gaps.
bool FitSide(const PlanePoints& border, int from, int to, double allowed, PlaneLine* line) {
  const int around = static_cast<int>(border.size());
  const int steps = (to - from + around) % around;
  const Eigen::Vector2d& start = border[from];
  const Eigen::Vector2d way = border[to] - start;
  const double length = way.norm();
  const Eigen::Vector2d along = way / length;
  const double trim = length / 8;
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  Eigen::Matrix2d squares = Eigen::Matrix2d::Zero();
  double covered = 0;
  int count = 0;
  bool was_near = false;
  double last = 0;
  for (int i = 0; i <= steps; ++i) {
    const Eigen::Vector2d d = border[(from + i) % around] - start;
    const double here = along.dot(d);
    const bool is_near = std::abs(along.x() * d.y() - along.y() * d.x()) <= allowed;
    if (is_near && here >= trim && here <= length - trim) {
      sum += d;
      squares += d * d.transpose();
      ++count;
      if (was_near) covered += here - last;
    }
    was_near = is_near;
    last = here;
  }
  constexpr double kLeastCovered = 0.6;  // as a share of the length without its ends
  if (count < 3 || !(covered >= kLeastCovered * (length - 2 * trim))) return false;
  const Eigen::Vector2d mean = sum / count;
  const Eigen::Matrix2d spread = squares / count - mean * mean.transpose();
  const double angle = 0.5 * std::atan2(2 * spread(0, 1), spread(0, 0) - spread(1, 1));
  line->normal = {-std::sin(angle), std::cos(angle)};
  line->offset = line->normal.dot(start + mean);
  line->rms = std::sqrt(std::max(0.0, line->normal.dot(spread * line->normal)));
  return true;
}

bool Intersect(const PlaneLine& a, const PlaneLine& b, Eigen::Vector2d* point) {
  const double det = a.normal.x() * b.normal.y() - a.normal.y() * b.normal.x();
  constexpr double kLeastSine = 0.15;
  if (std::abs(det) < kLeastSine) return false;
  *point = {(a.offset * b.normal.y() - b.offset * a.normal.y()) / det,
            (b.offset * a.normal.x() - a.offset * b.normal.x()) / det};
  return true;
}

// True when a border can be that of a convex quadrangle, by its length and area alone. It may lie
// on the image's rim: of a tag there that is cut off by less than its dark frame the cells show
// what it is.
bool MayBeQuad(const Border& border) {
  const int width = border.max.x - border.min.x;
  const int height = border.max.y - border.min.y;
  // A convex border: 2 (width + height); that of a tag may go around the cells inside, too.
  constexpr double kLongest = 6;
  constexpr double kLeastArea = 0.3;  // as a share of the bounding box
  return static_cast<double>(border.count) <= kLongest * (width + height) &&
         std::abs(border.signed_area) >= kLeastArea * width * height;
}

}  // namespace

TagQuadFinder::TagQuadFinder(const CameraModel& camera)
    : borders_(camera, kQuadPasses), focal_px_(camera.intrinsics().fx_px) {}

void TagQuadFinder::Begin(const cv::Mat& image, const cv::Rect& part,
                          TagQuadBuffers* buffers) const {
  buffers->quads.clear();
  buffers->quads.reserve(2 * PlaneBorders::kPasses * kMostQuads);
  borders_.Begin(image, part, &buffers->borders);
}

std::span<const TagQuad> TagQuadFinder::Find(const cv::Rect& part, int pass,
                                             TagQuadBuffers* buffers) const {
  const std::size_t before = buffers->quads.size();
  const std::span<const Border> borders = borders_.Trace(part, pass, &buffers->borders);
  buffers->examined = borders.size();
  for (const Border& border : borders) {
    if (buffers->quads.size() == before + kMostQuads) break;
    TagQuad quad;
    if (MayBeQuad(border) && FitQuad(border, part, pass, &buffers->borders, &quad)) {
      buffers->quads.push_back(quad);
    }
  }
  return std::span(buffers->quads).subspan(before);
}

bool TagQuadFinder::FitQuad(const Border& border, const cv::Rect& part, int pass,
                            BorderBuffers* buffers, TagQuad* quad) const {
  Eigen::Matrix3d camera_from_plane;
  const int level = kQuadPasses[pass].image_level;
  if (!borders_.OnPlane(border, part, level, &camera_from_plane, buffers)) return false;
  const PlanePoints& on_plane = buffers->points;
  const std::array<int, 4> rough = RoughCorners(on_plane);
  std::array<PlaneLine, 4> sides;
  const double allowed = 0.6 * (1 << level) / focal_px_;
  for (int k = 0; k < 4; ++k) {
    const int next = rough[(k + 1) % 4];
    constexpr double kBend = 0.02;  // as a share of the length
    constexpr double kNear = 2.5;   // the corners are only rough
    const double length = (on_plane[next] - on_plane[rough[k]]).norm();
    const double bend = std::max(allowed, kBend * length);
    if (!FitSide(on_plane, rough[k], next, kNear * bend, &sides[k]) || sides[k].rms > bend) {
      return false;
    }
  }
  std::array<Eigen::Vector2d, 4> corners;
  for (int k = 0; k < 4; ++k) {
    if (!Intersect(sides[(k + 3) % 4], sides[k], &corners[k])) return false;
  }
  double shortest = 1e9, longest = 0, sum = 0;
  for (int k = 0; k < 4; ++k) {
    const double length = (corners[(k + 1) % 4] - corners[k]).norm();
    shortest = std::min(shortest, length);
    longest = std::max(longest, length);
    sum += length;
  }
  constexpr double kLeastRatio = 0.25;
  if (shortest < kLeastRatio * longest) return false;
  quad->side_px = 0.25 * sum * focal_px_;
  // A walk with the dark area on its right is clockwise around it, and anticlockwise in a hole.
  quad->dark_inside = border.signed_area > 0;
  for (int k = 0; k < 4; ++k) {
    const Eigen::Vector2d& corner = corners[quad->dark_inside ? k : 3 - k];
    quad->corners[k] = (camera_from_plane * corner.homogeneous()).normalized();
  }
  return true;
}

}  // namespace kestrel
