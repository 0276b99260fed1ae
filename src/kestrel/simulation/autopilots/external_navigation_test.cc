// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/simulation/autopilots/external_navigation.h"

#include <gtest/gtest.h>

#include "kestrel/comms/mavlink/mavlink_enums.h"
#include "kestrel/simulation/autopilots/test_autopilot.h"

namespace kestrel {
namespace {

AutopilotModelOptions WithoutGnss(const std::string& parameters) {
  AutopilotModelOptions options;
  options.estimate.has_gnss = false;
  options.parameters = parameters;
  options.pilot.land_after_s = -1;
  return options;
}

// An autopilot that gets its true place as ODOMETRY, 20 times a second.
class ExternalFlight : public TestAutopilot {
 public:
  ExternalFlight(AutopilotFirmware firmware, const std::string& parameters)
      : TestAutopilot(firmware, WithoutGnss(parameters), TestVehicle("standing", 0)) {
    constexpr float kEach_us = 20000;
    mavlink::CommandLong command;
    command.target_system = 1;
    command.command = mavlink::kCommandSetMessageInterval;
    command.param1 = mavlink::LocalPositionNed::kId;
    command.param2 = kEach_us;
    Send(command);
  }

  void Fly(double seconds, std::uint8_t frame = mavlink::kFrameLocalFrd, bool sends = true) {
    int steps = 0;
    Run(seconds, [&] {
      if (sends && ++steps % 3 == 0) SendPlace(frame);
    });
  }
  int PositionsDuring(double seconds, std::uint8_t frame = mavlink::kFrameLocalFrd,
                      bool sends = true) {
    sent.clear();
    Fly(seconds, frame, sends);
    return static_cast<int>(Sent<mavlink::LocalPositionNed>().size());
  }

 private:
  void SendPlace(std::uint8_t frame) {
    const Eigen::Vector3f place =
        NedFromEnu(model.truth().world_from_body.translation).cast<float>();
    mavlink::Odometry message;
    message.time_usec = static_cast<std::uint64_t>(model.OwnTime(now) / 1000 - 20000);
    message.frame_id = frame;
    message.child_frame_id = mavlink::kFrameBodyFrd;
    message.x = place.x();
    message.y = place.y();
    message.z = place.z();
    Send(message);
  }
};

constexpr char kArduPilotUses[] = "VISO_TYPE=1,EK3_SRC1_POSXY=6";
constexpr char kPx4Uses[] = "EKF2_EV_CTRL=11";

TEST(ExternalNavigation, IsUsedWithParametersAndFrame) {
  const auto positions = [](AutopilotFirmware firmware, const char* parameters,
                            std::uint8_t frame) {
    return ExternalFlight(firmware, parameters).PositionsDuring(2, frame);
  };
  const auto kArduPilot = AutopilotFirmware::kArduPilot;
  EXPECT_GT(positions(kArduPilot, kArduPilotUses, mavlink::kFrameLocalFrd), 50);
  EXPECT_EQ(positions(kArduPilot, kArduPilotUses, mavlink::kFrameLocalNed), 0);
  EXPECT_EQ(positions(kArduPilot, "VISO_TYPE=1", mavlink::kFrameLocalFrd), 0);
  EXPECT_GT(positions(AutopilotFirmware::kPx4, kPx4Uses, mavlink::kFrameLocalFrd), 50);
  EXPECT_GT(positions(AutopilotFirmware::kPx4, kPx4Uses, mavlink::kFrameLocalNed), 50);
  EXPECT_EQ(positions(AutopilotFirmware::kPx4, "", mavlink::kFrameLocalFrd), 0);
}

TEST(ExternalNavigation, HoldsForSecondsWithoutMessages) {
  for (const auto& [firmware, parameters, holds_s] :
       {std::tuple(AutopilotFirmware::kArduPilot, kArduPilotUses, 7),
        std::tuple(AutopilotFirmware::kPx4, kPx4Uses, 5)}) {
    ExternalFlight flight(firmware, parameters);
    flight.Fly(2);
    const int positions = flight.PositionsDuring(20, mavlink::kFrameLocalFrd, false);
    EXPECT_NEAR(positions / 50.0, holds_s, 0.3);
  }
}

}  // namespace
}  // namespace kestrel
