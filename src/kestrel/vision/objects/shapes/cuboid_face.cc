// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/objects/shapes/cuboid_face.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <Eigen/LU>

#include "kestrel/vision/objects/shapes/color_edge.h"
#include "kestrel/vision/objects/shapes/otsu.h"

namespace kestrel {
namespace {

// The kinds of pixels in a segment's bounding box.
enum Mark : std::uint8_t { kOutside, kColored, kDigit };

// The kinds of pixels of a mask while a connected part of it is searched.
enum Part : std::uint8_t { kUnset, kSet, kKept };

// The bounding box with a margin of one pixel.
struct Box {
  explicit Box(const Segment& segment)
      : left(segment.min_u - 1),
        top(segment.min_v - 1),
        width(segment.width() + 2),
        height(segment.height() + 2) {}

  std::size_t Index(const PixelPosition& at) const {
    return static_cast<std::size_t>(at.v - top) * width + (at.u - left);
  }
  // Visits the indices of all pixels except the margin.
  template <class Visit>
  void ForEachInside(const Visit& visit) const {
    for (int v = 1; v + 1 < height; ++v) {
      for (int u = 1; u + 1 < width; ++u) visit(static_cast<std::size_t>(v) * width + u);
    }
  }
  std::array<std::size_t, 9> Neighborhood(std::size_t i) const {
    const std::size_t w = width;
    return {i - w - 1, i - w, i - w + 1, i - 1, i, i + 1, i + w - 1, i + w, i + w + 1};
  }

