// SPDX-License-Identifier: BSD-3-Clause
// A whole flight after a person, in real time with rendered images: what `kestrel fly sim:follow
// --follow --guide` does, with a scripted person at the page.
#include <algorithm>
#include <cmath>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "kestrel/app/fly/fly_autopilot.h"
#include "kestrel/app/fly/fly_source.h"
#include "kestrel/core/camera/camera_model.h"
#include "kestrel/flight/onboard/session.h"

namespace kestrel {
namespace {

using Eigen::Vector3d;

// Around a person at 'place', in the image of a camera there; nothing when it is not in it.
std::optional<cv::Rect2d> PersonIn(const CameraModel& camera,
                                   const RigidTransform& world_from_camera, const Vector3d& place) {
  constexpr double kHalf_m = 0.25, kHeight_m = 1.75;
  const RigidTransform camera_from_world = world_from_camera.Inverse();
  Eigen::Array2d low(1e9, 1e9), high(-1e9, -1e9);
  for (int corner = 0; corner < 8; ++corner) {
    const Vector3d point =
        place + Vector3d(corner & 1 ? kHalf_m : -kHalf_m, corner & 2 ? kHalf_m : -kHalf_m,
                         corner & 4 ? kHeight_m : 0);
    Eigen::Vector2d pixel;
    if (camera.Project(camera_from_world * point, &pixel) != ProjectionStatus::kOk) return {};
    low = low.min(pixel.array());
    high = high.max(pixel.array());
  }
  if ((low < 0).any() || high.x() >= camera.width_px() || high.y() >= camera.height_px()) return {};
  return cv::Rect2d(low.x(), low.y(), high.x() - low.x() + 1, high.y() - low.y() + 1);
}

// Compares what is followed with the truth, and keeps the newest picture's truth for a mark.
class FollowWitness : public ObservationSink {
 public:
  FollowWitness(const CameraIntrinsics& lens, const VehicleWorld* world)
      : camera_(lens), world_(world) {}

  struct Seen {
    std::optional<std::pair<Time, cv::Rect2d>> person;  // in the newest picture that shows it
    int visible = 0, on_target = 0, wrong = 0;          // pictures since the mark
  };

  void Take(const Observation& observation) override {
    const auto& seen = std::get<FollowObservation>(observation.seen);
    if (!seen.world_from_camera) return;
    const auto box = PersonIn(camera_, *seen.world_from_camera,
                              world_->PatternAt(observation.frame.time).translation);
    const std::lock_guard lock(mutex_);
    if (box) seen_.person = {observation.frame.time, *box};
    if (!seen.region) return;
    seen_.visible += box.has_value();
    if (seen.region->state != RegionState::kFollowing) return;
    const cv::Rect2d& found = seen.region->box_px;
    const bool is_on =
        box && box->contains({found.x + found.width / 2, found.y + found.height / 2});
    ++(is_on ? seen_.on_target : seen_.wrong);
  }

  Seen seen() const {
    const std::lock_guard lock(mutex_);
    return seen_;
  }

 private:
  CameraModel camera_;
  const VehicleWorld* world_;
  mutable std::mutex mutex_;
  Seen seen_;
};

class FollowedFlightTest : public testing::TestWithParam<const char*> {};

TEST_P(FollowedFlightTest, PersonIsFollowedAfterMarkAndConfirmation) {
  constexpr double kMeasured_s = 15, kLongest_s = 60;
  KestrelOptions options;
  options.fly.sim_camera.rate_hz = 12;
  options.fly.sim_autopilot.model.pilot.guide_after_s = 2;
  FlySource source(options, {});
  RecordingChoice choice;
  choice.sources = {"sim:follow,drive_delay_s=2"};
  source.Open(choice, false);
  FlyAutopilot autopilot = MakeFlyAutopilot(GetParam(), options.fly, /*guides=*/true, &source);
  const auto session = MakeSession(source.live, FollowTask({}),
                                   SessionOptionsFor(autopilot, options.fly, /*guides=*/true));
  VehicleWorld* const world = source.simulated.World();
  const FollowWitness* const witness = session->sinks().Add(
      std::make_unique<FollowWitness>(source.live.calibration.intrinsics, world));
  const Time start = Now();
  std::optional<Time> confirmed, arrived;
  bool is_marked = false;
  int steps = 0, near_steps = 0;
  autopilot.simulated->Start();
  session->Run([&] {
    const auto state = session->Report().autopilot;
    const GuidancePhase phase = state && state->guidance ? *state->guidance : GuidancePhase::kIdle;
    const auto seen = witness->seen();
    if (phase == GuidancePhase::kLook && seen.person && !is_marked) {
      session->Mark(seen.person->first, seen.person->second);
      is_marked = true;
    } else if (phase == GuidancePhase::kLook && seen.on_target > 5 && !confirmed) {
      session->Confirm();
      confirmed = Now();
    }
    if (phase == GuidancePhase::kFollow && !arrived) arrived = Now();
    if (arrived) {
      const Vector3d uav = autopilot.simulated->truth().world_from_body.translation;
      const double distance_m = (uav - world->PatternAt(Now()).translation).head<2>().norm();
      ++steps;
      near_steps += std::abs(distance_m - 12) < 0.2 * 12;
    }
    return Now() - start > DurationFromSeconds(kLongest_s) ||
           (arrived && Now() - *arrived > DurationFromSeconds(kMeasured_s));
  });
  autopilot.simulated->Stop();
  const auto seen = witness->seen();
  fmt::print(
      "{}: pictures with the person {}, on it {}, on something else {}; distance within a "
      "fifth {} of {}\n",
      GetParam(), seen.visible, seen.on_target, seen.wrong, near_steps, steps);
  EXPECT_TRUE(confirmed);
  ASSERT_TRUE(arrived);
  EXPECT_GT(seen.on_target, 0.9 * seen.visible);
  EXPECT_EQ(seen.wrong, 0);
  EXPECT_GT(near_steps, 0.9 * steps);
}

INSTANTIATE_TEST_SUITE_P(Autopilots, FollowedFlightTest,
                         testing::Values("sim:ardupilot", "sim:px4"), [](const auto& parameter) {
                           return std::string(parameter.param).substr(sizeof("sim:") - 1);
                         });

}  // namespace
}  // namespace kestrel
