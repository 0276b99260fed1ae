// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/objects/shapes/touching_discs.h"

#include <cmath>
#include <functional>
#include <numbers>
#include <vector>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "kestrel/vision/objects/segmentation/segment_border.h"

namespace kestrel {
namespace {

using Figure = std::function<bool(const Eigen::Vector2d&)>;

// Returns the radius found in an image of a figure around the origin, turned by 'turn' (rad).
std::optional<double> RadiusIn(const Figure& figure, double turn) {
  constexpr int kSize = 160;
  const Eigen::Rotation2Dd rotation(turn);
  std::vector<PixelPosition> pixels;
  Segment segment;
  segment.min_u = segment.min_v = kSize;
  for (int v = 0; v < kSize; ++v) {
    for (int u = 0; u < kSize; ++u) {
      if (!figure(rotation * Eigen::Vector2d(u - 0.5 * kSize, v - 0.5 * kSize))) continue;
      pixels.push_back({static_cast<std::int16_t>(u), static_cast<std::int16_t>(v)});
      segment.min_u = std::min(segment.min_u, u);
      segment.max_u = std::max(segment.max_u, u);
      segment.min_v = std::min(segment.min_v, v);
      segment.max_v = std::max(segment.max_v, v);
    }
  }
  segment.pixels = pixels;
  SegmentBorder border;
  FindBorder(segment, {kSize, kSize}, &border);
  AddDiagonalEnds(segment, &border);
  std::vector<Eigen::Vector2d> inside;
  for (std::size_t i = 0; i < pixels.size(); i += 1 + pixels.size() / kTouchingDiscsPoints) {
    inside.emplace_back(pixels[i].u, pixels[i].v);
  }
  return RadiusOfTouchingDiscs(inside, border.points, 1);
}

Figure Discs(const std::vector<Eigen::Vector2d>& centers, double radius) {
  return [=](const Eigen::Vector2d& at) {
    return std::ranges::any_of(
        centers, [&](const Eigen::Vector2d& center) { return (at - center).norm() <= radius; });
  };
}

Figure Box(double half_width, double half_height) {
  return [=](const Eigen::Vector2d& at) {
    return std::abs(at.x()) <= half_width && std::abs(at.y()) <= half_height;
  };
}

// A round figure with 'lobes' bulges.
Figure Lobes(int lobes, double radius, double depth) {
  return [=](const Eigen::Vector2d& at) {
    return at.norm() <= radius * (1 + depth * std::cos(lobes * std::atan2(at.y(), at.x())));
  };
}

Figure Star(int tips, double radius) {
  return [=](const Eigen::Vector2d& at) {
    const double step = 2 * std::numbers::pi / tips;
    const double turn = std::abs(std::remainder(std::atan2(at.y(), at.x()), step));
    // The edge from a tip to the notch, which is at 0.4 of the tip's radius.
    const Eigen::Vector2d notch = 0.4 * Eigen::Vector2d(std::cos(step / 2), std::sin(step / 2));
    const Eigen::Vector2d edge = notch - Eigen::Vector2d(1, 0);
    const Eigen::Vector2d to =
        at.norm() / radius * Eigen::Vector2d(std::cos(turn), std::sin(turn)) -
        Eigen::Vector2d(1, 0);
    return edge.x() * to.y() - edge.y() * to.x() >= 0;
  };
}

TEST(RadiusOfTouchingDiscs, FindsRadiusOfTouchingDiscs) {
  for (const double radius : {8.0, 12.0, 20.0}) {
    const double near = 1.9 * radius;
    const std::vector<std::vector<Eigen::Vector2d>> groups = {
        {{-near / 2, 0}, {near / 2, 0}},
        {{-near, 0}, {0, 0}, {near, 0}},
        {{-near, 0}, {0, 0}, {0, near}},
        {{0, 0}, {near, 0}, {near / 2, near * 0.866}}};
    for (const auto& group : groups) {
      for (const double turn : {0.0, 0.4, 1.0}) {
        const auto found = RadiusIn(Discs(group, radius), turn);
        ASSERT_TRUE(found) << group.size() << " of " << radius << " px, turned by " << turn;
        EXPECT_NEAR(*found, radius, 0.1 * radius);
      }
    }
  }
}

TEST(RadiusOfTouchingDiscs, RejectsOtherFigures) {
  const auto either = [](const Figure& a, const Figure& b) {
    return [=](const Eigen::Vector2d& at) { return a(at) || b(at); };
  };
  const auto without = [](const Figure& a, const Figure& b) {
    return [=](const Eigen::Vector2d& at) { return a(at) && !b(at); };
  };
  const auto moved = [](const Figure& a, double x, double y) {
    return [=](const Eigen::Vector2d& at) { return a(at - Eigen::Vector2d(x, y)); };
  };
  const Figure disc = Discs({{0, 0}}, 1);
  const std::vector<std::pair<const char*, Figure>> figures = {
      {"disc", disc},
      {"ellipse", [](const Eigen::Vector2d& at) { return std::hypot(at.x() / 2, at.y()) <= 1; }},
      {"half a disc", without(disc, moved(Box(1, 1), 0, 1))},
      {"square", Box(1, 1)},
      {"rectangle", Box(2, 1)},
      {"long rectangle", Box(2.5, 0.5)},
      {"sausage", either(Box(1, 1), Discs({{-1, 0}, {1, 0}}, 1))},
      {"cross", either(Box(2, 0.6), Box(0.6, 2))},
      {"angle", either(moved(Box(0.5, 2), -1.5, 0), moved(Box(2, 0.5), 0, 1.5))},
      {"bracket", without(Box(2, 2), moved(Box(2, 1.2), 0.9, 0))},
      {"triangle", Star(3, 2)},
      {"star", Star(5, 2)},
      {"peanut", Lobes(2, 1.4, 0.35)},
      {"three lobes", Lobes(3, 1.4, 0.3)},
      {"four lobes", Lobes(4, 1.4, 0.3)},
      {"two squares that touch", either(moved(Box(1, 1), -1, -1), moved(Box(1, 1), 1, 0.9))},
      {"disc that touches a smaller one", either(disc, moved(Discs({{0, 0}}, 0.6), 1.5, 0))},
      {"disc that touches a square", either(disc, moved(Box(1, 1), 1.9, 0))},
  };
  for (const auto& [name, figure] : figures) {
    for (const double size : {6.0, 12.0, 20.0}) {
      for (int i = 0; i < 8; ++i) {
        const double turn = std::numbers::pi * i / 8;
        // clang 14 captures no structured binding without an initializer.
        const Figure scaled = [size, &of_size_one = figure](const Eigen::Vector2d& at) {
          return of_size_one(at / size);
        };
        EXPECT_FALSE(RadiusIn(scaled, turn)) << name << " of " << size << " px, turned by " << turn;
      }
    }
  }
}

}  // namespace
}  // namespace kestrel
