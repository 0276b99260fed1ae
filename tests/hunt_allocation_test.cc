// SPDX-License-Identifier: BSD-3-Clause
// HuntPipeline does not allocate once it has warmed up.
#include <string>

#include <gtest/gtest.h>

#include "count_allocations.h"
#include "kestrel/vision/objects/test_objects.h"
#include "kestrel/vision/pipeline/hunt_pipeline.h"

namespace kestrel {
namespace {

cv::Mat DrawFrame(int index) {
  ObjectScene scene;
  const cv::Scalar paints[] = {kRedPaint, kGreenPaint, kBluePaint, kYellowPaint};
  for (int i = 0; i < 4; ++i) {
    scene.DrawDisc(scene.PointUnder({100.0 + 130 * i + 3 * index, 100.0 + 40 * i}, 0), 0.1,
                   paints[i]);
  }
  return scene.Image();
}

void ExpectNoneAfterWarmUp(const HuntPipelineOptions& options, const std::string& sought = {}) {
  constexpr int kWarmUpFrames = 5;
  constexpr int kFrames = 15;
  CameraCalibration calibration;
  calibration.intrinsics = ObjectCamera().intrinsics();
  // The camera looks straight down.
  calibration.body_from_camera = RigidTransform{
      Eigen::Quaterniond(Eigen::AngleAxisd(3.141592653589793, Eigen::Vector3d::UnitX())),
      Eigen::Vector3d::Zero()};
  HuntPipeline pipeline(calibration, DefaultObjectModel(), options);
  if (!sought.empty()) pipeline.Seek(sought);
  for (int i = 0; i < kFrames; ++i) {
    const Time time(DurationFromSeconds(0.1 * i));
    pipeline.AddPose({time, {Eigen::Quaterniond::Identity(), {0, 0, 4}}});
    const cv::Mat image = DrawFrame(i);
    const int count = CountAllocations([&] { pipeline.Process(image, time); });
    if (i == 0) {
      EXPECT_GT(count, 0) << "the count does not see the workspace grow";
    }
    if (i >= kWarmUpFrames) {
      EXPECT_EQ(count, 0) << "frame " << i;
    }
  }
}

TEST(HuntAllocationTest, AllocatesNothingInCompleteSearch) { ExpectNoneAfterWarmUp({}); }

TEST(HuntAllocationTest, AllocatesNothingWhenTracking) {
  HuntPipelineOptions options;
  options.track_count = 2;
  ExpectNoneAfterWarmUp(options);
}

TEST(HuntAllocationTest, AllocatesNothingWhileAnObjectIsSought) {
  ExpectNoneAfterWarmUp({}, "red");
}

}  // namespace
}  // namespace kestrel
