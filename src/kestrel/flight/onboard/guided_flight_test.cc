// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/onboard/guided_flight.h"

#include <functional>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kestrel/comms/mavlink/mavlink_enums.h"
#include "kestrel/comms/mavlink/packet_parser.h"
#include "kestrel/comms/mavlink/packet_writer.h"
#include "kestrel/core/base/error.h"
#include "kestrel/flight/guidance/landing_guidance.h"

namespace kestrel {
namespace {

using std::chrono_literals::operator""ms;
using testing::HasSubstr;

// Stands still and notes how old the sight is, and how high the target.
class StandingGuidance : public Guidance {
 public:
  StandingGuidance(const GuidanceOptions& options, double* age_s, double* target_z_m = nullptr)
      : Guidance(options, std::nullopt), age_s_(age_s), target_z_m_(target_z_m) {}

 protected:
  void Begin(const GuidanceInput& /*input*/) override {}
  Wish Choose(const GuidanceInput& input) override {
    *age_s_ = input.target_age_s;
    if (target_z_m_ && input.target) *target_z_m_ = input.target->motion.position().z();
    return {};
  }
  const char* WhyGiveUp(const GuidanceInput& /*input*/) override { return nullptr; }
  bool IsBehind(const GuidanceInput& /*input*/) const override { return false; }

 private:
  double *age_s_, *target_z_m_;
};

// An autopilot that reports what it is set to, and a UAV that hovers at (3, 1, 8) m. Time is
// simulated.
class GuidedFlightTest : public testing::Test {
 protected:
  void Start(std::uint8_t autopilot, const FlightOptions& options = {}) {
    Start(autopilot, options, [](const GuidanceOptions& guidance) {
      return std::make_unique<LandingGuidance>(guidance);
    });
  }
  void Start(std::uint8_t autopilot, const FlightOptions& options, const GuidanceMaker& make) {
    heartbeat_.autopilot = autopilot;
    connection_ = std::make_unique<Connection>(
        "udpout://127.0.0.1:9", ConnectionOptions(), [this](auto frame, Time) {
          parser_.Parse(frame, [this](const auto& packet) { Hear(packet); });
        });
    autopilot_ =
        std::make_unique<Autopilot>(AutopilotOptions(), connection_.get(), AutopilotListener());
    guided_ = std::make_unique<GuidedFlight>(
        options, TargetTrackerOptions(), make, true, autopilot_.get(), connection_.get(),
        [this](const std::string& text) { reported_ += text + "\n"; });
  }

  // Receives Kestrel's packets.
  void Hear(const mavlink::Packet& packet) {
    if (packet.As<mavlink::SetPositionTargetLocalNed>()) ++set_points_;
    const auto command = packet.As<mavlink::CommandLong>();
    if (command && command->command == mavlink::kCommandDoSetMode) {
      requested_modes_.insert(static_cast<std::uint32_t>(command->param2) << 16 |
                              static_cast<std::uint32_t>(command->param3) << 24);
    }
    if (command && command->command == mavlink::kCommandLand) {
      requested_modes_.insert(CustomModeOf(AutopilotKind::kPx4, FlightMode::kLand));
    }
    if (const auto question = packet.As<mavlink::ParamRequestRead>()) {
      mavlink::ParamValue value;
      value.param_id = question->param_id;
      const auto known = parameters_.find(std::string(question->param_id.data()));
      value.param_value = known != parameters_.end() ? known->second : limit_;
      value.param_type = mavlink::kParamReal32;
      answers_.push_back(value);
    }
  }

  template <class Message>
  void Report(const Message& message) {
    mavlink::PacketParser().Parse(writer_.Write(message), [&](const mavlink::Packet& packet) {
      autopilot_->Handle(packet, now_);
    });
  }

