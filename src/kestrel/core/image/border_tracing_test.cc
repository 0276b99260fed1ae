// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/core/image/border_tracing.h"

#include <cmath>
#include <cstdlib>
#include <set>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <opencv2/core.hpp>

#include "kestrel/core/base/random.h"
#include "kestrel/core/image/test_figures.h"

namespace kestrel {
namespace {

constexpr BorderLimits kNoLimits{0, 0, 1 << 14};

BorderTracer TraceAll(const BinaryImage& binary, const BorderLimits& limits = kNoLimits) {
  BorderTracer tracer;
  tracer.Trace(binary, cv::Rect(0, 0, binary.dark.width(), binary.dark.height()), limits);
  return tracer;
}

bool InDisc(int x, int y, double cx, double cy, double radius) {
  return std::hypot(x - cx, y - cy) <= radius;
}

// Counts areas of one value, connected by edges only or by corners too. The image has a frame of
// clear pixels around it.
int CountAreas(const BitImage& image, bool value, bool by_corners) {
  const int width = image.width() + 2;
  const int height = image.height() + 2;
  std::vector<char> seen(static_cast<std::size_t>(width) * height, 0);
  int areas = 0;
  std::vector<std::pair<int, int>> stack;
  const auto push = [&](int x, int y) {
    if (x < 0 || y < 0 || x >= width || y >= height || seen[y * width + x]) return;
    if (image.at(x - 1, y - 1) != value) return;
    seen[y * width + x] = 1;
    stack.emplace_back(x, y);
  };
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      push(x, y);
      if (!stack.empty()) ++areas;
      while (!stack.empty()) {
        const auto [px, py] = stack.back();
        stack.pop_back();
        for (int dy = -1; dy <= 1; ++dy) {
          for (int dx = -1; dx <= 1; ++dx) {
            if (by_corners || dx == 0 || dy == 0) push(px + dx, py + dy);
          }
        }
      }
    }
  }
  return areas;
}

int CountPixels(const BitImage& image) {
  int count = 0;
  for (int y = 0; y < image.height(); ++y) {
    for (int x = 0; x < image.width(); ++x) count += image.at(x, y);
  }
  return count;
}

// Counts edges between pixels of different values.
std::size_t CountCracks(const BitImage& image) {
  std::size_t cracks = 0;
  for (int y = -1; y < image.height(); ++y) {
    for (int x = -1; x < image.width(); ++x) {
      cracks += image.at(x, y) != image.at(x + 1, y);
      cracks += image.at(x, y) != image.at(x, y + 1);
    }
  }
  return cracks;
}

TEST(BorderTracer, DiscHasOneBorder) {
  const BinaryImage binary = DrawFigure(
      90, 60, [](int x, int y) { return InDisc(x, y, 62, 30, 20.3); });  // across two words
  const BorderTracer tracer = TraceAll(binary);
  ASSERT_EQ(tracer.borders().size(), 1u);
  const Border& border = tracer.borders()[0];
  EXPECT_EQ(border.signed_area, CountPixels(binary.dark));
  EXPECT_EQ(border.min.x, 42);
  EXPECT_EQ(border.min.y, 10);
  EXPECT_EQ(border.max.x, 83);
  EXPECT_EQ(border.max.y, 51);
}

TEST(BorderTracer, WalksInUnitStepsWithDarkOnRight) {
  const BinaryImage binary = DrawFigure(
      40, 40, [](int x, int y) { return InDisc(x, y, 20, 20, 14) && !InDisc(x, y, 22, 19, 6); });
  const BorderTracer tracer = TraceAll(binary);
  ASSERT_EQ(tracer.borders().size(), 2u);
  for (const Border& border : tracer.borders()) {
    const GridPoint* points = tracer.begin(border);
    for (std::size_t i = 0; i < border.count; ++i) {
      const GridPoint& a = points[i];
      const GridPoint& b = points[(i + 1) % border.count];
      const int dx = b.x - a.x, dy = b.y - a.y;
      ASSERT_EQ(std::abs(dx) + std::abs(dy), 1);
      // The two pixels at the step: dark on its right, not dark on its left.
      const int middle_x = a.x + b.x, middle_y = a.y + b.y;  // twice the middle of the step
      const auto pixel = [](int doubled) { return static_cast<int>(std::floor(doubled / 2.0)); };
      ASSERT_TRUE(binary.dark.at(pixel(middle_x - dy), pixel(middle_y + dx)));
      ASSERT_FALSE(binary.dark.at(pixel(middle_x + dy), pixel(middle_y - dx)));
    }
  }
}

