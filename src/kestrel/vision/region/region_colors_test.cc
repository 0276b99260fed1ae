// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/region/region_colors.h"

#include <cmath>

#include <gtest/gtest.h>

#include "kestrel/core/base/random.h"

namespace kestrel {
namespace {

constexpr int kSide = 128;

// Ground, and a rectangle on it, with noise.
SampledWindow Draw(int planes, const RegionColors::Box& thing, float contrast) {
  Random random(1);
  SampledWindow window(kSide, planes);
  for (int y = 0; y < kSide; ++y) {
    for (int x = 0; x < kSide; ++x) {
      const bool is_thing = std::abs(x - thing.middle.x()) < 0.5 * thing.size.x() &&
                            std::abs(y - thing.middle.y()) < 0.5 * thing.size.y();
      for (int plane = 0; plane < planes; ++plane) {
        const double value = 90 + (is_thing ? contrast : 0) + 5 * random.Normal();
        window.values[plane][y * kSide + x] = static_cast<float>(value);
      }
    }
  }
  return window;
}

class RegionColorsPlanes : public testing::TestWithParam<int> {
 protected:
  RegionColors colors{kSide};
};
INSTANTIATE_TEST_SUITE_P(Planes, RegionColorsPlanes, testing::Values(1, 3));

TEST_P(RegionColorsPlanes, FitReturnsFormThatHasChanged) {
  const RegionColors::Box marked{{64, 64}, {24, 30}}, turned{{66, 63}, {38, 22}};
  colors.Mark(Draw(GetParam(), marked, 70), marked);
  const auto fit = colors.Fit(Draw(GetParam(), turned, 70), marked);
  ASSERT_TRUE(fit);
  EXPECT_LT((fit->middle - turned.middle).norm(), 1);
  EXPECT_LT((fit->size - turned.size).norm(), 2);
}

TEST_P(RegionColorsPlanes, FitReturnsNothingWhereColorsAreThoseAround) {
  const RegionColors::Box marked{{64, 64}, {24, 30}};
  const SampledWindow window = Draw(GetParam(), marked, 0);
  colors.Mark(window, marked);
  EXPECT_FALSE(colors.Fit(window, marked));
}

// A neighbour of the same colour that reaches beyond the window's part in which the region may end.
TEST_P(RegionColorsPlanes, FitReturnsNothingWhereColorsDoNotEnd) {
  const RegionColors::Box marked{{64, 64}, {24, 30}};
  colors.Mark(Draw(GetParam(), marked, 70), marked);
  EXPECT_FALSE(colors.Fit(Draw(GetParam(), {{64, 64}, {100, 30}}, 70), marked));
}

TEST_P(RegionColorsPlanes, AgreementIsLowBesideRegion) {
  const RegionColors::Box marked{{64, 64}, {24, 30}};
  const SampledWindow window = Draw(GetParam(), marked, 70);
  colors.Mark(window, marked);
  EXPECT_NEAR(colors.AgreementOf(window, marked), 1, 0.01);
  EXPECT_LT(colors.AgreementOf(window, {{30, 64}, {24, 30}}), 0.2);
}

TEST_P(RegionColorsPlanes, AgreementIsAHalfOnUnknownColors) {
  const RegionColors::Box marked{{64, 64}, {24, 30}};
  colors.Mark(Draw(GetParam(), marked, 70), marked);
  EXPECT_NEAR(colors.AgreementOf(Draw(GetParam(), marked, 140), marked), 0.5, 0.1);
}

const RegionColors::Box kThing{{64, 64}, {24, 30}};

// The thing is purple where 'green', the share of its green channel, is less than 1.
SampledWindow DrawThing(float green) {
  SampledWindow window = Draw(3, kThing, 70);
  for (int y = 49; y < 79; ++y) {
    for (int x = 52; x < 76; ++x) window.values[1][y * kSide + x] *= green;
  }
  return window;
}

void Dim(float factor, SampledWindow* window) {
  for (auto& plane : window->values) {
    for (float& value : plane) value *= factor;
  }
}

struct Similarity {
  double agreement, match;
};

// Returns how similar the thing is to itself in a shadow of half the brightness.
Similarity SimilarityInShadow(float green) {
  SampledWindow window = DrawThing(green);
  RegionColors colors{kSide};
  colors.Mark(window, kThing);
  EXPECT_EQ(colors.HasHues(), green < 1);
  Dim(0.5f, &window);
  return {colors.AgreementOf(window, kThing), colors.MatchOf(window, kThing)};
}

// A gray rectangle in a shadow looks like the ground in the sun.
TEST(RegionColors, SimilarityInShadowIsHighForHueAndLowForGray) {
  const Similarity purple = SimilarityInShadow(0.4f), gray = SimilarityInShadow(1);
  EXPECT_GT(purple.agreement, 0.65);
  EXPECT_GT(purple.match, 0.65);
  EXPECT_LT(gray.agreement, 0.5);
  EXPECT_LT(gray.match, 0.5);
}

// A gray thing, as dark as the purple one, is in its place.
TEST(RegionColors, SimilarityIsZeroWhereHueIsMissing) {
  SampledWindow purple = DrawThing(0.3f), gray = DrawThing(1);
  Dim(0.15f, &purple);
  Dim(0.15f, &gray);
  RegionColors colors{kSide};
  colors.Mark(purple, kThing);
  EXPECT_NEAR(colors.MatchOf(purple, kThing), 1, 0.1);
  EXPECT_EQ(colors.AgreementOf(gray, kThing), 0);
  EXPECT_EQ(colors.MatchOf(gray, kThing), 0);
}

// The marked box holds a shadow, which is alone in the second image.
TEST_P(RegionColorsPlanes, OnlyMatchIsLowWhereOneColorOfRegionIsAlone) {
  const RegionColors::Box marked{{64, 64}, {30, 30}};
  SampledWindow window = Draw(GetParam(), marked, 70);
  const SampledWindow shadow = Draw(GetParam(), marked, -70);
  for (int plane = 0; plane < GetParam(); ++plane) {
    for (int y = 75; y < kSide; ++y) {
      for (int x = 0; x < kSide; ++x) {
        window.values[plane][y * kSide + x] = shadow.values[plane][y * kSide + x];
      }
    }
  }
  colors.Mark(window, marked);
  EXPECT_NEAR(colors.MatchOf(window, marked), 1, 0.1);
  EXPECT_GT(colors.AgreementOf(shadow, marked), 0.8);
  EXPECT_LT(colors.MatchOf(shadow, marked), 0.6);
}

TEST_P(RegionColorsPlanes, FindReturnsPlaceOfRegionsColors) {
  const RegionColors::Box marked{{64, 64}, {24, 30}}, moved{{30, 90}, {24, 30}};
  colors.Mark(Draw(GetParam(), marked, 70), marked);
  const RegionColors::Place found = colors.Find(Draw(GetParam(), moved, 70), marked.size);
  EXPECT_LT((found.box.middle - moved.middle).norm(), 2);
  EXPECT_GT(found.contrast, 0.5);
}

}  // namespace
}  // namespace kestrel