  // Time passes in steps of 10 ms; every 50 ms a frame shows the target, which stands below.
  void Pass(double seconds) {
    for (int i = 0; i < 100 * seconds; ++i) {
      now_ += 10ms;
      if (i % 10 == 0) Report(heartbeat_);
      if (i % 20 == 0) {
        Report(mavlink::ExtendedSysState{0, landed_});
        Report(mavlink::EkfStatusReport{.flags = ekf_flags_});
        Report(mavlink::EstimatorStatus{.flags = ekf_flags_});
        Report(mavlink::GpsGlobalOrigin{473977420, 85455940, 488000, 0});
        if (has_home_) Report(home_);
      }
      for (const auto& answer : std::exchange(answers_, {})) Report(answer);
      if (has_poses_) {
        poses_.Add({now_, {Eigen::Quaterniond::Identity(), {3, 1, height_m_}}, BodyMotion()});
      }
      if (i % 5 == 0) SeeTarget();
      autopilot_->Tick(now_);
      guided_->Fly(now_, track_, poses_);
    }
  }
  void SeeTarget() {
    track_.captured = now_ - lateness_;
    track_.seen = track_.captured;
    track_.state = TrackState::kTracking;
    track_.target.emplace();
    track_.target->time = track_.captured;
    track_.target->motion.mean.head<3>() << 3, 1, 0;
    track_.target->motion.covariance.setIdentity();
    track_.target->motion.covariance *= 1e-4;
  }
  int SetPointsDuring(double seconds) {
    set_points_ = 0;
    Pass(seconds);
    return set_points_;
  }

  static constexpr std::uint32_t kGuided = 4, kLoiter = 5;
  static constexpr std::uint32_t kOffboard = 6 << 16, kPositionControl = 3 << 16;

