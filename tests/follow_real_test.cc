// SPDX-License-Identifier: BSD-3-Clause
// The region tracker on consecutive frames of a real flight over a driven car, where they are
// there.
#include <chrono>
#include <cmath>

#include <gtest/gtest.h>

#include "kestrel/vision/region/region_tracker.h"
#include "landing_frames.h"
#include "real_frames.h"

namespace kestrel {
namespace {

constexpr char kConsecutive[] = "dji_2017-03-14-04-47-40-1-02";
constexpr Duration kPeriod = std::chrono::milliseconds(33);
constexpr double kNear_px = 20;  // as the benchmarks of trackers count

// A box around the board of the pattern.
cv::Rect2d BoardOf(const LandingFrame& frame) {
  const double half = 1.6 * frame.ring_radius_px;
  return {frame.center_px.x() - half, frame.center_px.y() - half, 2 * half, 2 * half};
}

// The board on the car, by the box in the first frame alone, for each frame that has a truth.
TEST(FollowRealTest, StaysOnDrivenCar) {
  for (const LandingFrameSet& set : ReadLandingReal(KESTREL_DATA_DIR)) {
    if (set.name.find(kConsecutive) == std::string::npos) continue;
    RegionTracker tracker;
    tracker.Mark(set.frames.front().image, Time(), BoardOf(set.frames.front()));
    int known = 0, near = 0;
    for (std::size_t i = 1; i < set.frames.size(); ++i) {
      const LandingFrame& frame = set.frames[i];
      const RegionReport report = tracker.Track(frame.image, Time(static_cast<long>(i) * kPeriod));
      if (frame.truth != PatternTruth::kWhole) continue;
      const cv::Rect2d& box = report.box_px;
      const Eigen::Vector2d center(box.x + 0.5 * box.width, box.y + 0.5 * box.height);
      ++known;
      near +=
          report.state == RegionState::kFollowing && (center - frame.center_px).norm() < kNear_px;
    }
    EXPECT_GT(known, 250);
    EXPECT_GE(near, 0.98 * known);
    return;
  }
  GTEST_SKIP() << kNoRealFrames;
}

}  // namespace
}  // namespace kestrel
