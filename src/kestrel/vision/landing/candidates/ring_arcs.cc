// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/landing/candidates/ring_arcs.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>

#include <Eigen/Eigenvalues>

#include "kestrel/core/geometry/angles.h"

namespace kestrel {
namespace {

constexpr std::size_t kStride = 3;       // border points per smoothed point
constexpr std::size_t kChord = 2;        // smoothed points over which a direction is taken
constexpr double kCorner = Radians(45);  // turn from one direction to the next that makes a corner
constexpr double kSharpness = 3;         // if it is so many times the turn before and after it
constexpr std::size_t kApart = 3;        // smoothed points from a corner to the turns beside it
constexpr double kAgainst = -Radians(14);  // turn against the bend that ends an arc
constexpr double kMinTurning = Radians(45);
constexpr std::size_t kMinPoints = 6;
// Least shares of the rays that lie near a cone: of the two arcs that it is fitted to, of all arcs
// on it, and of an arc that lies on it, for which 'near' is kNearby times as far.
constexpr double kLeastShareOfPair = 0.9;
constexpr double kLeastShareGrown = 0.85;
constexpr double kLeastShareOfArc = 0.6;
constexpr double kNearby = 1.5;
// Limits for two arcs of a ring, in lengths of the longer one: their distance, and how far one may
// lie behind the chord of the other.
constexpr float kApartMost = 4;
constexpr float kBehind = 0.1f;
constexpr std::size_t kMaxArcs = 40;  // those that are longest and bend most are kept
constexpr std::size_t kMaxSeeds = 6;
constexpr std::size_t kMaxRings = 4;

// Averages the border over a window that evens out the steps of pixels, at every kStride-th point.
void SmoothBorder(const GridPoint* points, std::size_t count,
                  std::vector<Eigen::Vector2f>* smooth) {
  smooth->clear();
  constexpr std::size_t kWindow = 2;
  const auto add_mean = [&](const auto& point_at) {
    int x = 0, y = 0;
    for (std::size_t j = 0; j <= 2 * kWindow; ++j) {
      const GridPoint& p = point_at(j);
      x += p.x;
      y += p.y;
    }
    smooth->push_back(Eigen::Vector2f(static_cast<float>(x), static_cast<float>(y)) /
                          (2 * kWindow + 1) -
                      Eigen::Vector2f(0.5f, 0.5f));
  };
  for (std::size_t i = 0; i + kStride <= count; i += kStride) {
    if (i >= kWindow && i + kWindow < count) {
      add_mean([&, first = points + i - kWindow](std::size_t j) { return first[j]; });
    } else {
      add_mean([&](std::size_t j) { return points[(i + count - kWindow + j) % count]; });
    }
  }
}

// Returns the angle (rad) from one direction to another, to 0.3 degrees.
float Turn(const Eigen::Vector2f& from, const Eigen::Vector2f& to) {
  const float degrees = cv::fastAtan2(from.x() * to.y() - from.y() * to.x(), from.dot(to));
  return static_cast<float>(Radians(1)) * (degrees > 180 ? degrees - 360 : degrees);
}

class ArcCutter {
 public:
  ArcCutter(cv::Size size, RingArcsWorkspace* workspace) : size_(size), workspace_(*workspace) {}

  // Cuts workspace.smooth, a closed curve with the dark side on its right, into arcs.
  void Cut() {
    const std::size_t n = workspace_.smooth.size();
    if (n < kMinPoints + kChord) return;
    workspace_.turns.resize(n);
    for (std::size_t i = 0; i < n; ++i) workspace_.turns[i] = TurnAt(i);
    // Goes once around, and on until the arc that crosses the start has ended.
    std::size_t start = 0;
    double turning = 0;
    bool wrapped = false;
    for (std::size_t i = 0; i < 2 * n; ++i) {
      const double turn = workspace_.turns[Wrap(i, n)] / kChord;
      const bool ends = IsCorner(i) || IsAtImageBorder(i + kChord);
      const bool opposite = turning != 0 && turn * (turning > 0 ? 1 : -1) < kAgainst;
      if (ends || opposite || i - start >= n) {
        if (i > start) Keep(start, i, turning);
        if (wrapped) return;
        start = i + (ends ? kChord + 1 : 0);
        turning = ends ? 0 : turn;
      } else if (i >= start) {
        turning += turn;
      }
      wrapped = i >= n;
    }
  }

