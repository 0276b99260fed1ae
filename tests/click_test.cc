// SPDX-License-Identifier: BSD-3-Clause
// A person marks a thing on a picture that is 300 ms old, while the camera turns at 30 degrees a
// second: rendered flights.
#include <algorithm>
#include <array>
#include <memory>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "kestrel/core/base/random.h"
#include "kestrel/flight/session/follow_task.h"
#include "kestrel/io/recording/euroc/euroc_layout.h"
#include "kestrel/io/recording/tables/csv_columns.h"
#include "kestrel/simulation/recordings/recording_plan.h"
#include "kestrel/simulation/recordings/scenarios.h"
#include "kestrel/simulation/recordings/test_plans.h"

namespace kestrel {
namespace {

constexpr int kFlights = 20;
constexpr double kRate_hz = 20;
constexpr int kOld = 6;  // images, 300 ms
constexpr int kMarked = 4, kNow = kMarked + kOld, kEnd = kNow + 20;

cv::Point2d MiddleOf(const cv::Rect2d& box) {
  return {box.x + 0.5 * (box.width - 1), box.y + 0.5 * (box.height - 1)};
}

// A flight whose nose turns by up to 30 degrees/s.
class TurningFlight {
 public:
  explicit TurningFlight(int seed)
      : plan_(
            PlanFollow(ReadFollowSimulation(
                           std::array{"person", "car", "boat"}[seed % 3], "",
                           {fmt::format("frames={}", kEnd + 1), fmt::format("rate_hz={}", kRate_hz),
                            "flight.turn_dps=30", "flight.turn_deg=15",
                            "navigation.clock_offset_min_s=0", "navigation.clock_offset_max_s=0",
                            "navigation.mount_error_deg=0", "ground.map_px=1024"}),
                       FollowCalibration(), seed)) {
    const std::string text = TextOf(plan_, "region0/data.csv");
    const CsvTable rows(text, "region0");
    for (std::size_t i = 0; i < rows.row_count(); ++i) {
      boxes_.emplace_back(rows.Number(i, 1), rows.Number(i, 2), rows.Number(i, 3),
                          rows.Number(i, 4));
    }
  }

  cv::Rect2d Box(int image) const { return boxes_[image]; }

  // True when what is followed from then on is the thing: at once, and a second later.
  bool Follows(const cv::Rect2d& marked) {
    SessionCamera camera{.calibration = FollowCalibration(), .has_world = true, .is_live = true};
    const auto vision = FollowTask({}).MakeVision(camera);
    AddPoses(vision.get());
    for (int i = 0; i <= kNow; ++i) vision->Process(FrameAt(i));
    vision->Mark(plan_.times[kMarked], marked);
    for (int i = kNow + 1; i <= kEnd; ++i) {
      const Observation observation = vision->Process(FrameAt(i));
      const auto& region = std::get<FollowObservation>(observation.seen).region;
      if (i != kNow + 1 && i != kEnd) continue;
      if (region->state != RegionState::kFollowing) return false;
      if (!boxes_[i].contains(MiddleOf(region->box_px))) return false;
    }
    return true;
  }

 private:
  Frame FrameAt(int i) const { return {"", plan_.times[i], plan_.render(i)}; }

  void AddPoses(Vision* vision) const {
    const std::string text = TextOf(plan_, euroc::kPoses);
    const CsvTable rows(text, "nav0");
    const auto times = ParseTimes(rows, "timestamp [ns]");
    const PoseColumns poses(rows, "WB");
    for (std::size_t i = 0; i < rows.row_count(); ++i) {
      vision->AddPose({times[i], poses.Parse(i)});
    }
  }

  RecordingPlan plan_;
  std::vector<cv::Rect2d> boxes_;
};

// The box of a drag that is not exact.
cv::Rect2d Dragged(const cv::Rect2d& box, Random* random) {
  const auto off = [&](double size) { return size * random->Uniform(-0.15, 0.15); };
  const double left = off(box.width), top = off(box.height);
  return {box.x + left, box.y + top, box.width - left + off(box.width),
          box.height - top + off(box.height)};
}

// The box of a click on the page: a square around it.
cv::Rect2d Clicked(const cv::Rect2d& box, Random* random) {
  constexpr double kShare = 0.08;
  const double side = kShare * FollowCalibration().intrinsics.width_px;
  const cv::Point2d middle = MiddleOf(box);
  return {middle.x + box.width * random->Uniform(-0.2, 0.2) - side / 2,
          middle.y + box.height * random->Uniform(-0.2, 0.2) - side / 2, side, side};
}

using MarkMaker = cv::Rect2d (*)(const cv::Rect2d& box, Random* random);

int Right(MarkMaker mark) {
  int right = 0;
  for (int seed = 1; seed <= kFlights; ++seed) {
    TurningFlight flight(seed);
    Random random(seed);
    const bool follows = flight.Follows(mark(flight.Box(kMarked), &random));
    if (!follows) fmt::print(stderr, "seed {}: not followed\n", seed);
    right += follows;
  }
  return right;
}

TEST(ClickTest, DragOnOldPictureOfTurningCameraTakesTheThing) { EXPECT_GE(Right(Dragged), 19); }

TEST(ClickTest, ClickOnOldPictureOfTurningCameraTakesTheThing) { EXPECT_GE(Right(Clicked), 19); }

}  // namespace
}  // namespace kestrel
