// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/objects/color/color_model.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kestrel/core/base/error.h"
#include "kestrel/core/base/random.h"
#include "kestrel/vision/objects/object_model.h"

namespace kestrel {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

ColorMixture MixtureAt(const std::string& name, float hue_deg) {
  return {name, {{1, {hue_deg, 0.8F, 0.7F}, {8, 0.1F, 0.15F}}}};
}

TEST(Hsv, HueWrapsAroundCircle) {
  EXPECT_FLOAT_EQ(HsvFromBgr(0, 0, 200).hue_deg, 0);
  EXPECT_FLOAT_EQ(HsvFromBgr(200, 0, 0).hue_deg, 240);
  EXPECT_FLOAT_EQ(HsvFromBgr(50, 0, 200).hue_deg, 345);
  EXPECT_FLOAT_EQ(HueDifference(5, 355), 10);
  EXPECT_FLOAT_EQ(HueDifference(355, 5), -10);
}

TEST(ColorModel, ClassifiesNearestColourAndBackground) {
  ColorModel model;
  model.colors = {MixtureAt("red", 0), MixtureAt("green", 120)};
  EXPECT_EQ(model.Classify({355, 0.8F, 0.7F}), 0U);
  EXPECT_EQ(model.Classify({110, 0.75F, 0.6F}), 1U);
  EXPECT_FALSE(model.Classify({60, 0.8F, 0.7F}));
  EXPECT_FALSE(model.Classify({0, 0.1F, 0.7F})) << "gray";
}

TEST(ColorModel, ReportsContradictions) {
  ColorModel model;
  EXPECT_THAT(model.Validate(), Contains(HasSubstr("at least one color")));
  model.colors = {MixtureAt("red", 0), MixtureAt("crimson", 0)};
  model.colors[1].components[0].weight = 2;
  EXPECT_THAT(model.Validate(), Contains(HasSubstr("red and crimson contradict each other")));
  model.colors = {MixtureAt("red", 0), MixtureAt("red", 90)};
  EXPECT_THAT(model.Validate(), Contains(HasSubstr("given twice")));
  model.colors = {MixtureAt("red", 0)};
  model.colors[0].components[0].sigma.value = 0;
  EXPECT_THAT(model.Validate(), Contains(HasSubstr("sigmas must be positive")));
}

TEST(FitColorMixture, FindsMeanAndDeviationAcrossHueWrap) {
  Random random(1);
  std::vector<Hsv> samples;
  for (int i = 0; i < 2000; ++i) {
    const auto hue = static_cast<float>(random.Normal() * 8 + 358);
    samples.push_back({std::fmod(hue + 360, 360.0F),
                       0.7F + 0.05F * static_cast<float>(random.Normal()),
                       0.6F + 0.1F * static_cast<float>(random.Normal())});
  }
  const ColorMixture mixture = FitColorMixture("red", samples, 1);
  ASSERT_EQ(mixture.components.size(), 1U);
  EXPECT_NEAR(HueDifference(mixture.components[0].mean.hue_deg, 358), 0, 1);
  EXPECT_NEAR(mixture.components[0].sigma.hue_deg, 8, 1);
  EXPECT_NEAR(mixture.components[0].sigma.value, 0.1, 0.01);
}

TEST(FitColorMixture, SeparatesSunFromShade) {
  Random random(2);
  std::vector<Hsv> samples;
  for (int i = 0; i < 1000; ++i) {
    const float value = i % 2 == 0 ? 0.9F : 0.3F;
    samples.push_back({100, 0.6F, value + 0.03F * static_cast<float>(random.Normal())});
  }
  const ColorMixture mixture = FitColorMixture("green", samples, 2);
  ASSERT_EQ(mixture.components.size(), 2U);
  EXPECT_LT(mixture.Mahalanobis({100, 0.6F, 0.3F}), 1);
  EXPECT_LT(mixture.Mahalanobis({100, 0.6F, 0.9F}), 1);
  EXPECT_GT(mixture.Mahalanobis({100, 0.6F, 0.6F}), 3);
}

// Paint that fades in the sun changes its hue as it loses saturation.
std::vector<Hsv> FadingRed(int count) {
  Random random(5);
  std::vector<Hsv> samples;
  for (int i = 0; i < count; ++i) {
    const auto fading = static_cast<float>(random.Normal());
    const auto noise = static_cast<float>(random.Normal());
    samples.push_back({std::fmod(360 + 16 * fading, 360.0F), 0.6F + 0.1F * fading + 0.01F * noise,
                       0.6F + 0.1F * static_cast<float>(random.Normal())});
  }
  return samples;
}

TEST(FitColorMixture, FitsJointHueSaturationGaussianAcrossHueWrap) {
  const ColorMixture mixture = FitColorMixture("red", FadingRed(3000), 1);
  const ColorComponent& component = mixture.components.front();
  EXPECT_NEAR(component.sigma.hue_deg, 16, 1.5);
  EXPECT_NEAR(component.sigma.saturation, 0.1, 0.02);
  EXPECT_GT(component.correlation, 0.8);
  EXPECT_LT(mixture.Mahalanobis({16, 0.7F, 0.6F}), 2) << "along the fading";
  EXPECT_LT(mixture.Mahalanobis({344, 0.5F, 0.6F}), 2) << "the other way, around the circle";
  EXPECT_GT(mixture.Mahalanobis({16, 0.5F, 0.6F}), 3) << "across it";
}

TEST(FitColorMixture, LimitsDeviationToNoise) {
  const std::vector<Hsv> samples(100, {120, 0.5F, 0.5F});
  const ColorComponent component = FitColorMixture("green", samples, 1).components.front();
  EXPECT_FLOAT_EQ(component.sigma.hue_deg, 4);
  EXPECT_FLOAT_EQ(component.sigma.saturation, 0.04F);
  EXPECT_FLOAT_EQ(component.sigma.value, 0.05F);
  EXPECT_NEAR(component.correlation, 0, 1e-9);
}

TEST(FitColorMixture, SeparatesTwoHues) {
  std::vector<Hsv> samples;
  for (int i = 0; i < 400; ++i) samples.push_back({i % 2 == 0 ? 345.0F : 25.0F, 0.7F, 0.6F});
  const ColorMixture mixture = FitColorMixture("two", samples, 2);
  ASSERT_EQ(mixture.components.size(), 2U);
  EXPECT_LT(mixture.Mahalanobis({345, 0.7F, 0.6F}), 1);
  EXPECT_LT(mixture.Mahalanobis({25, 0.7F, 0.6F}), 1);
  EXPECT_GT(mixture.Mahalanobis({5, 0.7F, 0.6F}), 3);
}

TEST(ColorComponent, CorrelationTiltsEllipseAndKeepsVolume) {
  const ColorComponent straight{1, {0, 0.5F, 0.5F}, {10, 0.1F, 0.1F}, 0};
  const ColorComponent tilted{1, {0, 0.5F, 0.5F}, {10, 0.1F, 0.1F}, 0.8};
  EXPECT_NEAR(straight.Mahalanobis({10, 0.6F, 0.5F}), std::sqrt(2.0), 1e-4);
  EXPECT_NEAR(tilted.Mahalanobis({10, 0.6F, 0.5F}), std::sqrt(0.4 / 0.36), 1e-4);
  EXPECT_NEAR(tilted.LogDensity(tilted.mean) - straight.LogDensity(straight.mean),
              -std::log(std::sqrt(1 - 0.64)), 1e-9);
}

TEST(FitColorMixture, RefusesTooFewPixels) {
  const std::vector<Hsv> samples(3);
  EXPECT_THROW(FitColorMixture("red", samples, 1), InputError);
}

TEST(ObjectModel, DefaultIsValidAndHasItsColours) {
  const ObjectModel model = DefaultObjectModel();
  EXPECT_THAT(model.Validate(), IsEmpty());
  const auto name = [&](const Hsv& color) {
    const auto index = model.colors.Classify(color);
    return index ? model.colors.colors[*index].name : "";
  };
  EXPECT_EQ(name({2, 0.75F, 0.8F}), "red");
  EXPECT_EQ(name({355, 0.8F, 0.3F}), "red") << "in the shade";
  EXPECT_EQ(name({100, 0.65F, 0.7F}), "green");
  EXPECT_EQ(name({208, 0.95F, 0.5F}), "blue");
  EXPECT_EQ(name({60, 0.4F, 1}), "yellow") << "over-exposed";
  EXPECT_EQ(name({24, 0.9F, 0.95F}), "orange");
  EXPECT_EQ(name({32, 0.3F, 0.5F}), "") << "sand";
  EXPECT_EQ(name({210, 0.25F, 0.2F}), "") << "shadow on asphalt";
  EXPECT_EQ(name({0, 0, 0.95F}), "") << "white";
}

}  // namespace
}  // namespace kestrel
