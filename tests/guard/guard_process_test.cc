// SPDX-License-Identifier: BSD-3-Clause
// The guard as a process, between a program that flies and is killed and a simulated autopilot.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <memory>
#include <optional>
#include <signal.h>
#include <string>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "kestrel/comms/guard/guard_link.h"
#include "kestrel/comms/mavlink/autopilot_kind.h"
#include "kestrel/comms/mavlink/socket_address.h"
#include "kestrel/core/base/test_eventually.h"
#include "kestrel/core/base/test_folder.h"
#include "kestrel/simulation/autopilots/simulated_autopilot.h"

namespace kestrel {
namespace {

// A program as a child process.
class Program {
 public:
  Program(const std::string& url, const std::string& key) : process_(fork()) {
    if (process_ != 0) return;
    execl(KESTREL_FLYER, "guard_flyer", url.c_str(), key.c_str(), nullptr);
    _exit(127);
  }
  ~Program() {
    if (process_ <= 0) return;
    Signal(SIGKILL);
    Wait();
  }
  Program(const Program&) = delete;
  Program& operator=(const Program&) = delete;

  void Signal(int number) const { kill(process_, number); }
  // Returns its exit status, or -1 when a signal has killed it.
  int Wait() {
    int status = 0;
    waitpid(std::exchange(process_, 0), &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }
  pid_t Guard() const {
    std::ifstream children(fmt::format("/proc/{}/task/{}/children", process_, process_));
    pid_t guard = 0;
    children >> guard;
    return guard;
  }

 private:
  pid_t process_;
};

// Flight of the UAV after the death of the program.
struct Aftermath {
  double farthest_m = 0;
  double lowest_m = 1000;
  double speed_mps = 0;  // at the end
};

class GuardProcessTest : public ::testing::TestWithParam<const char*> {
 protected:
  void Start(double take_back_after_s = -1, const std::string& key = "") {
    const int port = FreeLoopbackPort();
    url_ = fmt::format("udpin://127.0.0.1:{}", port);
    VehicleWorldOptions world = ReadVehicleWorld("standing", {});
    world.ground.map_px = 64;
    world_ = std::make_unique<VehicleWorld>(world, Now(), 1);
    SimulatedAutopilotOptions options;
    options.firmware = GetParam();
    options.signing_key = key;
    options.model.pilot.start_altitude_m = kStart_m;
    options.model.pilot.land_after_s = -1;
    options.model.pilot.guide_after_s = 1.5;
    options.model.pilot.take_back_after_s = take_back_after_s;
    options.model.pilot.follows_vehicle = false;
    autopilot_ = std::make_unique<SimulatedAutopilot>(
        options, fmt::format("udpout://127.0.0.1:{}", port), world_.get(), 1);
    autopilot_->Start();
    program_.emplace(url_, key);
  }
  void TearDown() override {
    program_.reset();
    if (autopilot_) autopilot_->Stop();
  }

  AutopilotKind Kind() const {
    return std::string(GetParam()) == "px4" ? AutopilotKind::kPx4 : AutopilotKind::kArduPilot;
  }
  bool IsIn(FlightMode mode) const {
    return autopilot_->custom_mode() == CustomModeOf(Kind(), mode);
  }
  Eigen::Vector3d Place() const { return autopilot_->truth().world_from_body.translation; }
  double Speed() const { return autopilot_->truth().motion->velocity_in_world.norm(); }

  // Waits until the pilot has given the mode and taken it back, and the program knows.
  void AwaitTakeBack() {
    ASSERT_TRUE(Eventually([&] { return IsIn(FlightMode::kGuided); }));
    ASSERT_TRUE(Eventually([&] { return IsIn(FlightMode::kPilot); }));
    Watch(0.3);
  }
  // Waits until it descends fast, well above the ground.
  void AwaitDescent() {
    const double start_z = Place().z();
    ASSERT_TRUE(Eventually([&] { return Place().z() < start_z - 1.5 && Speed() > 4; }));
  }

  Aftermath Watch(double for_s) const {
    Aftermath after;
    const Eigen::Vector3d place = Place();
    for (const Time end = Now() + DurationFromSeconds(for_s); Now() < end;) {
      std::this_thread::sleep_for(std::chrono::milliseconds(10));  // it samples a flight
      after.farthest_m = std::max(after.farthest_m, (Place() - place).head<2>().norm());
      after.lowest_m = std::min(after.lowest_m, Place().z());
    }
    after.speed_mps = Speed();
    return after;
  }
  // The UAV was stopped and handed back in the air.
  void ExpectStopped(const Aftermath& after) const {
    EXPECT_LT(after.farthest_m, 7);
    EXPECT_GT(after.lowest_m, 2);
    EXPECT_LT(after.speed_mps, 0.3);
    EXPECT_TRUE(IsIn(FlightMode::kHold)) << autopilot_->custom_mode();
  }

