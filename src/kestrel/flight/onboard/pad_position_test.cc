// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/onboard/pad_position.h"

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>

#include <gtest/gtest.h>

#include "kestrel/comms/mavlink/test_autopilot.h"
#include "kestrel/flight/onboard/target_sender.h"

namespace kestrel {
namespace {

using std::chrono_literals::operator""ms;

// Kestrel sends to the scripted autopilot, whose clock began with its own start.
class PadPositionTest : public AutopilotTest {
 protected:
  static constexpr Duration kLateness = 80ms;  // of the images

  void Start() {
    AutopilotTest::Start();
    const auto ignore = [](const std::string&) {};
    position_.emplace(std::nullopt, autopilot_.get(), connection_.get(), ignore);
    sender_.emplace(FlightOptions(), TargetTrackerOptions(), LinkProfile::kArduPilot, 1.0, 30.0,
                    false, autopilot_.get(), connection_.get(), ignore);
  }
  // Hovers 3 m above the pad.
  void Hover(double seconds) {
    for (int i = 0; i < 20 * seconds; ++i) {
      Pass(0.05, i % 20 == 0);
      const PoseSample pose{now_, {Eigen::Quaterniond::Identity(), {0, 0, 3}}, BodyMotion()};
      poses_of_link_.Add(pose);
      position_->TakeAttitude(pose);
      See();
      position_->Send(now_, track_);
      sender_->Send(now_, track_, poses_of_link_);
    }
  }
  void See() {
    track_.captured = now_ - kLateness;
    track_.seen = track_.captured;
    track_.state = TrackState::kTracking;
    track_.target.emplace().time = track_.captured;
    track_.target->motion.covariance.setIdentity();
    track_.target->motion.covariance *= 1e-4;
    track_.sight.emplace().time = track_.captured;
    track_.sight->target_from_body.translation = {0, 0, 3};
    track_.sight->covariance.setIdentity();
  }
  // Time between a stamp and that instant on the autopilot's clock.
  double Error_s(std::uint64_t stamp_us, Time instant) const {
    return 1e-6 * static_cast<double>(stamp_us) - 1e-9 * static_cast<double>(RemoteAt(instant));
  }

  std::optional<PadPosition> position_;
  std::optional<TargetSender> sender_;
  PoseHistory poses_of_link_{512, 500ms};
  TrackSnapshot track_;
};

// ArduPilot corrects the stamps of all messages of a line by one filter, in which the smallest lag
// of any counts as none.
TEST_F(PadPositionTest, OdometryAndLandingTargetHaveOneClock) {
  constexpr double kLimit_s = 0.02;
  constexpr Duration kAssumedAge = 20ms;  // PLND_LAG
  Start();
  Hover(30);
  const auto odometry = last_heard_[mavlink::Odometry::kId].As<mavlink::Odometry>();
  const auto target = last_heard_[mavlink::LandingTarget::kId].As<mavlink::LandingTarget>();
  ASSERT_TRUE(odometry && target);
  EXPECT_NEAR(Error_s(odometry->time_usec, now_ - kLateness), 0, kLimit_s);
  EXPECT_NEAR(Error_s(target->time_usec, now_ - kAssumedAge), 0, kLimit_s);
}

}  // namespace
}  // namespace kestrel