TEST(BorderTracer, BorderBeginsAtUppermostEdge) {
  const BinaryImage binary = DrawFigure(
      40, 40, [](int x, int y) { return InDisc(x, y, 20, 20, 14) && !InDisc(x, y, 20, 20, 6); });
  const BorderTracer tracer = TraceAll(binary);
  ASSERT_EQ(tracer.borders().size(), 2u);
  // Borders start at the topmost pixel of the disc, and at the topmost, leftmost pixel below the
  // hole.
  const auto begins_at = [&](std::size_t border, int x, int y) {
    const GridPoint* points = tracer.begin(tracer.borders()[border]);
    return points[0].x == x && points[0].y == y && points[1].x == x + 1 && points[1].y == y;
  };
  EXPECT_TRUE(begins_at(0, 20, 6));
  EXPECT_TRUE(begins_at(1, 14, 21));
}

TEST(BorderTracer, RingHasOuterAndInnerBorder) {
  const auto in_hole = [](int x, int y) { return InDisc(x, y, 41, 39, 15); };
  const BinaryImage binary =
      DrawFigure(80, 80, [&](int x, int y) { return InDisc(x, y, 40, 40, 30) && !in_hole(x, y); });
  const BinaryImage hole = DrawFigure(80, 80, in_hole);
  const BorderTracer tracer = TraceAll(binary);
  ASSERT_EQ(tracer.borders().size(), 2u);
  EXPECT_EQ(tracer.borders()[0].signed_area, CountPixels(binary.dark) + CountPixels(hole.dark));
  EXPECT_EQ(tracer.borders()[1].signed_area, -CountPixels(hole.dark));
}

TEST(BorderTracer, DarkAreasConnectDiagonallyButHolesDoNot) {
  // Two squares that share a corner.
  const BinaryImage squares = DrawFigure(20, 20, [](int x, int y) {
    return (x >= 4 && x < 8 && y >= 4 && y < 8) || (x >= 8 && x < 12 && y >= 8 && y < 12);
  });
  const BorderTracer touching = TraceAll(squares);
  ASSERT_EQ(touching.borders().size(), 1u);
  EXPECT_EQ(touching.borders()[0].signed_area, 32);
  // A diamond closed by corners only: its inside is a hole.
  const BinaryImage diamond =
      DrawFigure(20, 20, [](int x, int y) { return std::abs(x - 10) + std::abs(y - 10) == 4; });
  const BorderTracer closed = TraceAll(diamond);
  ASSERT_EQ(closed.borders().size(), 2u);
  EXPECT_LT(closed.borders()[1].signed_area, 0);
}

TEST(BorderTracer, FindsEveryBorderOfRandomImagesOnce) {
  Random random(1);
  for (int trial = 0; trial < 200; ++trial) {
    const int width = random.Integer(5, 200);
    const int height = random.Integer(5, 50);
    const double share = random.Uniform(0.05, 0.95);
    // The first two columns and rows are clear, so the bright mask allows every start.
    const BinaryImage binary = DrawFigure(width, height, [&](int x, int y) {
      const bool dark = random.Chance(share);
      return dark && x >= 2 && y >= 2 && x < width - 2;
    });
    BorderTracer tracer;
    tracer.Reserve(1000, 1000);  // more borders than an image of this size is given room for
    tracer.Trace(binary, cv::Rect(0, 0, width, height), kNoLimits);
    int outer = 0, holes = 0, area = 0;
    std::size_t points = 0;
    for (const Border& border : tracer.borders()) {
      ++(border.signed_area > 0 ? outer : holes);
      area += border.signed_area;
      points += border.count;
    }
    ASSERT_EQ(outer, CountAreas(binary.dark, true, /*by_corners=*/true));
    ASSERT_EQ(holes, CountAreas(binary.dark, false, /*by_corners=*/false) - 1);
    ASSERT_EQ(area, CountPixels(binary.dark));
    ASSERT_EQ(points, CountCracks(binary.dark));
  }
}

TEST(BorderTracer, KeepsBordersWithinLimits) {
  // Squares of 3, 6 and 20 pixels, and a bar of 12 x 2.
  const BinaryImage binary = DrawFigure(64, 64, [](int x, int y) {
    const auto in = [&](int x0, int y0, int w, int h) {
      return x >= x0 && x < x0 + w && y >= y0 && y < y0 + h;
    };
    return in(4, 4, 3, 3) || in(12, 4, 6, 6) || in(30, 20, 20, 20) || in(4, 50, 12, 2);
  });
  const auto areas = [&](const BorderLimits& limits) {
    std::multiset<int> all;
    const BorderTracer tracer = TraceAll(binary, limits);
    for (const Border& border : tracer.borders()) all.insert(border.signed_area);
    return all;
  };
  EXPECT_EQ(areas({0, 0, 100}), (std::multiset<int>{9, 24, 36, 400}));
  EXPECT_EQ(areas({13, 0, 100}), (std::multiset<int>{24, 36, 400}));
  EXPECT_EQ(areas({0, 3, 100}), (std::multiset<int>{9, 36, 400}));
  EXPECT_EQ(areas({0, 4, 100}), (std::multiset<int>{36, 400}));
  EXPECT_EQ(areas({0, 0, 19}), (std::multiset<int>{9, 24, 36}));
  EXPECT_EQ(areas({0, 0, 20}), (std::multiset<int>{9, 24, 36, 400}));
}