 private:
  // Index in a closed curve of n points, for i < 2 n.
  static std::size_t Wrap(std::size_t i, std::size_t n) { return i < n ? i : i - n; }

  // Turn (rad) at the point kChord after 'i', i < n.
  float TurnAt(std::size_t i) const {
    const std::vector<Eigen::Vector2f>& curve = workspace_.smooth;
    const std::size_t n = curve.size();
    const Eigen::Vector2f& a = curve[i];
    const Eigen::Vector2f& b = curve[Wrap(i + kChord, n)];
    const Eigen::Vector2f& c = curve[Wrap(i + 2 * kChord, n)];
    return Turn(b - a, c - b);
  }

  // True at a corner. The end of a narrow ellipse may turn as fast, but not all at once.
  bool IsCorner(std::size_t i) const {
    const std::vector<float>& turns = workspace_.turns;
    const std::size_t n = turns.size();
    const float turn = std::abs(turns[Wrap(i, n)]);
    if (turn <= static_cast<float>(kCorner)) return false;
    const auto sharper_than = [&](float other) {
      return turn > static_cast<float>(kSharpness) * std::abs(other);
    };
    return sharper_than(turns[(i + n - kApart) % n]) && sharper_than(turns[(i + kApart) % n]);
  }

  // True where the image border cuts off a dark area: there its border is not an edge of anything.
  bool IsAtImageBorder(std::size_t i) const {
    const Eigen::Vector2f& point = workspace_.smooth[i % workspace_.smooth.size()];
    constexpr float kMargin = 1;
    return point.x() < kMargin - 0.5f || point.y() < kMargin - 0.5f ||
           point.x() > static_cast<float>(size_.width) - 0.5f - kMargin ||
           point.y() > static_cast<float>(size_.height) - 0.5f - kMargin;
  }

  // Adds the arc of the directions 'first' to 'last' when it bends enough.
  void Keep(std::size_t first, std::size_t last, double turning) {
    const std::vector<Eigen::Vector2f>& curve = workspace_.smooth;
    const std::size_t n = curve.size();
    if (std::abs(turning) < kMinTurning || last < first + kMinPoints) return;
    const std::size_t count = std::min(last - first + kChord, n);
    if (workspace_.points.size() + count > workspace_.points.capacity()) return;
    RingArc arc;
    arc.first = workspace_.points.size();
    arc.count = count;
    arc.turning = std::min(std::abs(turning), 2 * std::numbers::pi);
    // With dark on the right, a right turn (positive, y down) bends around the dark side.
    arc.edge = turning > 0 ? RingEdge::kOuter : RingEdge::kInner;
    for (std::size_t i = 0; i < count; ++i) {
      workspace_.points.push_back(curve[(first + i) % n]);
    }
    const Eigen::Vector2f& begin = workspace_.points[arc.first];
    const Eigen::Vector2f& end = workspace_.points.back();
    const Eigen::Vector2f chord = end - begin;
    arc.length = std::max(chord.norm(), 1e-3f);
    arc.middle = 0.5f * (begin + end);
    const float side = turning > 0 ? 1.0f : -1.0f;
    arc.inward = side * Eigen::Vector2f(-chord.y(), chord.x()) / arc.length;
    workspace_.arcs.push_back(arc);
  }

  cv::Size size_;  // size of the image in which the borders were traced
  RingArcsWorkspace& workspace_;
};

// True when at least 'share' of the rays lie near a cone. Stops when too many lie beside it: most
// pairs of arcs are not of one ring.
bool AreNearCone(const Cone& cone, std::span<const Eigen::Vector3d> rays, double tolerance,
                 double share) {
  const auto count = static_cast<double>(rays.size());
  double near_at_most = count;
  for (const Eigen::Vector3d& ray : rays) {
    if (cone.AngleTo(ray) <= tolerance) continue;
    if (--near_at_most < share * count) return false;
  }
  return true;
}

class ArcGrouper {
 public:
  ArcGrouper(double tolerance, RingArcsWorkspace* workspace)
      : tolerance_(tolerance), workspace_(*workspace) {}

