// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/core/image/thinning.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "kestrel/core/base/random.h"

namespace kestrel {
namespace {

// The method of the reference in the header, pixel by pixel.
bool IsDeletable(const SmallMask& mask, int x, int y, bool odd) {
  const bool p2 = mask.at(x, y - 1), p3 = mask.at(x + 1, y - 1), p4 = mask.at(x + 1, y);
  const bool p5 = mask.at(x + 1, y + 1), p6 = mask.at(x, y + 1), p7 = mask.at(x - 1, y + 1);
  const bool p8 = mask.at(x - 1, y), p9 = mask.at(x - 1, y - 1);
  const int components =
      (!p2 && (p3 || p4)) + (!p4 && (p5 || p6)) + (!p6 && (p7 || p8)) + (!p8 && (p9 || p2));
  const int n1 = (p9 || p2) + (p3 || p4) + (p5 || p6) + (p7 || p8);
  const int n2 = (p2 || p3) + (p4 || p5) + (p6 || p7) + (p8 || p9);
  const int neighbours = std::min(n1, n2);
  const bool kept = odd ? (p2 || p3 || !p5) && p4 : (p6 || p7 || !p9) && p8;
  return components == 1 && neighbours >= 2 && neighbours <= 3 && !kept;
}

void ThinReference(SmallMask* mask, int max_iterations) {
  for (int i = 0; i < 2 * max_iterations; ++i) {
    const SmallMask before = *mask;
    for (int y = 0; y < mask->size(); ++y) {
      for (int x = 0; x < mask->size(); ++x) {
        if (before.at(x, y) && IsDeletable(before, x, y, i % 2 == 0)) mask->Clear(x, y);
      }
    }
  }
}

bool Same(const SmallMask& a, const SmallMask& b) {
  for (int y = 0; y < a.size(); ++y) {
    if (a.row(y) != b.row(y)) return false;
  }
  return true;
}

// Counts areas connected by edges or corners.
int CountAreas(SmallMask mask) {
  int areas = 0;
  std::vector<std::pair<int, int>> stack;
  const auto push = [&](int x, int y) {
    if (!mask.at(x, y)) return;
    mask.Clear(x, y);
    stack.emplace_back(x, y);
  };
  for (int y = 0; y < mask.size(); ++y) {
    for (int x = 0; x < mask.size(); ++x) {
      push(x, y);
      areas += !stack.empty();
      while (!stack.empty()) {
        const auto [px, py] = stack.back();
        stack.pop_back();
        for (int d = 0; d < 9; ++d) push(px + d % 3 - 1, py + d / 3 - 1);
      }
    }
  }
  return areas;
}

SmallMask DrawCross(int size, double half_width, double angle) {
  SmallMask mask(size);
  const double middle = 0.5 * (size - 1);
  for (int y = 0; y < size; ++y) {
    for (int x = 0; x < size; ++x) {
      const double u = std::cos(angle) * (x - middle) + std::sin(angle) * (y - middle);
      const double v = std::cos(angle) * (y - middle) - std::sin(angle) * (x - middle);
      if (std::hypot(u, v) > 0.45 * size) continue;
      if (std::min(std::abs(u), std::abs(v)) < half_width) mask.Set(x, y);
    }
  }
  return mask;
}

TEST(ThinGuoHall, AgreesWithTheMethodPixelByPixel) {
  Random random(1);
  for (int trial = 0; trial < 200; ++trial) {
    SmallMask mask(random.Integer(1, SmallMask::kMaxSize));
    const double share = random.Uniform(0.2, 0.95);
    const int grain = random.Integer(1, 4);  // size of the spots
    std::vector<char> spots(64 * 64);
    for (char& spot : spots) spot = random.Chance(share);
    for (int y = 0; y < mask.size(); ++y) {
      for (int x = 0; x < mask.size(); ++x) {
        if (spots[y / grain * 64 + x / grain]) mask.Set(x, y);
      }
    }
    for (const int iterations : {0, 1, 2, 20}) {
      SmallMask thinned = mask, expected = mask;
      ThinGuoHall(&thinned, iterations);
      ThinReference(&expected, iterations);
      ASSERT_TRUE(Same(thinned, expected)) << "size " << mask.size() << ", " << iterations;
    }
  }
}

TEST(ThinGuoHall, LeavesThinConnectedLines) {
  for (const double angle : {0.0, 0.2, 0.5, 0.785, 1.2}) {
    SmallMask mask = DrawCross(64, 5, angle);
    ThinGuoHall(&mask, 20);
    EXPECT_EQ(CountAreas(mask), 1) << angle;
    int blocks = 0, pixels = 0;
    for (int y = 0; y < 64; ++y) {
      for (int x = 0; x < 64; ++x) {
        pixels += mask.at(x, y);
        blocks += mask.at(x, y) && mask.at(x + 1, y) && mask.at(x, y + 1) && mask.at(x + 1, y + 1);
      }
    }
    EXPECT_LE(blocks, 1) << "lines of one pixel, but perhaps where they meet: " << angle;
    EXPECT_GT(pixels, 70) << "two lines of most of the cross's length: " << angle;
  }
}

TEST(ThinGuoHall, StopsWhenNothingChanges) {
  SmallMask mask = DrawCross(40, 3, 0.4);
  ThinGuoHall(&mask, 20);
  SmallMask again = mask;
  ThinGuoHall(&again, 1000000000);
  EXPECT_TRUE(Same(mask, again));
}

}  // namespace
}  // namespace kestrel