  int left, top, width, height;
};

std::uint8_t ValueAt(const cv::Mat& image, const PixelPosition& at) {
  const std::uint8_t* bgr = image.ptr(at.v) + 3 * at.u;
  return std::max({bgr[0], bgr[1], bgr[2]});
}

void MarkPixels(const cv::Mat& image, const Segment& segment, const Box& box,
                CuboidFaceWorkspace* workspace) {
  const std::size_t size = static_cast<std::size_t>(box.width) * box.height;
  workspace->mask.assign(size, kOutside);
  workspace->values.assign(size, 0);
  workspace->digit.clear();
  const std::size_t colored = segment.pixels.size() - segment.ambiguous_pixels;
  for (std::size_t i = 0; i < segment.pixels.size(); ++i) {
    const std::size_t index = box.Index(segment.pixels[i]);
    workspace->mask[index] = i < colored ? kColored : kDigit;
    if (i >= colored) workspace->digit.push_back(index);
    workspace->values[index] = ValueAt(image, segment.pixels[i]);
  }
  // Mean of the coloured pixels in 3 x 3, to reduce noise.
  workspace->smooth.assign(size, 0);
  box.ForEachInside([&](std::size_t i) {
    if (workspace->mask[i] != kColored) return;
    int sum = 0;
    int count = 0;
    for (const std::size_t near : box.Neighborhood(i)) {
      const bool counts = workspace->mask[near] == kColored;
      sum += counts ? workspace->values[near] : 0;
      count += counts;
    }
    workspace->smooth[i] = static_cast<std::uint8_t>(sum / count);
  });
}

// Median value of the coloured pixels around the digit, beyond the blur but on the same face.
std::optional<int> ValueAroundDigit(const Box& box, const CuboidFaceWorkspace& workspace) {
  constexpr int kDistance = 3;
  Histogram histogram{};
  int count = 0;
  box.ForEachInside([&](std::size_t i) {
    if (workspace.mask[i] != kDigit) return;
    const std::size_t row = kDistance * static_cast<std::size_t>(box.width);
    for (const std::size_t near : {i - kDistance, i + kDistance, i - row, i + row}) {
      if (near >= workspace.mask.size() || workspace.mask[near] != kColored) continue;
      ++histogram[workspace.smooth[near]];
      ++count;
    }
  });
  if (count == 0) return std::nullopt;
  int below = 0;
  for (int value = 0; value < 256; ++value) {
    below += histogram[value];
    if (2 * below >= count) return value;
  }
  return std::nullopt;
}

// Returns the last value from 'start' in the direction of 'step' that belongs to the same peak of
// the histogram. A peak ends at a valley of less than a third of its height, or at zero.
int EndOfHill(const std::array<int, 256>& histogram, int start, int step) {
  constexpr int kWindow = 2;  // the histogram of a small face has holes
  const auto height = [&](int value) {
    int sum = 0;
    for (int i = std::max(0, value - kWindow); i <= std::min(255, value + kWindow); ++i) {
      sum += histogram[i];
    }
    return sum;
  };
  int top = height(start);
  int value = start;
  while (value + step >= 0 && value + step < 256) {
    const int here = height(value);
    const int next = height(value + step);
    top = std::max(top, here);
    if (here * 20 <= top || (here * 3 <= top && next >= here)) break;
    value += step;
  }
  return value;
}

// Sets the mask to 1 for the pixels of the face with the digit and to 0 for all others.
bool MarkFace(const Box& box, CuboidFaceWorkspace* workspace) {
  const std::optional<int> face_value = ValueAroundDigit(box, *workspace);
  if (!face_value) return false;
  Histogram histogram{};
  box.ForEachInside([&](std::size_t i) {
    if (workspace->mask[i] == kColored) ++histogram[workspace->smooth[i]];
  });
  const int darkest = EndOfHill(histogram, *face_value, -1);
  const int brightest = EndOfHill(histogram, *face_value, 1);
  for (std::size_t i = 0; i < workspace->mask.size(); ++i) {
    const bool is_face = workspace->mask[i] == kColored && workspace->smooth[i] >= darkest &&
                         workspace->smooth[i] <= brightest;
    workspace->mask[i] = is_face || workspace->mask[i] == kDigit ? 1 : 0;
  }
  return true;
}

// Majority of 3 x 3: single pixels are noise.
void FilterMask(const Box& box, const std::vector<std::uint8_t>& mask,
                std::vector<std::uint8_t>* filtered) {
  filtered->assign(mask.size(), 0);
  box.ForEachInside([&](std::size_t i) {
    int sum = 0;
    for (const std::size_t near : box.Neighborhood(i)) sum += mask[near];
    (*filtered)[i] = sum >= 5;
  });
}

// Keeps the part that is connected to the digit through pixels whose neighbours all belong to it,
// so that thin bridges do not connect.
void KeepDigitsPart(const Box& box, CuboidFaceWorkspace* workspace) {
  constexpr int kMinNeighbors = 8;
  std::vector<std::uint8_t>& filtered = workspace->filtered;
  const auto is_core = [&](std::size_t i) {
    int sum = 0;
    for (const std::size_t near : box.Neighborhood(i)) sum += filtered[near] != kUnset;
    return sum >= kMinNeighbors;
  };
  std::vector<std::size_t>& queue = workspace->queue;
  queue.clear();
  const auto push = [&](std::size_t i) {
    if (filtered[i] != kSet) return;
    filtered[i] = kKept;
    queue.push_back(i);
  };
  for (const std::size_t i : workspace->digit) push(i);
  for (std::size_t start = 0; start < queue.size(); ++start) {
    if (!is_core(queue[start])) continue;
    for (const std::size_t near : box.Neighborhood(queue[start])) push(near);
  }
  for (std::uint8_t& pixel : filtered) pixel = pixel == kKept ? kSet : kUnset;
}

double Cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

// Removes the last points as long as they make no left turn to 'point', then adds it.
void ExtendChain(const Eigen::Vector2d& point, std::size_t chain_start,
                 std::vector<Eigen::Vector2d>* hull) {
  while (hull->size() >= chain_start + 2) {
    const Eigen::Vector2d& a = (*hull)[hull->size() - 2];
    const Eigen::Vector2d& b = hull->back();
    if (Cross(b - a, point - b) > 0) break;
    hull->pop_back();
  }
  hull->push_back(point);
}

// Convex hull of the set pixels, from the ends of their rows (Andrew's monotone chain).
void FindHull(const Box& box, const std::vector<std::uint8_t>& mask,
              std::vector<Eigen::Vector2d>* hull) {
  hull->clear();
  const auto add_ends = [&](bool left, int v, std::size_t chain_start) {
    const auto row = mask.begin() + static_cast<std::ptrdiff_t>(v) * box.width;
    const auto end = row + box.width;
    const auto first = std::find(row, end, 1);
    if (first == end) return;
    auto last = end - 1;
    while (*last == 0) --last;
    const auto u = static_cast<double>((left ? first : last) - row);
    ExtendChain({box.left + u, box.top + static_cast<double>(v)}, chain_start, hull);
  };
  for (int v = box.height - 1; v >= 0; --v) add_ends(/*left=*/true, v, 0);
  if (hull->empty()) return;
  const std::size_t chain_start = hull->size() - 1;
  for (int v = 0; v < box.height; ++v) add_ends(/*left=*/false, v, chain_start);
}

std::optional<Eigen::Vector2d> Intersection(const Eigen::Vector2d& a, const Eigen::Vector2d& along,
                                            const Eigen::Vector2d& b,
                                            const Eigen::Vector2d& other) {
  const double turn = Cross(along, other);
  if (turn == 0) return std::nullopt;
  return a + Cross(b - a, other) / turn * along;
}

// Removes sides until four are left. Each time it removes the side for which extending its
// neighbours until they meet adds the least area.
bool ReduceToFour(std::vector<Eigen::Vector2d>* polygon) {
  while (polygon->size() > 4) {
    const std::size_t n = polygon->size();
    double best_area = std::numeric_limits<double>::infinity();
    std::size_t best = 0;
    Eigen::Vector2d best_corner = Eigen::Vector2d::Zero();
    for (std::size_t i = 0; i < n; ++i) {
      const Eigen::Vector2d& before = (*polygon)[(i + n - 1) % n];
      const Eigen::Vector2d& a = (*polygon)[i];
      const Eigen::Vector2d& b = (*polygon)[(i + 1) % n];
      const Eigen::Vector2d& after = (*polygon)[(i + 2) % n];
      const auto corner = Intersection(a, a - before, b, b - after);
      if (!corner || (*corner - a).dot(a - before) < 0) continue;
      const double area = std::abs(Cross(b - a, *corner - a));
      if (area >= best_area) continue;
      best_area = area;
      best = i;
      best_corner = *corner;
    }
    if (!std::isfinite(best_area)) return false;
    (*polygon)[best] = best_corner;
    polygon->erase(polygon->begin() + static_cast<std::ptrdiff_t>((best + 1) % n));
  }
  return polygon->size() == 4;
}

struct Line {
  Eigen::Vector2d point;
  Eigen::Vector2d direction;
};

// Fits a line through the sub-pixel edges along the side from 'a' to 'b'. Returns the side itself
// when too few edges are visible. 'center' is inside of the face.
Line FitSide(const cv::Mat& image, const Eigen::Vector2d& a, const Eigen::Vector2d& b,
             const Eigen::Vector2d& center) {
  constexpr int kPoints = 13;
  // Share of a side at either end that is left out: there the profile crosses two edges.
  constexpr double kClear = 0.15;
  Line side{0.5 * (a + b), (b - a).normalized()};
  Eigen::Vector2d outward(side.direction.y(), -side.direction.x());
  if (outward.dot(side.point - center) < 0) outward = -outward;
  std::array<Eigen::Vector2d, kPoints> points;
  int count = 0;
  for (int i = 0; i < kPoints; ++i) {
    const double t = kClear + (1 - 2 * kClear) * i / (kPoints - 1);
    const Eigen::Vector2d start = a + t * (b - a);
    if (const auto edge = FindColorEdge(image, start, outward)) {
      points[count++] = start + edge->offset_px * outward;
    }
  }
  if (count < kPoints / 2) return side;
  // Least squares, then again without outliers.
  Line line = side;
  for (const double limit_px : {std::numeric_limits<double>::infinity(), 0.7}) {
    Eigen::Vector2d mean = Eigen::Vector2d::Zero();
    Eigen::Matrix2d scatter = Eigen::Matrix2d::Zero();
    double used = 0;
    for (int pass = 0; pass < 2; ++pass) {
      for (int i = 0; i < count; ++i) {
        if (std::abs(Cross(line.direction, points[i] - line.point)) > limit_px) continue;
        if (pass == 0) {
          mean += points[i];
          ++used;
        } else {
          scatter += (points[i] - mean) * (points[i] - mean).transpose();
        }
      }
      if (pass == 0) {
        if (used < 4) return line;
        mean /= used;
      }
    }
    line = {mean, Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(scatter).eigenvectors().col(1)};
  }
  return line;
}

bool IsConvex(const FaceCorners& corners) {
  double sign = 0;
  for (int i = 0; i < 4; ++i) {
    const double turn =
        Cross(corners[(i + 1) % 4] - corners[i], corners[(i + 2) % 4] - corners[(i + 1) % 4]);
    if (sign * turn < 0 || turn == 0) return false;
    sign = turn;
  }
  return true;
}

}  // namespace

double QuadrilateralArea(const FaceCorners& corners) {
  return 0.5 * std::abs(Cross(corners[2] - corners[0], corners[3] - corners[1]));
}

std::optional<FaceCorners> RefineCorners(const cv::Mat& image,
                                         std::span<const Eigen::Vector2d> polygon) {
  const Eigen::Vector2d center = (polygon[0] + polygon[1] + polygon[2] + polygon[3]) / 4;
  std::array<Line, 4> sides;
  for (int i = 0; i < 4; ++i) {
    sides[i] = FitSide(image, polygon[i], polygon[(i + 1) % 4], center);
  }
  FaceCorners corners;
  for (int i = 0; i < 4; ++i) {
    const Line& before = sides[(i + 3) % 4];
    const auto corner =
        Intersection(before.point, before.direction, sides[i].point, sides[i].direction);
    if (!corner || (*corner - polygon[i]).norm() > 6) return std::nullopt;
    corners[i] = *corner;
  }
  if (!IsConvex(corners)) return std::nullopt;
  return corners;
}

std::optional<FaceCorners> FindCuboidFace(const cv::Mat& image, const Segment& segment,
                                          CuboidFaceWorkspace* workspace) {
  constexpr double kMinFill = 0.8;
  if (segment.ambiguous_pixels == 0) return std::nullopt;
  const Box box(segment);
  MarkPixels(image, segment, box, workspace);
  if (!MarkFace(box, workspace)) return std::nullopt;
  FilterMask(box, workspace->mask, &workspace->filtered);
  KeepDigitsPart(box, workspace);
  FindHull(box, workspace->filtered, &workspace->hull);
  // Andrew's chain repeats its first point at the end.
  if (workspace->hull.size() > 1 && workspace->hull.front() == workspace->hull.back()) {
    workspace->hull.pop_back();
  }
  if (!ReduceToFour(&workspace->hull)) return std::nullopt;
  FaceCorners corners;
  std::ranges::copy(workspace->hull, corners.begin());
  const auto pixels =
      static_cast<double>(std::count(workspace->filtered.begin(), workspace->filtered.end(), 1));
  if (pixels < kMinFill * QuadrilateralArea(corners)) return std::nullopt;
  return corners;
}

}  // namespace kestrel
