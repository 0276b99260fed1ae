// SPDX-License-Identifier: BSD-3-Clause
// Detect does not allocate once its workspace has warmed up, the tracker not at all. Counts by
// taking the place of the C library's allocation functions (glibc), through which operator new and
// cv::Mat go as well.
#include <cerrno>
#include <chrono>
#include <cstddef>
#include <vector>

#include <gtest/gtest.h>
#include <opencv2/core.hpp>

#include "kestrel/landing/landing_pattern_detector.h"
#include "kestrel/simulation/landing_stills.h"
#include "kestrel/tracking/target_tracker.h"

namespace {

thread_local bool is_counting = false;
thread_local int allocation_count = 0;

void CountAllocation() {
  if (is_counting) ++allocation_count;
}

}  // namespace

extern "C" {
void* __libc_malloc(std::size_t size);
void* __libc_calloc(std::size_t count, std::size_t size);
void* __libc_realloc(void* memory, std::size_t size);
void* __libc_memalign(std::size_t align, std::size_t size);

void* malloc(std::size_t size) {
  CountAllocation();
  return __libc_malloc(size);
}
void* calloc(std::size_t count, std::size_t size) {
  CountAllocation();
  return __libc_calloc(count, size);
}
void* realloc(void* memory, std::size_t size) {
  CountAllocation();
  return __libc_realloc(memory, size);
}
void* aligned_alloc(std::size_t align, std::size_t size) {
  CountAllocation();
  return __libc_memalign(align, size);
}
int posix_memalign(void** memory, std::size_t align, std::size_t size) {
  CountAllocation();
  *memory = __libc_memalign(align, size);
  return *memory == nullptr ? ENOMEM : 0;
}
}

namespace kestrel {
namespace {

constexpr int kWarmUpFrames = 10;
constexpr int kCountedFrames = 15;

struct Shot {
  cv::Mat image;
  LandingHint hint;
};

// Stills from 0.5 to 9 m, one after the other of another height.
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
    LandingHint hint;
    if (with_hint) {
      hint.center_in_camera = still.camera_from_pattern.translation;
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

int CountAllocations(const LandingPatternDetector& detector, const Shot& shot,
                     LandingWorkspace* workspace) {
  allocation_count = 0;
  is_counting = true;
  detector.Detect(shot.image, shot.hint, *workspace);
  is_counting = false;
  return allocation_count;
}

void ExpectNoAllocationAfterWarmUp(const std::vector<Shot>& shots) {
  const LandingPatternDetector detector(CameraModel(PaperCamera()), {});
  LandingWorkspace workspace;
  int warm_up_count = 0;
  for (int i = 0; i < kWarmUpFrames; ++i) {
    warm_up_count += CountAllocations(detector, shots[i], &workspace);
  }
  EXPECT_GT(warm_up_count, 0) << "the count does not see the workspace grow";
  for (std::size_t i = kWarmUpFrames; i < shots.size(); ++i) {
    EXPECT_EQ(CountAllocations(detector, shots[i], &workspace), 0) << "frame " << i;
  }
}

TEST(LandingAllocationTest, NoneWithoutHint) {
  ExpectNoAllocationAfterWarmUp(ShotsOfPattern(/*with_hint=*/false));
}

TEST(LandingAllocationTest, NoneWithHint) {
  ExpectNoAllocationAfterWarmUp(ShotsOfPattern(/*with_hint=*/true));
}

TEST(LandingAllocationTest, NoneWithoutPattern) {
  ExpectNoAllocationAfterWarmUp(ShotsOfLookalikes());
}

// A hint that comes late, as a tracker's does, finds the workspace warm.
TEST(LandingAllocationTest, NoneWhenTheHintComesLate) {
  std::vector<Shot> shots = ShotsOfPattern(/*with_hint=*/true);
  for (int i = 0; i < kWarmUpFrames; ++i) shots[i].hint = {};
  ExpectNoAllocationAfterWarmUp(shots);
}

TEST(TrackerAllocationTest, NoneAfterConstruction) {
  TargetTracker tracker({});
  allocation_count = 0;
  is_counting = true;
  for (int i = 0; i < 500; ++i) {
    const int late = i % 7 == 3 ? i - 5 : i;
    const Time time = TimeFromNanoseconds(1'000'000'000 + 33'000'000LL * late);
    tracker.Add({time, {0.1 * late, 0, 0}, 1e-4 * Eigen::Matrix3d::Identity()});
    tracker.Predict(time + std::chrono::seconds(1));
  }
  is_counting = false;
  EXPECT_EQ(allocation_count, 0);
}

}  // namespace
}  // namespace kestrel
