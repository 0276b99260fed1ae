// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/onboard/target_reporter.h"

#include <gtest/gtest.h>

#include "kestrel/core/base/error.h"

namespace kestrel {
namespace {

using Eigen::Vector3d;

constexpr Time kStart = TimeFromNanoseconds(1'000'000'000);
constexpr Duration kAtOnce = Duration::zero();

Time At(double seconds) { return kStart + DurationFromSeconds(seconds); }

// A UAV that flies at 'velocity', and its poses up to an instant.
struct Uav {
  Vector3d position{0, 0, 5};
  Vector3d velocity{0, 0, 0};

  PoseHistory PosesUntil(double seconds) const {
    PoseHistory poses(100, std::chrono::milliseconds(500));
    for (int i = 20; i >= 0; --i) {
      const double t = seconds - 0.01 * i;
      poses.Add({At(t),
                 {Eigen::Quaterniond::Identity(), position + t * velocity},
                 BodyMotion{velocity, Vector3d::Zero()}});
    }
    return poses;
  }
};

// Returns the track of a target at 'position' at the time 'seconds'.
TrackSnapshot TrackAt(double seconds, const Vector3d& position, const Vector3d& velocity,
                      double sigma_m = 0.02) {
  TrackSnapshot track;
  track.captured = At(seconds);
  track.state = TrackState::kTracking;
  TargetEstimate target{At(seconds), {}};
  target.motion.mean.head<3>() = position;
  target.motion.mean.segment<3>(TurnState::kVelocity) = velocity;
  target.motion.covariance.topLeftCorner<3, 3>() = sigma_m * sigma_m * Eigen::Matrix3d::Identity();
  track.target = target;
  return track;
}

TargetReporter MakeReporter(TargetReporterOptions options = {}) { return {options, {}}; }

TEST(TargetReporterTest, ReportsNothingWithoutTrackOrPose) {
  TargetReporter reporter = MakeReporter();
  EXPECT_FALSE(reporter.Report(At(1), kAtOnce, {}, Uav().PosesUntil(1)));
  const PoseHistory no_poses(10, std::chrono::milliseconds(500));
  EXPECT_FALSE(reporter.Report(At(1), kAtOnce, TrackAt(1, {0, 0, 0}, {0, 0, 0}), no_poses));
  EXPECT_EQ(reporter.phase(), TargetPhase::kSearching);
}

// Target and UAV are both predicted to the time at which the autopilot uses the message.
TEST(TargetReporterTest, PredictsTargetAndUavToTimeOfUse) {
  TargetReporter reporter = MakeReporter();
  const Uav uav{{0, 0, 5}, {2, 0, 0}};
  const auto report = reporter.Report(At(1.05), DurationFromSeconds(0.05),
                                      TrackAt(1, {3, 0, 0}, {4, 0, 0}), uav.PosesUntil(1.02));
  ASSERT_TRUE(report);
  EXPECT_EQ(report->time, At(1.1));
  EXPECT_NEAR(report->position_in_world.x(), 3.4, 1e-6);
  EXPECT_NEAR(report->world_from_body.translation.x(), 2.2, 1e-6);
  EXPECT_NEAR(report->position_in_body().x(), 1.2, 1e-6);
  EXPECT_EQ(reporter.phase(), TargetPhase::kFound);
}

TEST(TargetReporterTest, ReportsHeadingOfTrack) {
  TargetReporter reporter = MakeReporter();
  TrackSnapshot track = TrackAt(1, {0, 0, 0}, {0, 0, 0});
  track.target->motion.mean(TurnState::kYaw) = 2.5;
  track.target->motion.covariance(TurnState::kYaw, TurnState::kYaw) = 0.0004;
  EXPECT_FALSE(reporter.Report(At(1), kAtOnce, track, Uav().PosesUntil(1))->yaw);
  track.target->yaw_period = kFullTurn;
  const auto report = reporter.Report(At(1), kAtOnce, track, Uav().PosesUntil(1));
  ASSERT_TRUE(report && report->yaw);
  EXPECT_NEAR(*report->yaw, 2.5, 1e-9);
  EXPECT_NEAR(report->yaw_sigma, 0.02, 1e-9);
}

TEST(TargetReporterTest, IsSilentWhenPredictionExceedsLimit) {
  TargetReporter reporter = MakeReporter();
  const Vector3d still = Vector3d::Zero();
  ASSERT_TRUE(reporter.Report(At(1), kAtOnce, TrackAt(1, {0, 0, 0}, still), Uav().PosesUntil(1)));
  EXPECT_FALSE(
      reporter.Report(At(2), kAtOnce, TrackAt(2, {0, 0, 0}, still, 0.6), Uav().PosesUntil(2)));
  EXPECT_EQ(reporter.phase(), TargetPhase::kLost);
}

TEST(TargetReporterTest, IsSilentWithoutFreshPose) {
  TargetReporter reporter = MakeReporter();
  EXPECT_FALSE(
      reporter.Report(At(1.5), kAtOnce, TrackAt(1.5, {0, 0, 0}, {0, 0, 0}), Uav().PosesUntil(1)));
}

// Flies for a second along with a deck, 'height_m' above it.
TargetReporter RideOn(double height_m, const Vector3d& velocity, const Vector3d& deck_velocity) {
  TargetReporter reporter = MakeReporter();
  for (int i = 0; i <= 50; ++i) {
    const double t = 1 + 0.02 * i;
    const Uav uav{{0, 0, 1 + height_m}, velocity};
    reporter.Report(At(t), kAtOnce,
                    TrackAt(t, Vector3d(0, 0, 1) + t * deck_velocity, deck_velocity),
                    uav.PosesUntil(t));
  }
  return reporter;
}

TEST(TargetReporterTest, PlacesDeckBelowUavAfterContact) {
  const Vector3d drive(4, 0, 0);
  TargetReporter reporter = RideOn(0.35, drive, drive);
  ASSERT_EQ(reporter.phase(), TargetPhase::kContact);
  // The camera sees nothing any more, and the track is lost.
  const auto report = reporter.Report(At(9), kAtOnce, {}, Uav{{0, 0, 1.35}, drive}.PosesUntil(9));
  ASSERT_TRUE(report);
  EXPECT_LT((report->position_in_body() - Vector3d(0, 0, -0.2)).norm(), 1e-9);
  EXPECT_EQ(report->velocity_in_world, drive);
  EXPECT_EQ(reporter.phase(), TargetPhase::kContact);
}

TEST(TargetReporterTest, DetectsNoContactInAirOrDuringDescent) {
  const Vector3d drive(4, 0, 0);
  EXPECT_EQ(RideOn(2, drive, drive).phase(), TargetPhase::kFound);
  EXPECT_EQ(RideOn(0.5, drive - 0.2 * Vector3d::UnitZ(), drive).phase(), TargetPhase::kFound);
}

TEST(TargetReporterTest, DetectsNoContactInLowFlight) {
  const Vector3d still = Vector3d::Zero();
  TargetReporter reporter = RideOn(0.35, still, still);
  reporter.set_may_stand(false);
  const auto report = reporter.Report(At(2.1), kAtOnce, TrackAt(2.1, {0, 0, 1}, still),
                                      Uav{{0, 0, 1.35}, still}.PosesUntil(2.1));
  ASSERT_TRUE(report);
  EXPECT_EQ(reporter.phase(), TargetPhase::kFound);
  EXPECT_NEAR(report->position_in_body().z(), -0.35, 1e-9);
}

TEST(TargetReporterTest, ContactEndsWhenUavRises) {
  const Vector3d still = Vector3d::Zero();
  TargetReporter reporter = RideOn(0.35, still, still);
  ASSERT_EQ(reporter.phase(), TargetPhase::kContact);
  const auto report = reporter.Report(At(3), kAtOnce, TrackAt(3, {0, 0, 1}, still),
                                      Uav{{0, 0, 3}, still}.PosesUntil(3));
  ASSERT_TRUE(report);
  EXPECT_EQ(reporter.phase(), TargetPhase::kFound);
  EXPECT_NEAR(report->position_in_body().z(), -2, 1e-9);
}

TEST(TargetReporterTest, RefusesInvalidOptions) {
  TargetReporterOptions options;
  options.max_sigma_m = -1;
  EXPECT_THROW(MakeReporter(options), InputError);
}

}  // namespace
}  // namespace kestrel