  static constexpr double kStart_m = 8;
  TestFolder folder_;
  std::string url_;
  std::unique_ptr<VehicleWorld> world_;
  std::unique_ptr<SimulatedAutopilot> autopilot_;
  std::optional<Program> program_;
};

INSTANTIATE_TEST_SUITE_P(Autopilots, GuardProcessTest, ::testing::Values("ardupilot", "px4"),
                         [](const auto& info) { return std::string(info.param); });

TEST_P(GuardProcessTest, StopsUavWhenProgramIsKilled) {
  Start();
  AwaitDescent();
  program_->Signal(SIGKILL);
  ExpectStopped(Watch(4));
  EXPECT_EQ(autopilot_->result().set_points_after_take_back, 0);
}

TEST_P(GuardProcessTest, StopsUavWhenProgramCrashes) {
  Start();
  AwaitDescent();
  program_->Signal(SIGUSR1);
  ExpectStopped(Watch(4));
}

TEST_P(GuardProcessTest, StopsUavWhenProgramHangsAndKeepsControl) {
  Start();
  AwaitDescent();
  program_->Signal(SIGSTOP);
  ExpectStopped(Watch(4));
  program_->Signal(SIGCONT);
  EXPECT_EQ(program_->Wait(), static_cast<int>(GuardState::kTookOver));
  ExpectStopped(Watch(1));
  EXPECT_EQ(autopilot_->result().set_points_after_take_back, 0);
}

TEST_P(GuardProcessTest, ResumedProgramDoesNotDisturbGuard) {
  Start();
  AwaitDescent();
  program_->Signal(SIGSTOP);
  ASSERT_TRUE(Eventually([&] { return IsIn(FlightMode::kHold); }));
  program_->Signal(SIGCONT);
  EXPECT_EQ(program_->Wait(), static_cast<int>(GuardState::kTookOver));
  ExpectStopped(Watch(4));
}

TEST_P(GuardProcessTest, StopsUavWhenProgramEndsInFlight) {
  Start();
  AwaitDescent();
  program_->Signal(SIGINT);
  ExpectStopped(Watch(4));
}

TEST_P(GuardProcessTest, DoesNotDisturbPilotWhoTookBack) {
  Start(/*take_back_after_s=*/3);
  AwaitTakeBack();
  const int before = autopilot_->result().set_points_after_take_back;
  program_->Signal(SIGKILL);
  Watch(2);
  EXPECT_EQ(autopilot_->result().set_points_after_take_back, before);
  EXPECT_EQ(autopilot_->result().modes_by_link, 0);
  EXPECT_TRUE(IsIn(FlightMode::kPilot));
}

TEST_P(GuardProcessTest, EndsWithProgramAndFreesLine) {
  Start(/*take_back_after_s=*/3);
  AwaitTakeBack();
  const pid_t guard = program_->Guard();
  ASSERT_GT(guard, 0);
  program_->Signal(SIGINT);
  EXPECT_EQ(program_->Wait(), static_cast<int>(GuardState::kWatches));
  // Its number stays until whoever inherited the process has reaped it.
  EXPECT_TRUE(Eventually([&] { return kill(guard, 0) != 0; }));
  EXPECT_EQ(autopilot_->result().modes_by_link, 0);
  const GuardLink next(url_, {.program = KESTREL_GUARD}, "");
  EXPECT_EQ(next.state(), GuardState::kWatches);
}

TEST_P(GuardProcessTest, FlightContinuesWhenGuardIsKilled) {
  Start();
  AwaitDescent();
  kill(program_->Guard(), SIGKILL);
  Watch(0.8);
  EXPECT_TRUE(IsIn(FlightMode::kGuided));
  EXPECT_GT(Speed(), 3.5);  // it still gets the set-points
}

TEST_P(GuardProcessTest, ReplacesHangingGuard) {
  Start();
  AwaitDescent();
  const pid_t guard = program_->Guard();
  kill(guard, SIGSTOP);
  EXPECT_TRUE(Eventually([&] { return program_->Guard() != guard; }));
  Watch(0.3);
  EXPECT_TRUE(IsIn(FlightMode::kGuided));
  EXPECT_GT(Speed(), 3.5);
}

TEST_P(GuardProcessTest, SignsLikeProgram) {
  const std::string key = folder_.Write("key", std::string(64, 'a'));
  std::filesystem::permissions(key, std::filesystem::perms::owner_read);
  Start(-1, key);
  AwaitDescent();
  program_->Signal(SIGKILL);
  ExpectStopped(Watch(4));
}

TEST_P(GuardProcessTest, NextFlightWaitsForWorkingGuard) {
  Start();
  AwaitDescent();
  program_->Signal(SIGKILL);
  Watch(0.3);
  GuardLink next(url_, {.program = KESTREL_GUARD}, "");
  EXPECT_EQ(next.state(), GuardState::kWaits);
  std::array<std::uint8_t, 4096> buffer;
  EXPECT_TRUE(Eventually([&] {
    next.Receive(std::chrono::milliseconds(1), buffer);
    return next.state() == GuardState::kWatches;
  }));
  EXPECT_TRUE(IsIn(FlightMode::kHold));
}

}  // namespace
}  // namespace kestrel
