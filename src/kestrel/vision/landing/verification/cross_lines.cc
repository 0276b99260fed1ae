// SPDX-License-Identifier: BSD-3-Clause
#include <array>
#include <cmath>
#include <numbers>

#include "kestrel/vision/landing/verification/cross.h"

namespace kestrel {
namespace {

// All lengths in inner radii.
constexpr double kTolerance = 0.05;     // distance of a point from its line
constexpr double kMinLength = 0.25;     // length of a line
constexpr double kMinSideLength = 0.5;  // total, along each side of both half arms

// Fills workspace->segments with the straight pieces of all borders of the dark pixels.
void CollectSegments(const RingInside& inside, CrossLinesWorkspace* workspace) {
  const int size = inside.dark.size();
  BinaryImage& binary = workspace->binary;
  binary.dark.Reset(size, size);
  binary.bright.Reset(size, size);
  for (int y = 0; y < size; ++y) *binary.dark.row(y) = inside.dark.row(y);
  // Every border is needed here, so the rows above every pixel count as bright.
  for (int y = -1; y < size; ++y) *binary.bright.row(y) = ~std::uint64_t{0};
  workspace->tracer.Trace(binary, cv::Rect(0, 0, size, size), BorderLimits{});
  workspace->segments.clear();
  for (const Border& border : workspace->tracer.borders()) {
    const GridPoint* points = workspace->tracer.begin(border);
    workspace->border.clear();
    for (std::size_t i = 0; i < border.count; ++i) {
      workspace->border.emplace_back(inside.Coordinate(points[i].x - 0.5),
                                     inside.Coordinate(points[i].y - 0.5));
    }
    SplitAndMerge(workspace->border, /*closed=*/true, kTolerance, kMinLength, &workspace->breaks,
                  &workspace->segments);
  }
}

}  // namespace

void CrossLinesWorkspace::Reserve() {
  binary.dark.Reset(SmallMask::kMaxSize, SmallMask::kMaxSize);
  binary.bright.Reset(SmallMask::kMaxSize, SmallMask::kMaxSize);
  tracer.Reserve(SmallMask::kMaxSize, SmallMask::kMaxSize);
  border.reserve(tracer.capacity());
  breaks.reserve(tracer.capacity() + 1);
  segments.reserve(tracer.capacity());
}

std::optional<Cross> FindCrossByLines(const RingInside& inside, const LandingPattern& pattern,
                                      CrossLinesWorkspace* workspace) {
  CollectSegments(inside, workspace);
  // Common direction of the lines modulo a right angle, weighted by length. The rim of the disc
  // contributes short pieces in all directions.
  double cosine = 0, sine = 0;
  for (const LineSegment& segment : workspace->segments) {
    const Eigen::Vector2d d = segment.end - segment.start;
    const double angle = std::atan2(d.y(), d.x());
    const double weight = d.squaredNorm();
    cosine += weight * std::cos(4 * angle);
    sine += weight * std::sin(4 * angle);
  }
  const double direction = std::atan2(sine, cosine) / 4;

  const double half_width = 0.5 * pattern.arm_width_m / pattern.inner_radius_m();
  std::array<std::array<double, 2>, 2> side_length{};  // per arm and side
  double c4 = 0, s4 = 0;
  for (const LineSegment& segment : workspace->segments) {
    const Eigen::Vector2d d = segment.end - segment.start;
    const double turn = std::remainder(std::atan2(d.y(), d.x()) - direction, std::numbers::pi / 2);
    if (std::abs(turn) > 12 * std::numbers::pi / 180) continue;
    const double along = std::cos(direction) * d.x() + std::sin(direction) * d.y();
    const int arm = std::abs(along) > 0.5 * d.norm() ? 0 : 1;
    const double normal_angle = direction + (arm == 0 ? 0.5 : 0.0) * std::numbers::pi;
    const Eigen::Vector2d middle = 0.5 * (segment.start + segment.end);
    const double offset = std::cos(normal_angle) * middle.x() + std::sin(normal_angle) * middle.y();
    if (std::abs(std::abs(offset) - half_width) > 0.5 * half_width) continue;
    side_length[arm][offset > 0 ? 1 : 0] += d.norm();
    c4 += d.norm() * std::cos(4 * (direction + turn));
    s4 += d.norm() * std::sin(4 * (direction + turn));
  }
  for (const auto& arm : side_length) {
    if (arm[0] < kMinSideLength || arm[1] < kMinSideLength) return std::nullopt;
  }
  return Cross{std::atan2(s4, c4) / 4};
}

}  // namespace kestrel
