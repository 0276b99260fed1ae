// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include <Eigen/Geometry>

#include "kestrel/comms/mavlink/mavlink_enums.h"
#include "kestrel/comms/mavlink/messages.h"
#include "kestrel/comms/mavlink/ned.h"
#include "kestrel/core/base/time.h"
#include "kestrel/simulation/autopilots/autopilot_model.h"
#include "kestrel/simulation/autopilots/vehicle_world.h"

namespace kestrel {

inline constexpr Time kTestStart = TimeFromNanoseconds(50'000'000'000);

// A vehicle of a scenario that drives from the beginning.
inline VehicleWorldOptions TestVehicle(const std::string& path, double speed_mps) {
  VehicleWorldOptions options = ReadVehicleWorld(path, {});
  options.drive_altitude_m = 0;
  options.vehicle.speed_mps = speed_mps;
  options.ground.map_px = 64;  // it is not rendered
  return options;
}

// The world of such a vehicle, which does not change: made once, because its paint takes a while.
inline VehicleWorld& TestWorld(const VehicleWorldOptions& vehicle) {
  static std::map<std::pair<std::string, double>, VehicleWorld> worlds;
  return worlds
      .try_emplace({vehicle.vehicle.path, vehicle.vehicle.speed_mps}, vehicle, kTestStart,
                   /*seed=*/1)
      .first->second;
}

// A simulated autopilot on a clock that runs as fast as possible, with a companion that knows the
// truth.
class TestAutopilot {
 public:
  TestAutopilot(AutopilotFirmware firmware, const AutopilotModelOptions& options,
                const VehicleWorldOptions& vehicle, std::uint64_t seed = 1)
      : TestAutopilot(firmware, options, &TestWorld(vehicle), seed) {}
  // The world must outlive this.
  TestAutopilot(AutopilotFirmware firmware, const AutopilotModelOptions& options,
                VehicleWorld* own_world, std::uint64_t seed)
      : world(*own_world),
        model(firmware, options, &world, kTestStart, seed,
              [this](const AutopilotMessage& message) { sent.push_back(message); }) {}

  void Send(const CompanionMessage& message) {
    constexpr std::uint8_t kOnboardComputer = 191;
    model.Handle(message, 1, kOnboardComputer, now);
  }

  static constexpr double kStep_s = 0.02;

  // Continues for 'seconds'; 'act' is called every kStep_s.
  template <class Act>
  void Run(double seconds, Act&& act) {
    const Time end = now + DurationFromSeconds(seconds);
    while (now < end) {
      now += DurationFromSeconds(kStep_s);
      model.Step(now);
      act();
    }
  }
  void Run(double seconds) {
    Run(seconds, [] {});
  }

  // Returns the messages of one kind that it has sent so far.
  template <class Message>
  std::vector<Message> Sent() const {
    std::vector<Message> messages;
    for (const AutopilotMessage& message : sent) {
      if (const auto* typed = std::get_if<Message>(&message)) messages.push_back(*typed);
    }
    return messages;
  }
  int CountText(std::string_view text) const {
    int count = 0;
    for (const auto& message : Sent<mavlink::Statustext>()) {
      count += TextOf(message.text).find(text) != std::string_view::npos ? 1 : 0;
    }
    return count;
  }

  // True vector from the body to the pattern, in FLU.
  Eigen::Vector3d PatternInBody() const {
    return model.truth().world_from_body.Inverse() * world.PatternAt(now).translation;
  }

  // Horizontal distance of the UAV from the pattern, m.
  double HorizontalError() const {
    const Eigen::Vector3d way =
        world.PatternAt(now).translation - model.truth().world_from_body.translation;
    return way.head<2>().norm();
  }

  // Messages of the profiles, made from the truth. In contact the point stays below the body.
  mavlink::LandingTarget ArduPilotTargetMessage() const {
    Eigen::Vector3d in_frd = FrdFromFlu(PatternInBody());
    in_frd.z() = std::max(in_frd.z(), 0.2);
    mavlink::LandingTarget message = At(in_frd);
    message.frame = mavlink::kFrameBodyFrd;
    message.distance = static_cast<float>(in_frd.norm());
    return message;
  }
  mavlink::LandingTarget Px4TargetMessage() const {
    mavlink::LandingTarget message = At(NedFromEnu(world.PatternAt(now).translation));
    message.frame = mavlink::kFrameLocalNed;
    return message;
  }
  mavlink::TargetRelative RelativeMessage() const {
    const Eigen::Vector3f in_frd = FrdFromFlu(PatternInBody()).cast<float>();
    mavlink::TargetRelative message;
    message.timestamp = static_cast<std::uint64_t>(model.OwnTime(model.truth().time) / 1000);
    message.frame = mavlink::kTargetFrameBodyFrd;
    message.x = in_frd.x();
    message.y = in_frd.y();
    message.z = in_frd.z();
    message.pos_std = {0.05f, 0.05f, 0.05f};
    message.type = mavlink::kTargetTypeVisionFiducial;
    return message;
  }

  VehicleWorld& world;
  std::vector<AutopilotMessage> sent;
  AutopilotModel model;
  Time now = kTestStart;

 private:
  static mavlink::LandingTarget At(const Eigen::Vector3d& point) {
    mavlink::LandingTarget message;
    message.x = static_cast<float>(point.x());
    message.y = static_cast<float>(point.y());
    message.z = static_cast<float>(point.z());
    message.q = {1, 0, 0, 0};
    message.type = mavlink::kTargetTypeVisionOther;
    message.position_valid = 1;
    return message;
  }
};

}  // namespace kestrel
