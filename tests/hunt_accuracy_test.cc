// SPDX-License-Identifier: BSD-3-Clause
// What the object detector must reach on the data sets where they are there; bench/hunt_accuracy.cc
// prints it in full.
#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "hunt_score.h"
#include "kestrel/evaluation/statistics.h"

namespace kestrel {
namespace {

std::string DataFolder(const std::string& name) {
  return std::string(KESTREL_DATA_DIR) + "/" + name;
}

bool IsThere(const std::string& name) { return std::filesystem::exists(DataFolder(name)); }

TEST(HuntRealTest, DiscsAreFoundAndNothingElse) {
  if (!IsThere("hunt_real")) GTEST_SKIP() << "no folder " << DataFolder("hunt_real");
  const RealFrameScore score = ScoreRealFrame(DataFolder("hunt_real"));
  int found = 0;
  for (const RealDisc& disc : score.discs) {
    if (disc.color == "green") continue;  // a pile, which is one object in the image
    EXPECT_EQ(disc.found_as, disc.color);
    EXPECT_LE(disc.center_error_px, 3);
    ++found;
  }
  EXPECT_EQ(found, 4);
  EXPECT_EQ(score.single, 5) << "these and the pile";
}

class HuntHardTest : public testing::TestWithParam<const char*> {
 protected:
  std::string Name() const { return std::string("hunt_hard/") + GetParam(); }
};

TEST_P(HuntHardTest, EveryWantedObjectIsFoundAndNothingElse) {
  if (!IsThere(Name())) GTEST_SKIP() << "no folder " << DataFolder(Name());
  std::vector<double> center_errors_px, depth_errors;
  for (const ObjectComparison& c : ScoreHunt(DataFolder(Name())).comparisons) {
    EXPECT_TRUE(c.IsObject()) << "false " << c.detected_class;
    if (!c.is_wanted) continue;
    EXPECT_EQ(c.detected_class, c.true_class);
    center_errors_px.push_back(c.center_error_px);
    depth_errors.push_back(std::abs(c.depth_error.value_or(1)));
  }
  EXPECT_LE(Median(center_errors_px), 0.35);
  EXPECT_LE(Median(depth_errors), 0.015);
}

TEST_P(HuntHardTest, DigitsAreRight) {
  if (!IsThere(Name())) GTEST_SKIP() << "no folder " << DataFolder(Name());
  const DigitScore digits = ScoreHunt(DataFolder(Name())).digits;
  EXPECT_GE(digits.right, 0.9 * digits.count);
}

INSTANTIATE_TEST_SUITE_P(Sets, HuntHardTest, testing::Values("discs", "cuboids"));

}  // namespace
}  // namespace kestrel