  Time now_ = TimeFromNanoseconds(1'000'000'000'000);
  mavlink::Heartbeat heartbeat_{mavlink::kTypeQuadrotor,
                                mavlink::kAutopilotArduPilot,
                                mavlink::kModeFlagArmed,
                                kLoiter,
                                4,
                                3};
  std::uint8_t landed_ = mavlink::kLandedInAir;
  std::uint16_t ekf_flags_ = 0x3f;  // attitude, velocities and positions
  bool has_home_ = true;
  bool has_poses_ = true;
  double height_m_ = 8;
  Duration lateness_{};  // of the images
  mavlink::HomePosition home_{.latitude = 473977420, .longitude = 85455940, .altitude = 488000};
  float limit_ = 50;  // value of all limits of the autopilot
  std::map<std::string, float> parameters_ = {{"GUID_TIMEOUT", 0.3f}, {"COM_OF_LOSS_T", 0.3f},
                                              {"COM_OBL_RC_ACT", 5},  {"NAV_RCL_ACT", 0},
                                              {"MPC_XY_P", 0.95f},    {"MPC_Z_P", 1.0f}};
  TrackSnapshot track_;
  PoseHistory poses_{512, 500ms};
  mavlink::PacketParser parser_;
  mavlink::PacketWriter writer_{1, 1};
  std::vector<mavlink::ParamValue> answers_;
  std::unique_ptr<Connection> connection_;
  std::unique_ptr<Autopilot> autopilot_;
  std::unique_ptr<GuidedFlight> guided_;
  std::string reported_;
  int set_points_ = 0;
  std::set<std::uint32_t> requested_modes_;  // as PX4 numbers them
};

TEST_F(GuidedFlightTest, FliesWhilePilotSelectsMode) {
  Start(mavlink::kAutopilotArduPilot);
  EXPECT_EQ(SetPointsDuring(2), 0);
  heartbeat_.custom_mode = kGuided;
  EXPECT_NEAR(SetPointsDuring(2), 120, 15) << "a beat, and each frame at once";
  EXPECT_NE(guided_->phase(), GuidancePhase::kIdle) << reported_;
  heartbeat_.custom_mode = kLoiter;
  EXPECT_LE(SetPointsDuring(0.1), 6) << "until the heartbeat";
  EXPECT_EQ(SetPointsDuring(3), 0);
  EXPECT_EQ(guided_->phase(), GuidancePhase::kIdle);
  heartbeat_.custom_mode = kGuided;
  EXPECT_GT(SetPointsDuring(1), 30) << "given anew";
}

TEST_F(GuidedFlightTest, StreamsForPx4UntilModeIsLeft) {
  Start(mavlink::kAutopilotPx4);
  heartbeat_.custom_mode = kPositionControl;
  Pass(2);
  EXPECT_GT(SetPointsDuring(1), 30) << "without them PX4 does not go to OFFBOARD";
  heartbeat_.custom_mode = kOffboard;
  EXPECT_GT(SetPointsDuring(1), 30);
  heartbeat_.custom_mode = kPositionControl;
  Pass(0.1);
  EXPECT_EQ(SetPointsDuring(5), 0) << "PX4 would go back to OFFBOARD";
  heartbeat_.base_mode = 0;
  Pass(0.5);
  EXPECT_GT(SetPointsDuring(1), 30) << "a new flight";
}

TEST_F(GuidedFlightTest, ModeWithoutPositionIsReportedOnce) {
  Start(mavlink::kAutopilotArduPilot);
  Pass(2);
  heartbeat_.custom_mode = CustomModeOf(AutopilotKind::kArduPilot, FlightMode::kGuidedByLean);
  EXPECT_EQ(SetPointsDuring(2), 0);
  const std::string line = "GUIDED_NOGPS is for --no-position: give GUIDED";
  ASSERT_THAT(reported_, HasSubstr(line));
  EXPECT_EQ(reported_.find(line), reported_.rfind(line));
}

TEST_F(GuidedFlightTest, KnownDelayOfVideoIsNoAgeOfSight) {
  double age_s = 0;
  Start(mavlink::kAutopilotArduPilot, {}, [&](const GuidanceOptions& guidance) {
    return std::make_unique<StandingGuidance>(guidance, &age_s);
  });
  Pass(2);
  heartbeat_.custom_mode = kGuided;
  lateness_ = 400ms;
  Pass(2);
  EXPECT_NEAR(age_s, 0.4, 0.06);
  guided_->set_video_delay(200ms);
  Pass(0.5);
  EXPECT_NEAR(age_s, 0.2, 0.06);
  guided_->set_video_delay(std::chrono::seconds(2));
  Pass(0.5);
  EXPECT_NEAR(age_s, 0.1, 0.06) << "no more than a track is predicted well";
}

TEST_F(GuidedFlightTest, PlaceIsOnTheGroundOfTheTakeOff) {
  double age_s = 0, z_m = 0;
  Start(mavlink::kAutopilotArduPilot, {}, [&](const GuidanceOptions& guidance) {
    return std::make_unique<StandingGuidance>(guidance, &age_s, &z_m);
  });
  guided_->set_place({473977420, 85455940, 0});
  Pass(2);
  heartbeat_.custom_mode = kGuided;
  Pass(1);
  EXPECT_NEAR(z_m, -GuidanceOptions().leg_m, 1e-6) << "home is where the body stood, at z = 0";
  guided_->set_take_off_ground(-1.2);
  Pass(0.5);
  EXPECT_NEAR(z_m, -1.2, 1e-6) << "where it was seen to stand";
}

TEST_F(GuidedFlightTest, SendsNothingDuringTakeOff) {
  Start(mavlink::kAutopilotArduPilot);
  Pass(1);
  heartbeat_.custom_mode = kGuided;
  for (const std::uint8_t state : {mavlink::kLandedOnGround, mavlink::kLandedTakeoff}) {
    landed_ = state;
    EXPECT_EQ(SetPointsDuring(2), 0);
  }
  landed_ = mavlink::kLandedInAir;
  Pass(0.3);
  EXPECT_GT(SetPointsDuring(1), 30) << reported_;
}

TEST_F(GuidedFlightTest, WaitForLandedStateIsReported) {
  Start(mavlink::kAutopilotArduPilot);
  landed_ = 0;
  Pass(2);
  heartbeat_.custom_mode = kGuided;
  EXPECT_EQ(SetPointsDuring(6), 0);
  EXPECT_THAT(reported_, HasSubstr("does not report whether it is in the air"));
}

TEST_F(GuidedFlightTest, FailsafeIsRefusedWithWhatPilotHasToDo) {
  Start(mavlink::kAutopilotPx4);
  heartbeat_.custom_mode = kPositionControl;
  heartbeat_.system_status = mavlink::kStateCritical;
  Pass(6);
  EXPECT_THAT(reported_, HasSubstr("failsafe (mode POSCTL): give another mode, e.g. Hold, then"));
}

TEST_F(GuidedFlightTest, DoesNotStartInModeEnteredBefore) {
  Start(mavlink::kAutopilotArduPilot);
  heartbeat_.custom_mode = kGuided;
  EXPECT_EQ(SetPointsDuring(3), 0);
  EXPECT_THAT(reported_, HasSubstr("GUIDED was on before: leave it and give it again"));
}

TEST_F(GuidedFlightTest, RefusesInOneLineBeforeFlight) {
  const struct {
    const char* words;
    std::function<void()> fault;
  } refusals[] = {
      {"the vehicle is a plane, expected a multicopter", [&] { heartbeat_.type = 1; }},
      {"the vehicle is a boat, expected a multicopter", [&] { heartbeat_.type = 11; }},
      {"no good estimate of its position", [&] { ekf_flags_ = 1; }},
      {"no home position", [&] { has_home_ = false; }},
      {"limits.max_speed_mps is 10 m/s, the autopilot's own limit is 9 m/s", [&] { limit_ = 9; }},
      {"from the", [&] { home_.latitude += 20000; }},  // 222 m north
      {"see to its cause, then give GUIDED again", [&] { heartbeat_.system_status = 5; }},
      {"GUID_TIMEOUT is 3 s", [&] { parameters_["GUID_TIMEOUT"] = 3; }},
  };
  const auto parameters = parameters_;
  const auto good = heartbeat_;
  const auto home = home_;
  for (const auto& [words, fault] : refusals) {
    heartbeat_ = good;
    home_ = home;
    ekf_flags_ = 0x3f;
    has_home_ = true;
    limit_ = 50;
    parameters_ = parameters;
    fault();
    reported_.clear();
    Start(mavlink::kAutopilotArduPilot);
    Pass(2);
    heartbeat_.custom_mode = kGuided;
    EXPECT_EQ(SetPointsDuring(2), 0) << words;
    EXPECT_THAT(reported_, HasSubstr("guidance refused: "));
    EXPECT_THAT(reported_, HasSubstr(words));
  }
}

TEST_F(GuidedFlightTest, RefusesBoxOutsideOfGeofence) {
  Start(mavlink::kAutopilotArduPilot);
  guided_->set_box({.latitude_e7 = 473997420, .longitude_e7 = 85455940});
  Pass(2);
  heartbeat_.custom_mode = kGuided;
  EXPECT_EQ(SetPointsDuring(2), 0);
  EXPECT_THAT(reported_, HasSubstr("guidance refused: the box is 223 m from home"));
}

// Without set-points PX4 does not take the mode, and the pilot would not learn why.
TEST_F(GuidedFlightTest, WarnsOfRefusalOnceBeforeModeIsGiven) {
  Start(mavlink::kAutopilotPx4);
  has_home_ = false;
  Pass(10);
  const std::string warning = "guidance would be refused now: the autopilot has no home position";
  const std::size_t first = reported_.find(warning);
  ASSERT_NE(first, std::string::npos) << reported_;
  EXPECT_EQ(reported_.find(warning, first + 1), std::string::npos);
}

TEST_F(GuidedFlightTest, RefusesTooLowRate) {
  FlightOptions options;
  options.rate_hz = 10;
  EXPECT_THROW(Start(mavlink::kAutopilotArduPilot, options), InputError);
}

// PX4 without GNSS leaves OFFBOARD on the deck, holds its place and stays armed.
TEST_F(GuidedFlightTest, EndsLandingWhenAutopilotLeavesModeWithoutPosition) {
  constexpr std::uint32_t kHold = (4 << 16) | (3 << 24);
  for (const std::uint32_t mode : {kHold, kPositionControl}) {
    reported_.clear();
    requested_modes_.clear();
    has_poses_ = true;
    height_m_ = 8;
    heartbeat_.custom_mode = kPositionControl;
    Start(mavlink::kAutopilotPx4);
    Pass(2);
    heartbeat_.custom_mode = kOffboard;
    for (; height_m_ > 0.35; height_m_ -= 0.05) Pass(0.05);
    Pass(2);
    ASSERT_EQ(guided_->phase(), GuidancePhase::kLanded) << reported_;
    has_poses_ = false;
    Pass(0.5);
    heartbeat_.custom_mode = mode;
    Pass(3);
    EXPECT_THAT(reported_, HasSubstr("left its mode on the deck, without a position"));
    const std::uint32_t land = CustomModeOf(AutopilotKind::kPx4, FlightMode::kLand);
    EXPECT_EQ(requested_modes_.contains(land), mode == kHold) << "a pilot's mode is left alone";
  }
}

}  // namespace
}  // namespace kestrel