  // Grows a ring from an arc: adds the partner that makes the longest pair on one cone, then all
  // arcs on that cone.
  void Grow(std::size_t seed, double min_coverage) {
    const RingArc& arc = workspace_.arcs[seed];
    std::optional<Cone> best = Fit({seed, seed});
    double best_turning = best ? arc.turning : 0;
    for (std::size_t other = 0; other < workspace_.arcs.size(); ++other) {
      const RingArc& partner = workspace_.arcs[other];
      if (other == seed || partner.edge != arc.edge ||
          arc.turning + partner.turning <= best_turning || !FaceEachOther(arc, partner)) {
        continue;
      }
      if (std::optional<Cone> cone = Fit({seed, other})) {
        best = cone;
        best_turning = arc.turning + partner.turning;
      }
    }
    if (!best) return;
    for (int round = 0; round < 2; ++round) {
      Collect(*best, arc.edge);
      const std::optional<Cone> grown = FitCone(workspace_.selected);
      if (!grown || !SelectedAreNear(*grown, kLeastShareGrown)) break;
      best = grown;
    }
    Collect(*best, arc.edge);
    if (workspace_.selected.size() < 2 * kMinPoints) return;
    ArcRing ring{*best, arc.edge, Eigen::Vector3d::Zero(), 0};
    for (const Eigen::Vector3d& ray : workspace_.selected) ring.toward += ray;
    ring.coverage = Coverage(ring);
    if (ring.coverage < min_coverage) return;
    MarkUsed(*best, arc.edge);
    workspace_.rings.push_back(ring);
  }

 private:
  std::span<const Eigen::Vector3d> RaysOf(const RingArc& arc) const {
    return {workspace_.rays.data() + arc.first, arc.count};
  }

  // True when each arc lies on the inner side of the other's chord, not many lengths away.
  static bool FaceEachOther(const RingArc& a, const RingArc& b) {
    const Eigen::Vector2f between = b.middle - a.middle;
    const float longest = std::max(a.length, b.length);
    return between.norm() < kApartMost * longest && between.dot(a.inward) > -kBehind * longest &&
           between.dot(b.inward) < kBehind * longest;
  }

  std::optional<Cone> Fit(std::array<std::size_t, 2> pair) {
    workspace_.selected.clear();
    for (std::size_t i = 0; i < (pair[0] == pair[1] ? 1u : 2u); ++i) {
      const auto rays = RaysOf(workspace_.arcs[pair[i]]);
      workspace_.selected.insert(workspace_.selected.end(), rays.begin(), rays.end());
    }
    std::optional<Cone> cone = FitCone(workspace_.selected);
    if (cone && !SelectedAreNear(*cone, kLeastShareOfPair)) cone.reset();
    return cone;
  }

  bool SelectedAreNear(const Cone& cone, double share) const {
    return AreNearCone(cone, workspace_.selected, tolerance_, share);
  }

  bool LiesOn(const RingArc& arc, const Cone& cone, RingEdge edge) const {
    return arc.edge == edge &&
           AreNearCone(cone, RaysOf(arc), kNearby * tolerance_, kLeastShareOfArc);
  }

  // Selects the rays near 'cone' of all arcs that lie on it.
  void Collect(const Cone& cone, RingEdge edge) {
    workspace_.selected.clear();
    for (const RingArc& arc : workspace_.arcs) {
      if (!LiesOn(arc, cone, edge)) continue;
      for (const Eigen::Vector3d& ray : RaysOf(arc)) {
        if (cone.AngleTo(ray) <= kNearby * tolerance_) workspace_.selected.push_back(ray);
      }
    }
  }

