// SPDX-License-Identifier: BSD-3-Clause
// RegionTracker does not allocate once a region is marked, also while it looks for a lost one.
#include <gtest/gtest.h>

#include "count_allocations.h"
#include "kestrel/vision/region/region_tracker.h"
#include "kestrel/vision/region/test_region_scene.h"

namespace kestrel {
namespace {

TEST(RegionAllocationTest, AllocatesNothingAfterMark) {
  RegionScene scene(1);
  RegionTracker tracker;
  const cv::Mat first = scene.Take();
  tracker.Mark(first, scene.time, scene.Box());
  for (int i = 0; i < 60; ++i) {
    if (i == 10) scene.cover = RegionThing{RegionTexture({160, 160}, 99, 12), {600, 480}};
    if (i == 30) scene.cover.reset();
    if (i > 30) scene.target.scale *= 1.01;
    const cv::Mat image = scene.Take();
    EXPECT_EQ(CountAllocations([&] { tracker.Track(image, scene.time); }), 0) << "image " << i;
  }
}

}  // namespace
}  // namespace kestrel
