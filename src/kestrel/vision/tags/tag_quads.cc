// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/tags/tag_quads.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

namespace kestrel {
namespace {

struct QuadPass {
  int image_level;  // the image at 1 / 2^level
  int tile_level;   // tiles of 2^tile_level pixels make the threshold's box
  int min_px;       // least and largest extent of a quad, full resolution
  int max_px;
};

constexpr std::array<QuadPass, TagQuadFinder::kPasses> kQuadPasses{{
    {.image_level = 3, .tile_level = 5, .min_px = 96, .max_px = 1 << 13},
    {.image_level = 2, .tile_level = 4, .min_px = 44, .max_px = 400},
    {.image_level = 1, .tile_level = 3, .min_px = 22, .max_px = 200},
    {.image_level = 0, .tile_level = 2, .min_px = 7, .max_px = 90},
}};

// The threshold also looks at boxes four times as large.
constexpr int kLastTileLevel = kQuadPasses[0].tile_level + 2;

constexpr int kMostPoints = 256;  // of a border that are looked at
constexpr std::size_t kMostBorders = 160;

// Points of a border on the plane across the ray to its middle, at distance 1.
struct PlanePoints {
  Eigen::Matrix3d camera_from_plane;  // its columns: the plane's axes and the ray to its middle
  std::array<Eigen::Vector2d, kMostPoints> points;
  int count = 0;
};

struct PlaneLine {
  Eigen::Vector2d normal;
  double offset;  // normal . point
  double rms;
};

Eigen::Matrix3d AxesAcross(const Eigen::Vector3d& ray) {
  Eigen::Matrix3d axes;
  axes.col(2) = ray;
  axes.col(0) = Eigen::Vector3d::UnitY().cross(ray);
  if (axes.col(0).norm() < 0.1) axes.col(0) = Eigen::Vector3d::UnitX();
  axes.col(0) = (axes.col(0) - axes.col(0).dot(ray) * ray).normalized();
  axes.col(1) = ray.cross(axes.col(0));
  return axes;
}

// Index of the point for which 'value' is largest.
template <class Value>
int Farthest(const PlanePoints& border, const Value& value) {
  int best = 0;
  double most = value(border.points[0]);
  for (int i = 1; i < border.count; ++i) {
    const double here = value(border.points[i]);
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
  for (int i = 0; i < border.count; ++i) middle += border.points[i];
  middle /= border.count;
  const auto from = [](const Eigen::Vector2d& place) {
    return [place](const Eigen::Vector2d& point) { return (point - place).squaredNorm(); };
  };
  const int first = Farthest(border, from(middle));
  const int opposite = Farthest(border, from(border.points[first]));
  const Eigen::Vector2d diagonal = border.points[opposite] - border.points[first];
  const Eigen::Vector2d across(-diagonal.y(), diagonal.x());
  const int left =
      Farthest(border, [&](const Eigen::Vector2d& point) { return across.dot(point); });
  const int right =
      Farthest(border, [&](const Eigen::Vector2d& point) { return -across.dot(point); });
  std::array<int, 4> corners{first, opposite, left, right};
  std::sort(corners.begin(), corners.end());
  return corners;
}

// Fits a line to the points between two corners; the ends, which are round, do not count.
bool FitSide(const PlanePoints& border, int from, int to, PlaneLine* line) {
  const int length = (to - from + border.count) % border.count;
  const int trim = std::max(1, length / 8);
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  int count = 0;
  for (int i = trim; i <= length - trim; ++i, ++count) {
    mean += border.points[(from + i) % border.count];
  }
  if (count < 3) return false;
  mean /= count;
  double xx = 0, xy = 0, yy = 0;
  for (int i = trim; i <= length - trim; ++i) {
    const Eigen::Vector2d d = border.points[(from + i) % border.count] - mean;
    xx += d.x() * d.x();
    xy += d.x() * d.y();
    yy += d.y() * d.y();
  }
  const double angle = 0.5 * std::atan2(2 * xy, xx - yy);
  line->normal = {-std::sin(angle), std::cos(angle)};
  line->offset = line->normal.dot(mean);
  const Eigen::Vector2d& n = line->normal;
  line->rms = std::sqrt(
      std::max(0.0, (n.x() * n.x() * xx + 2 * n.x() * n.y() * xy + n.y() * n.y() * yy) / count));
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

// True when a border can be that of a convex quadrangle, by its length and area alone.
bool MayBeQuad(const Border& border, cv::Size image) {
  const int width = border.max.x - border.min.x;
  const int height = border.max.y - border.min.y;
  const bool cut_off = border.min.x <= 0 || border.min.y <= 0 || border.max.x >= image.width ||
                       border.max.y >= image.height;
  constexpr double kLongest = 2.7;    // a convex border: 2 (width + height)
  constexpr double kLeastArea = 0.3;  // of the bounding box
  return !cut_off && static_cast<double>(border.count) <= kLongest * (width + height) &&
         std::abs(border.signed_area) >= kLeastArea * width * height;
}

}  // namespace

bool TagQuadFinder::Covers(int pass, double least_px, double most_px) {
  return most_px >= kQuadPasses[pass].min_px && least_px <= kQuadPasses[pass].max_px;
}

void TagQuadFinder::Begin(const cv::Mat& image, const cv::Rect& part,
                          TagQuadBuffers* buffers) const {
  if (buffers->width_px != image.cols || buffers->height_px != image.rows) {
    buffers->width_px = image.cols;
    buffers->height_px = image.rows;
    buffers->tracer.Reserve(image.cols, image.rows);
    buffers->quads.reserve(kMostBorders);
    // Runs the parts whose memory depends on the size alone.
    const cv::Rect whole(0, 0, image.cols, image.rows);
    buffers->pyramid.Build(image);
    for (int pass = 0; pass < kPasses; ++pass) Find(whole, pass, buffers);
  }
  buffers->pyramid.Build(image(part), kLastTileLevel);
}

void TagQuadFinder::Find(const cv::Rect& part, int pass_index, TagQuadBuffers* buffers) const {
  buffers->quads.clear();
  buffers->borders = 0;
  const QuadPass& pass = kQuadPasses[pass_index];
  const cv::Mat at_level = buffers->pyramid.ImageAt(pass.image_level);
  if (at_level.empty() || std::min(part.width, part.height) < pass.min_px) return;
  buffers->threshold.Measure(buffers->pyramid, pass.image_level, pass.tile_level);
  constexpr int kLeastContrast = 10, kMostContrast = 28;
  const int contrast =
      std::clamp(buffers->threshold.ContrastQuantile(0.7), kLeastContrast, kMostContrast);
  buffers->threshold.Binarize(at_level, contrast, &buffers->binary);
  BorderLimits limits;
  limits.min_extent = std::max(6, pass.min_px >> pass.image_level);
  limits.min_count = 4 * static_cast<std::size_t>(limits.min_extent);
  limits.max_extent = pass.max_px >> pass.image_level;
  limits.narrow = true;
  BorderTracer& tracer = buffers->tracer;
  tracer.Trace(buffers->binary, cv::Rect(0, 0, at_level.cols, at_level.rows), limits);
  const Level level{static_cast<double>(1 << pass.image_level), part.tl()};
  for (const Border& border : tracer.borders()) {
    TagQuad quad;
    ++buffers->borders;
    if (buffers->quads.size() < kMostBorders && MayBeQuad(border, at_level.size()) &&
        FitQuad(tracer, border, level, &quad)) {
      buffers->quads.push_back(quad);
    }
  }
}

bool TagQuadFinder::FitQuad(const BorderTracer& tracer, const Border& border, const Level& level,
                            TagQuad* quad) const {
  const auto on_image = [&level](double x, double y) {
    return Eigen::Vector2f(level.scale * x - 0.5 + level.origin.x,
                           level.scale * y - 0.5 + level.origin.y);
  };
  const Eigen::Vector2f middle =
      on_image(0.5 * (border.min.x + border.max.x), 0.5 * (border.min.y + border.max.y));
  const Eigen::Vector3d ray = rays_.Ray(middle.x(), middle.y()).cast<double>();
  if (ray.isZero()) return false;
  PlanePoints on_plane;
  on_plane.camera_from_plane = AxesAcross(ray);
  const Eigen::Matrix3d plane_from_camera = on_plane.camera_from_plane.transpose();
  const GridPoint* const points = tracer.begin(border);
  const int count = static_cast<int>(border.count);
  const int step = (count + kMostPoints - 1) / kMostPoints;
  for (int i = 0; i < count; i += step) {
    const GridPoint& a = points[i];
    const GridPoint& b = points[(i + 1) % count];
    const Eigen::Vector2f pixel = on_image(0.5 * (a.x + b.x), 0.5 * (a.y + b.y));
    const Eigen::Vector3d local =
        plane_from_camera * rays_.Ray(pixel.x(), pixel.y()).cast<double>();
    constexpr double kLeastForward = 0.2;
    if (local.z() < kLeastForward) return false;
    on_plane.points[on_plane.count++] = local.hnormalized();
  }
  const std::array<int, 4> rough = RoughCorners(on_plane);
  std::array<PlaneLine, 4> sides;
  const double allowed = 0.6 * level.scale / focal_px_;
  for (int k = 0; k < 4; ++k) {
    if (!FitSide(on_plane, rough[k], rough[(k + 1) % 4], &sides[k])) return false;
    constexpr double kBend = 0.02;  // of the length
    const double length = (on_plane.points[rough[(k + 1) % 4]] - on_plane.points[rough[k]]).norm();
    if (sides[k].rms > std::max(allowed, kBend * length)) return false;
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
    quad->corners[k] = (on_plane.camera_from_plane * corner.homogeneous()).normalized();
  }
  return true;
}

}  // namespace kestrel