  void MarkUsed(const Cone& cone, RingEdge edge) {
    for (std::size_t i = 0; i < workspace_.arcs.size(); ++i) {
      if (LiesOn(workspace_.arcs[i], cone, edge)) workspace_.used[i] = 1;
    }
  }

  // Returns the share of directions around the cone's axis, one for each bit, that have a selected
  // ray.
  double Coverage(const ArcRing& ring) const {
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(ring.cone.matrix);
    const Eigen::Vector3d wide = solver.eigenvectors().col(1) / std::sqrt(solver.eigenvalues()(1));
    const Eigen::Vector3d narrow =
        solver.eigenvectors().col(2) / std::sqrt(solver.eigenvalues()(2));
    constexpr int kDirectionBins = std::numeric_limits<std::uint32_t>::digits;
    std::uint32_t bins = 0;
    for (const Eigen::Vector3d& ray : workspace_.selected) {
      // Dividing by the half axes (1 / sqrt of the eigenvalues) makes the ellipse a circle.
      const double x = ray.dot(wide) / wide.squaredNorm();
      const double y = ray.dot(narrow) / narrow.squaredNorm();
      const double turn = std::atan2(y, x) / (2 * std::numbers::pi) + 0.5;
      bins |= std::uint32_t{1} << (static_cast<int>(turn * kDirectionBins) % kDirectionBins);
    }
    return static_cast<double>(std::popcount(bins)) / kDirectionBins;
  }

  double tolerance_;
  RingArcsWorkspace& workspace_;
};

}  // namespace

void RingArcsWorkspace::Reserve(std::size_t border_points) {
  const std::size_t count = border_points / kStride + 1;
  smooth.reserve(count);
  turns.reserve(count);
  // Neighbouring arcs share points where one ends and the other begins.
  points.reserve(2 * count);
  rays.reserve(2 * count);
  selected.reserve(2 * count);
  arcs.reserve(2 * count / kMinPoints);
  used.reserve(kMaxArcs);
  rings.reserve(kMaxRings);
}

void FindArcRings(const BorderTracer& tracer, std::span<const Border> borders, const RayTable& rays,
                  const ImageRegion& region, double tolerance_rad, double min_coverage,
                  RingArcsWorkspace* workspace) {
  workspace->points.clear();
  workspace->arcs.clear();
  workspace->rings.clear();
  ArcCutter cutter(tracer.image_size(), workspace);
  for (const Border& border : borders) {
    if (border.count / kStride > workspace->smooth.capacity()) continue;
    SmoothBorder(tracer.begin(border), border.count, &workspace->smooth);
    cutter.Cut();
  }
  std::vector<RingArc>& arcs = workspace->arcs;
  std::sort(arcs.begin(), arcs.end(), [](const RingArc& a, const RingArc& b) {
    return a.turning * static_cast<double>(a.count) > b.turning * static_cast<double>(b.count);
  });
  if (arcs.size() > kMaxArcs) arcs.resize(kMaxArcs);
  workspace->rays.assign(workspace->points.size(), Eigen::Vector3d::Zero());
  for (const RingArc& arc : arcs) {
    for (std::size_t i = arc.first; i < arc.first + arc.count; ++i) {
      const Eigen::Vector2d pixel = region.ToFull(workspace->points[i].cast<double>());
      workspace->rays[i] =
          rays.Ray(static_cast<float>(pixel.x()), static_cast<float>(pixel.y())).cast<double>();
    }
  }
  workspace->used.assign(arcs.size(), 0);
  ArcGrouper grouper(tolerance_rad, workspace);
  std::size_t seeds = 0;
  for (std::size_t i = 0; i < arcs.size() && seeds < kMaxSeeds; ++i) {
    if (workspace->used[i]) continue;
    ++seeds;
    grouper.Grow(i, min_coverage);
    if (workspace->rings.size() >= kMaxRings) break;
  }
  std::sort(workspace->rings.begin(), workspace->rings.end(),
            [](const ArcRing& a, const ArcRing& b) { return a.coverage > b.coverage; });
}

}  // namespace kestrel