TEST(BorderTracer, DoesNotRetraceAbandonedBorder) {
  // A comb that is larger than allowed. Each of its teeth offers a start.
  const BinaryImage binary = DrawFigure(200, 40, [](int x, int y) {
    return x >= 4 && x < 196 && y >= (x % 8 < 4 ? 10 : 20) && y < 30;
  });
  EXPECT_TRUE(TraceAll(binary, {0, 0, 100}).borders().empty());
  EXPECT_EQ(TraceAll(binary, {0, 0, 200}).borders().size(), 1u);
}

TEST(BorderTracer, StartsOnlyBelowBright) {
  BinaryImage binary = DrawFigure(40, 40, [](int x, int y) { return InDisc(x, y, 20, 20, 10); });
  binary.bright.Reset(40, 40);
  EXPECT_TRUE(TraceAll(binary).borders().empty());
  // Three bright pixels two above an upper edge suffice; two do not.
  binary.bright.Set(19, 8);
  binary.bright.Set(20, 8);
  EXPECT_TRUE(TraceAll(binary).borders().empty());
  binary.bright.Set(21, 8);
  EXPECT_EQ(TraceAll(binary).borders().size(), 1u);
}

TEST(BorderTracer, StartsBelowNarrowBrightStrokeOnRequest) {
  BinaryImage binary = DrawFigure(40, 40, [](int x, int y) { return InDisc(x, y, 20, 20, 10); });
  binary.bright.Reset(40, 40);
  BorderLimits limits = kNoLimits;
  limits.narrow = true;
  EXPECT_TRUE(TraceAll(binary, limits).borders().empty());
  binary.bright.Set(20, 8);
  EXPECT_TRUE(TraceAll(binary, limits).borders().empty());
  binary.bright.Set(21, 8);
  EXPECT_TRUE(TraceAll(binary).borders().empty());
  EXPECT_EQ(TraceAll(binary, limits).borders().size(), 1u);
}

TEST(BorderTracer, DropsBordersBeyondCapacity) {
  // Single pixels, many more than fit.
  const BinaryImage binary =
      DrawFigure(400, 400, [](int x, int y) { return x % 2 == 0 && y % 2 == 0 && x > 1 && y > 1; });
  BorderTracer tracer;
  tracer.Reserve(400, 400);
  const std::size_t room = tracer.capacity();
  tracer.Trace(binary, cv::Rect(0, 0, 400, 400), kNoLimits);
  EXPECT_EQ(tracer.capacity(), room);
  EXPECT_GT(tracer.borders().size(), 1000u);
  EXPECT_LT(tracer.borders().size(), 40000u / 4);
  for (const Border& border : tracer.borders()) ASSERT_EQ(border.signed_area, 1);
}

TEST(BorderTracer, KeepsBordersWithStrongestContrast) {
  const auto in_disc = [](int disc, int x, int y) { return InDisc(x, y, 20 + 30 * disc, 20, 8); };
  // Three discs, the middle one the darkest; the right one has a bright hole, the strongest border.
  const auto in_hole = [](int x, int y) { return InDisc(x, y, 80, 20, 4); };
  cv::Mat image(40, 100, CV_8UC1, cv::Scalar(100));
  const BinaryImage binary = DrawFigure(100, 40, [&](int x, int y) {
    for (int disc = 0; disc < 3; ++disc) {
      if (!in_disc(disc, x, y)) continue;
      image.at<std::uint8_t>(y, x) = static_cast<std::uint8_t>(disc == 1 ? 40 : 80);
      if (disc < 2 || !in_hole(x, y)) return true;
      image.at<std::uint8_t>(y, x) = 180;
    }
    return false;
  });
  BorderTracer tracer = TraceAll(binary);
  ASSERT_EQ(tracer.borders().size(), 4u);
  tracer.KeepStrongest(image, 4);
  EXPECT_EQ(tracer.borders().size(), 4u);
  tracer.KeepStrongest(image, 2);
  ASSERT_EQ(tracer.borders().size(), 2u);
  EXPECT_LT(tracer.borders()[0].signed_area, 0);
  EXPECT_GT(tracer.borders()[1].signed_area, 0);
  EXPECT_EQ(tracer.borders()[1].min.x, 42);
}

TEST(BorderTracer, ForgetsPreviousImage) {
  const BinaryImage disc =
      DrawFigure(70, 70, [](int x, int y) { return InDisc(x, y, 30, 30, 20); });
  const BinaryImage empty = DrawFigure(70, 70, [](int, int) { return false; });
  BorderTracer tracer;
  const cv::Rect all(0, 0, 70, 70);
  tracer.Trace(disc, all, kNoLimits);
  tracer.Trace(disc, all, kNoLimits);
  EXPECT_EQ(tracer.borders().size(), 1u);
  tracer.Trace(empty, all, kNoLimits);
  EXPECT_TRUE(tracer.borders().empty());
}

}  // namespace
}  // namespace kestrel
