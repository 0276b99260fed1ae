// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/objects/color/color_samples.h"

#include <cmath>
#include <numeric>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kestrel/core/base/error.h"
#include "kestrel/core/base/random.h"

namespace kestrel {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

void AddCloud(float hue_deg, float saturation, float value, int count, Random* random,
              std::vector<Hsv>* samples) {
  for (int i = 0; i < count; ++i) {
    const auto normal = [&] { return static_cast<float>(random->Normal()); };
    samples->push_back({std::fmod(hue_deg + 5 * normal() + 360, 360.0F),
                        saturation + 0.05F * normal(), value + 0.05F * normal()});
  }
}

TEST(HueSaturationHistogram, DoesNotSplitRedAtHueWrap) {
  Random random(1);
  std::vector<Hsv> samples;
  AddCloud(358, 0.8F, 0.6F, 1000, &random, &samples);
  HueSaturationHistogram histogram;
  for (const Hsv& sample : samples) histogram.Add(sample);
  EXPECT_NEAR(histogram.CutHue_deg(), 180, 15);
  EXPECT_EQ(std::accumulate(histogram.counts().begin(), histogram.counts().end(), 0U), 1000U);
  EXPECT_GT(histogram.At(0, 20), 0U);
  EXPECT_GT(histogram.At(HueSaturationHistogram::kHues - 1, 20), 0U);
}

TEST(HueSaturationHistogram, AcceptsEndsOfRanges) {
  HueSaturationHistogram histogram;
  EXPECT_EQ(histogram.CutHue_deg(), 0);
  histogram.Add({0, 0, 0});
  histogram.Add({360, 1, 1});
  EXPECT_EQ(histogram.At(0, 0), 1U);
  EXPECT_EQ(histogram.At(HueSaturationHistogram::kHues - 1, 24), 1U);
}

TEST(SampleWarnings, AdviseWhatToDo) {
  Random random(2);
  std::vector<Hsv> samples;
  AddCloud(120, 0.7F, 0.6F, 500, &random, &samples);
  EXPECT_THAT(SampleWarnings(samples), IsEmpty());
  AddCloud(120, 0.05F, 0.6F, 200, &random, &samples);
  EXPECT_THAT(SampleWarnings(samples), ElementsAre(HasSubstr("nearly gray")));
  samples.assign(50, {10, 0.8F, 1});
  EXPECT_THAT(SampleWarnings(samples),
              ElementsAre(HasSubstr("only 50 pixels"), HasSubstr("expose shorter")));
  samples.assign(500, {10, 0.8F, 0.01F});
  EXPECT_THAT(SampleWarnings(samples), ElementsAre(HasSubstr("expose longer")));
}

TEST(ChooseColorMixture, HasOneComponentPerCloud) {
  Random random(3);
  std::vector<Hsv> samples;
  AddCloud(0, 0.5F, 0.8F, 2500, &random, &samples);
  const MixtureChoice one = ChooseColorMixture("red", samples, 4);
  EXPECT_EQ(one.mixture.components.size(), 1U);
  EXPECT_EQ(one.criteria.size(), 4U);
  AddCloud(0, 0.9F, 0.3F, 2500, &random, &samples);
  const MixtureChoice two = ChooseColorMixture("red", samples, 4);
  EXPECT_EQ(two.mixture.components.size(), 2U);
  EXPECT_LT(two.criteria[1], two.criteria[0]);
}

TEST(ChooseColorMixture, IsDeterministic) {
  Random random(4);
  std::vector<Hsv> samples;
  AddCloud(40, 0.6F, 0.5F, 3000, &random, &samples);
  EXPECT_EQ(ChooseColorMixture("orange", samples, 3).criteria,
            ChooseColorMixture("orange", samples, 3).criteria);
}

TEST(ChooseColorMixture, NeedsSamples) {
  EXPECT_THROW(ChooseColorMixture("red", {}, 3), InputError);
}

}  // namespace
}  // namespace kestrel
