// SPDX-License-Identifier: BSD-3-Clause
// Detect does not allocate once its workspace has warmed up, and the tracker never does.
#include <chrono>
#include <vector>

#include <gtest/gtest.h>
#include <opencv2/core.hpp>

#include "count_allocations.h"
#include "kestrel/core/camera/paper_camera.h"
#include "kestrel/simulation/labelled_images/landing_stills.h"
#include "kestrel/vision/landing/landing_pattern_detector.h"
#include "kestrel/vision/tracking/target_tracker.h"

namespace kestrel {
namespace {

constexpr int kWarmUpFrames = 10;
constexpr int kCountedFrames = 15;

struct Shot {
  cv::Mat image;
  TargetHint hint;
};

// Stills from 0.5 to 9 m, each at another height than the one before.
LandingStillMaker MakerOf(int index) {
  constexpr double kAltitudes_m[] = {3, 0.5, 6, 1.2, 9};
  LandingStillOptions options;
  options.min_altitude_m = options.max_altitude_m = kAltitudes_m[index % 5];
  return LandingStillMaker(options);
}

std::vector<Shot> ShotsOfPattern(bool with_hint) {
  std::vector<Shot> shots;
  for (int i = 0; i < kWarmUpFrames + kCountedFrames; ++i) {
    const LandingStill still = MakerOf(i).MakePattern(i);
    TargetHint hint;
    if (with_hint) {
      hint.center_in_camera = still.camera_from_target.translation;
      hint.center_sigma_m = 0.15;
      hint.altitude_m = still.altitude_m;
      hint.up_in_camera = still.up_in_camera;
    }
    shots.push_back({still.image, hint});
  }
  return shots;
}

std::vector<Shot> ShotsOfLookalikes() {
  std::vector<Shot> shots;
  for (int i = 0; i < kWarmUpFrames + kCountedFrames; ++i) {
    LandingStillOptions options;
    options.max_altitude_m = 9;
    shots.push_back({LandingStillMaker(options).MakeLookalikes(i).image, {}});
  }
  return shots;
}

int CountInDetect(const LandingPatternDetector& detector, const Shot& shot,
                  LandingWorkspace* workspace) {
  return CountAllocations([&] { detector.Detect(shot.image, shot.hint, *workspace); });
}

void ExpectNoAllocationAfterWarmUp(const std::vector<Shot>& shots) {
  const LandingPatternDetector detector(CameraModel(PaperCamera()), {});
  LandingWorkspace workspace;
  int warm_up_count = 0;
  for (int i = 0; i < kWarmUpFrames; ++i) {
    warm_up_count += CountInDetect(detector, shots[i], &workspace);
  }
  EXPECT_GT(warm_up_count, 0) << "the count does not see the workspace grow";
  for (std::size_t i = kWarmUpFrames; i < shots.size(); ++i) {
    EXPECT_EQ(CountInDetect(detector, shots[i], &workspace), 0) << "frame " << i;
  }
}

TEST(LandingAllocationTest, AllocatesNothingWithoutHint) {
  ExpectNoAllocationAfterWarmUp(ShotsOfPattern(/*with_hint=*/false));
}

TEST(LandingAllocationTest, AllocatesNothingWithHint) {
  ExpectNoAllocationAfterWarmUp(ShotsOfPattern(/*with_hint=*/true));
}

TEST(LandingAllocationTest, AllocatesNothingWithoutPattern) {
  ExpectNoAllocationAfterWarmUp(ShotsOfLookalikes());
}

// A hint that comes late, like a tracker's, meets a workspace that has warmed up without it.
TEST(LandingAllocationTest, AllocatesNothingWithLateHint) {
  std::vector<Shot> shots = ShotsOfPattern(/*with_hint=*/true);
  for (int i = 0; i < kWarmUpFrames; ++i) shots[i].hint = {};
  ExpectNoAllocationAfterWarmUp(shots);
}

TEST(TrackerAllocationTest, AllocatesNothingAfterConstruction) {
  TargetTracker tracker({});
  const int count = CountAllocations([&] {
    for (int i = 0; i < 500; ++i) {
      const int late = i % 7 == 3 ? i - 5 : i;
      const Time time = TimeFromNanoseconds(1'000'000'000 + 33'000'000LL * late);
      tracker.Add({time, {0.1 * late, 0, 0}, 1e-4 * Eigen::Matrix3d::Identity()});
      tracker.Predict(time + std::chrono::seconds(1));
    }
  });
  EXPECT_EQ(count, 0);
}

}  // namespace
}  // namespace kestrel
