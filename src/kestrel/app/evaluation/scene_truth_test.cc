// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/evaluation/scene_truth.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kestrel/core/base/test_folder.h"

namespace kestrel {
namespace {

using ::testing::HasSubstr;

TEST(SceneTruth, KeepsDefaultsOfMissingKeys) {
  const SceneTruth scene = ParseSceneTruth("seed: 7\npattern: null\n", "scene.yaml");
  EXPECT_EQ(scene.ConditionAt(Time()), "all");
  EXPECT_EQ(scene.ring_diameter_m, 1);
  EXPECT_FALSE(scene.ExposureAt(Time()));
  EXPECT_NEAR(scene.mount_error.w(), 1, 1e-12);
}

TEST(SceneTruth, ReadsValuesOfSingleImages) {
  const SceneTruth scene = ParseSceneTruth(
      "condition: dark\ntime_offset_s: 0.07\noptions: {shutter: {exposure_s: 0.01}}\n"
      "frames:\n  '5': {condition: dust, exposure_s: 0.02}\n  '6': {haze: 1}\n",
      "scene.yaml");
  EXPECT_EQ(scene.ConditionAt(TimeFromNanoseconds(5)), "dust");
  EXPECT_EQ(scene.ConditionAt(TimeFromNanoseconds(6)), "dark");
  EXPECT_EQ(scene.ExposureAt(TimeFromNanoseconds(5)), 0.02);
  EXPECT_EQ(scene.ExposureAt(TimeFromNanoseconds(6)), 0.01);
}

TEST(SceneTruth, TakesHeadingsFromKindOfPad) {
  const auto of = [](const char* kind) {
    return ParseSceneTruth(std::string("options: {target: {kind: ") + kind + "}}\n", "scene.yaml")
        .heading_symmetry;
  };
  EXPECT_EQ(ParseSceneTruth("seed: 7\n", "scene.yaml").heading_symmetry, 4)
      << "before there were kinds";
  EXPECT_EQ(of("ring-cross"), 4);
  EXPECT_EQ(of("nested"), 1);
  EXPECT_EQ(of("helipad"), 2);
  EXPECT_FALSE(of("my-own"));
}

TEST(SceneTruth, MountErrorTurnsAboutZThenYThenX) {
  const SceneTruth scene =
      ParseSceneTruth("mount_error: {yaw_deg: 90, pitch_deg: 0, roll_deg: 90}\n", "scene.yaml");
  const Eigen::Vector3d turned = scene.mount_error * Eigen::Vector3d::UnitY();
  EXPECT_LT((turned - Eigen::Vector3d::UnitZ()).norm(), 1e-12);
}

TEST(SceneTruth, ErrorsNameKey) {
  EXPECT_THAT(InputErrorOf([] { ParseSceneTruth("mount_error: {yaw_deg: much}\n", "scene.yaml"); }),
              HasSubstr("scene.yaml: mount_error.yaw_deg: is 'much', expected a finite number"));
  EXPECT_THAT(InputErrorOf([] { ParseSceneTruth("frames: {first: {}}\n", "scene.yaml"); }),
              HasSubstr("frames.first"));
  EXPECT_THAT(InputErrorOf([] { ParseSceneTruth("a: [1\n", "scene.yaml"); }),
              HasSubstr("is not YAML"));
  EXPECT_THAT(InputErrorOf([] { ParseSceneTruth("just words", "scene.yaml"); }),
              HasSubstr("expected a map"));
}

}  // namespace
}  // namespace kestrel
