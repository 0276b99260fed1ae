// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/core/camera/zoom_lens.h"

#include <cmath>

#include <gtest/gtest.h>

#include "kestrel/core/geometry/angles.h"

namespace kestrel {
namespace {

CameraIntrinsics Lens(double focal_px, double k1 = 0) {
  return {640,          480, focal_px, focal_px, 319.5, 239.5, DistortionModel::kRadialTangential,
          {k1, 0, 0, 0}};
}

ZoomLens Table() {
  return {
      {{Radians(20), Lens(1800, 0.1)}, {Radians(40), Lens(900)}, {Radians(60), Lens(560, -0.2)}},
      {}};
}

TEST(ZoomLensTest, ReportedSettingGivesItsLens) {
  for (const auto& setting : Table().settings) {
    const auto lens = LensAt(Table(), setting.view_rad);
    ASSERT_TRUE(lens);
    EXPECT_NEAR(lens->fx_px, setting.lens.fx_px, 1e-9);
    EXPECT_NEAR(lens->distortion[0], setting.lens.distortion[0], 1e-12);
  }
}

TEST(ZoomLensTest, ViewBetweenSettingsGivesLensBetween) {
  const auto lens = LensAt(Table(), Radians(30));
  ASSERT_TRUE(lens);
  // 640 px that see 30 degrees: 1194 px; the settings are off by as much as 2 %.
  EXPECT_NEAR(lens->fx_px, 1194, 24);
  EXPECT_GT(lens->distortion[0], 0);
  EXPECT_LT(lens->distortion[0], 0.1);
}

TEST(ZoomLensTest, ViewOutsideOfTableHasNoLens) {
  for (const double view_deg : {0.0, 18.0, 64.0, 200.0, std::nan("")}) {
    EXPECT_FALSE(LensAt(Table(), Radians(view_deg))) << view_deg;
  }
  EXPECT_TRUE(LensAt(Table(), Radians(19.5)));
}

TEST(ZoomLensTest, SingleSettingIsScaledByViews) {
  const CameraIntrinsics wide = Lens(560);
  const ZoomLens zoom{{{ViewOf(wide), wide}}, {}};
  const auto lens = LensAt(zoom, 2 * std::atan(320.0 / 1120));
  ASSERT_TRUE(lens);
  EXPECT_NEAR(lens->fx_px, 1120, 1e-6);
}

TEST(ZoomLensTest, FisheyeIsScaledByAngle) {
  CameraIntrinsics fisheye{640,         480, 240, 240, 319.5, 239.5, DistortionModel::kEquidistant,
                           {0, 0, 0, 0}};
  const ZoomLens zoom{{{ViewOf(fisheye), fisheye}}, {}};
  const auto lens = LensAt(zoom, ViewOf(fisheye) / 2);
  ASSERT_TRUE(lens);
  EXPECT_NEAR(lens->fx_px, 480, 1e-6);
}

}  // namespace
}  // namespace kestrel
