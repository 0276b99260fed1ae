// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/search/ink_samples.h"

#include <algorithm>
#include <vector>

#include <gtest/gtest.h>

namespace kestrel {
namespace {

constexpr int kRows = 12;
constexpr double kArea = 20;  // px^2 for each sample
enum Part : std::size_t { kStripe, kGround };

// A white stripe along y with black ground on both sides.
InkSamples Stripe() {
  InkSamples samples(true);
  for (int i = 0; i < kRows; ++i) {
    samples.Add({0, 0.1 * i}, kStripe, true);
    for (const double x : {-0.1, 0.1}) samples.Add({x, 0.1 * i}, kGround, false);
  }
  samples.Connect(0, 0.15);
  return samples;
}

// Its gray values in light that 'light' gives by place.
template <class Light>
std::vector<float> GraysOf(const InkSamples& samples, const Light& light) {
  std::vector<float> gray;
  for (const Eigen::Vector2d& place : samples.places()) {
    gray.push_back(static_cast<float>((place.x() == 0 ? 200 : 40) * light(place)));
  }
  return gray;
}

double Even(const Eigen::Vector2d& /*place*/) { return 1; }
// The edge of a shadow across the stripe.
double Shaded(const Eigen::Vector2d& place) { return place.y() < 0.55 ? 1 : 0.5; }

TEST(InkSamples, FindPadLikelyInEvenLightAndAtShadowEdge) {
  const InkSamples stripe = Stripe();
  for (const auto light : {Even, Shaded}) {
    const std::vector<float> gray = GraysOf(stripe, light);
    EXPECT_GT(stripe.LikenessOf(gray), 0.9);
    const InkAgreement agreement = stripe.Compare(gray, kArea, DimSample::kWrong);
    EXPECT_GT(agreement.evidence, 20);
    EXPECT_EQ(agreement.worst_share, 1);
    EXPECT_EQ(agreement.parts, 2);
  }
}

// A highlight adds the same to ink and ground, up to what a pixel can hold.
TEST(InkSamples, FindEachPartUnderGlare) {
  const InkSamples stripe = Stripe();
  for (const float veil : {50.F, 120.F}) {
    std::vector<float> gray = GraysOf(stripe, Even);
    for (std::size_t i = 0; i < gray.size() / 2; ++i) gray[i] = std::min(255.F, gray[i] + veil);
    const InkAgreement agreement = stripe.Compare(gray, kArea, DimSample::kWrong);
    EXPECT_GT(agreement.evidence, 20) << veil;
    EXPECT_EQ(agreement.worst_share, 1) << veil;
  }
}

// A board without the stripe is as bright as a highlight.
TEST(InkSamples, OverexposedGroundIsNoInk) {
  const InkSamples stripe = Stripe();
  std::vector<float> gray = GraysOf(stripe, Even);
  for (std::size_t i = 0; i < gray.size() / 3; ++i) gray[i] = 255;
  EXPECT_LT(stripe.Compare(gray, kArea, DimSample::kWrong).worst_share, 0.8);
}

TEST(InkSamples, DetectExchangedColours) {
  const InkSamples stripe = Stripe();
  std::vector<float> gray = GraysOf(stripe, Even);
  for (float& value : gray) value = 240 - value;
  EXPECT_LT(stripe.LikenessOf(gray), -0.9);
  EXPECT_EQ(stripe.Compare(gray, kArea, DimSample::kWrong).evidence, 0);
}

TEST(InkSamples, CountFewerIndependentSamplesWithinBlur) {
  const InkSamples stripe = Stripe();
  const std::vector<float> gray = GraysOf(stripe, Shaded);
  EXPECT_LT(stripe.Compare(gray, 1, DimSample::kWrong).evidence,
            0.3 * stripe.Compare(gray, kArea, DimSample::kWrong).evidence);
}

TEST(InkSamples, FindWorstPart) {
  const InkSamples stripe = Stripe();
  std::vector<float> gray = GraysOf(stripe, Even);
  for (int i = 0; i < 3; ++i) gray[3 * i] = 40;  // a quarter of the stripe is missing
  EXPECT_EQ(stripe.Compare(gray, kArea, DimSample::kUnknown).worst_share, 0.75);
}

TEST(InkSamples, MayBeDimOnFollowedPad) {
  const InkSamples stripe = Stripe();
  std::vector<float> gray = GraysOf(stripe, Even);
  for (int i = 0; i < 3; ++i) gray[3 * i] = 70;  // ink in a narrow shadow
  EXPECT_EQ(stripe.Compare(gray, kArea, DimSample::kWrong).worst_share, 0.75);
  EXPECT_EQ(stripe.Compare(gray, kArea, DimSample::kUnknown).worst_share, 1);
}

TEST(InkSamples, IgnoreSamplesOutOfView) {
  const InkSamples stripe = Stripe();
  std::vector<float> gray = GraysOf(stripe, Even);
  for (std::size_t i = gray.size() / 2; i < gray.size(); ++i) gray[i] = -1;
  EXPECT_GT(stripe.LikenessOf(gray), 0.9);
  EXPECT_EQ(stripe.Compare(gray, kArea, DimSample::kWrong).parts, 2);
  EXPECT_LT(stripe.LikenessOf(std::vector<float>(gray.size(), -1)), 0);
}

}  // namespace
}  // namespace kestrel
