// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/landing/score/ink_in_highlights.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <vector>

#include <gtest/gtest.h>

namespace kestrel {
namespace {

constexpr int kRows = 11;
constexpr StrokeInk kInk{30, 75, 2};
const std::vector<float> kHighlight(kRows, 250);

// Ink with a highlight around 'middle' (rows) on it, 'light' in its middle.
std::vector<float> Lit(double middle, double sigma, double light) {
  std::vector<float> stroke;
  for (int row = -1; row <= kRows; ++row) {
    const double distance = (row - middle) / sigma;
    const double gray = kInk.ink + light * std::exp(-0.5 * distance * distance);
    stroke.push_back(static_cast<float>(std::min(255.0, gray)));
  }
  return stroke;
}

TEST(InkInHighlightsTest, HighlightHidesInkThatItSaturates) {
  for (const double sigma : {2.1, 3.0, 6.0}) {
    const auto hidden = InkInHighlights(Lit(5, sigma, 500), kHighlight, kInk);
    EXPECT_TRUE(hidden[5]) << sigma;
  }
}

TEST(InkInHighlightsTest, WhiteBetweenSharpEdgesIsNotHidden) {
  std::vector<float> stroke(kRows + 2, kInk.ink);
  for (int row = 4; row < 8; ++row) stroke[row + 1] = 255;
  EXPECT_TRUE(InkInHighlights(stroke, kHighlight, kInk).none());
}

TEST(InkInHighlightsTest, WhiteBesideEvenlyVeiledInkIsNotHidden) {
  std::vector<float> stroke(kRows + 2, kInk.ink + 80);
  for (int row = 4; row < kRows; ++row) stroke[row + 1] = 255;
  EXPECT_TRUE(InkInHighlights(stroke, kHighlight, kInk).none());
}

TEST(InkInHighlightsTest, EdgeThatBlurSpreadsOverRowsHidesNothing) {
  std::vector<float> stroke(kRows + 2, 255);
  const float fading[] = {30, 30, 48, 108, 204};
  std::copy(std::begin(fading), std::end(fading), stroke.begin());
  const StrokeInk coarse{kInk.ink, kInk.veiled, StrokeEdgeRows(0.8f, kRows)};
  EXPECT_TRUE(InkInHighlights(stroke, kHighlight, coarse).none());
}

TEST(InkInHighlightsTest, InkOutOfViewIsNoWitness) {
  const std::vector<float> stroke(kRows + 2, 255);
  std::vector<float> cut_off = stroke;
  cut_off.front() = cut_off.back() = kUnknownGray;
  EXPECT_EQ(InkInHighlights(cut_off, kHighlight, kInk).count(), kRows);
}

TEST(InkInHighlightsTest, EdgeTakesMoreRowsInCoarseImages) {
  EXPECT_EQ(StrokeEdgeRows(5, kRows), 2);
  EXPECT_EQ(StrokeEdgeRows(0.8f, kRows), 3);
  EXPECT_EQ(StrokeEdgeRows(0.1f, kRows), kRows);
  EXPECT_EQ(StrokeEdgeRows(std::nanf(""), kRows), kRows);
}

}  // namespace
}  // namespace kestrel
