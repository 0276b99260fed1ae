// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "kestrel/comms/guard/flight_guard.h"
#include "kestrel/comms/guard/guard_exchange.h"
#include "kestrel/comms/guard/life_of.h"
#include "kestrel/comms/mavlink/mavlink_enums.h"
#include "kestrel/comms/mavlink/packet_parser.h"
#include "kestrel/comms/mavlink/packet_writer.h"
#include "kestrel/core/camera/calibration.h"
#include "kestrel/flight/onboard/pointed_gimbal.h"
#include "kestrel/flight/onboard/set_point_flight.h"
#include "kestrel/simulation/autopilots/test_autopilot.h"

namespace kestrel {

// A simulated autopilot, and over MAVLink all of Kestrel that flies but for the vision: guidance,
// and the pointed gimbal where the camera is on one. In simulated time.
class LinkedFlight : public TestAutopilot {
 public:
  void Fly(double seconds) {
    Run(seconds, [this] { Step(); });
  }

  // A message of a ground station.
  void SendFromGround(const CompanionMessage& message) { model.Handle(message, 255, 190, now); }
  void GiveControl(std::uint8_t system, std::uint8_t component) {
    mavlink::CommandLong command;
    command.target_system = 1;
    command.command = mavlink::kCommandGimbalConfigure;
    command.param1 = system;
    command.param2 = component;
    SendFromGround(command);
  }

  // From now on Kestrel is killed, or hangs: the guard is alone with the autopilot.
  void Kill() {
    is_alive_ = false;
    guard_.TakeEnd();
  }
  void Hang() { is_alive_ = false; }
  const std::vector<FlightMode>& modes_by_guard() const { return modes_by_guard_; }

  int set_points = 0;  // sent to the gimbal
  int refusals = 0;    // of modes and set-points by the autopilot, since Kestrel is gone
  std::string reported;
  bool hides_landed_state = false;  // the autopilot does not report whether it flies

 protected:
  LinkedFlight(AutopilotFirmware firmware, const AutopilotModelOptions& options,
               const VehicleWorldOptions& vehicle, std::uint64_t seed,
               const CameraCalibration& camera)
      : LinkedFlight(firmware, options, &TestWorld(vehicle), seed, camera) {}
  LinkedFlight(AutopilotFirmware firmware, const AutopilotModelOptions& options,
               VehicleWorld* own_world, std::uint64_t seed, const CameraCalibration& camera)
      : TestAutopilot(firmware, options, own_world, seed),
        camera_(camera),
        connection_("udpout://127.0.0.1:9", {},
                    [this](std::span<const std::uint8_t> frame, Time) { Carry(frame); }),
        autopilot_(LinkOptions(camera.gimbal.has_value()), &connection_, Listener()) {}
  ~LinkedFlight() = default;

  // Points the gimbal at a pad; nothing: at what is marked.
  void Point(const std::optional<PadInSight>& pad, const TargetTrackerOptions& tracker) {
    pointed_.emplace(FlightOptions(), camera_, pad, tracker, &autopilot_, &connection_, Report());
  }
  void FlyBySetPoints(const FlightOptions& options, const TargetTrackerOptions& tracker,
                      const SetPointTask& task) {
    flown_.emplace(options, tracker, task, &autopilot_, &connection_, Report());
  }

  // The vision: takes and processes images, and updates the track.
  virtual void See() = 0;
  virtual void TakePose(const PoseSample& /*pose*/) {}
  virtual void TakeGimbal(const GimbalSample& /*report*/) {}

  void Step() {
    for (const AutopilotMessage& message : std::exchange(sent, {})) {
      std::visit([this](const auto& typed) { Deliver(typed); }, message);
    }
    Guard();
    if (!is_alive_) return;
    autopilot_.Tick(now);
    See();
    if (flown_) flown_->Fly(now, track_, poses_);
    if (pointed_) pointed_->Point(now, track_, poses_);
  }

  RigidTransform WorldFromCamera() const {
    const RigidTransform& body = model.truth().world_from_body;
    if (!camera_.gimbal) return body * *camera_.body_from_camera;
    const GimbalAttitude attitude{model.world_from_platform(), YawFrame::kEarth};
    return WorldFromPlatform(body, camera_.gimbal->body_from_pivot, attitude) *
           camera_.gimbal->platform_from_camera;
  }

  CameraCalibration camera_;
  PoseHistory poses_{512, std::chrono::milliseconds(500)};
  TrackSnapshot track_;
  std::optional<PointedGimbal> pointed_;
  std::optional<SetPointFlight> flown_;

 private:
  static AutopilotOptions LinkOptions(bool has_gimbal) {
    constexpr double kMode_hz = 20;
    AutopilotOptions options;
    options.mode_rate_hz = kMode_hz;
    options.wants_acceleration = true;
    options.wants_sticks = true;
    options.wants_climb = true;
    options.points_gimbal = has_gimbal;
    if (has_gimbal) options.gimbal_device_id = 0;
    return options;
  }
  AutopilotListener Listener() {
    AutopilotListener listener;
    listener.attitude = [this](const PoseSample& attitude) {
      if (flown_) flown_->TakeAttitude(attitude);
    };
    listener.acceleration = [this](Time time, const Eigen::Vector3d& acceleration) {
      if (flown_) flown_->TakeAcceleration(time, acceleration);
    };
    listener.climb = [this](double climb_mps) {
      if (flown_) flown_->TakeClimb(climb_mps);
    };
    listener.pose = [this](const PoseSample& pose) {
      if (flown_ && !flown_->TakePose(pose, now)) return;
      poses_.Add(pose);
      TakePose(pose);
    };
    listener.gimbal = [this](const GimbalSample& report) {
      if (pointed_) pointed_->TakeReport(report);
      TakeGimbal(report);
    };
    return listener;
  }
  std::function<void(const std::string&)> Report() {
    return [this](const std::string& text) { reported += text + "\n"; };
  }

  void Guard() {
    if (!flown_) return;
    if (is_alive_) {
      life_ = LifeOf(flown_->TaskOfGuard(now), autopilot_, connection_);
      guard_.TakeLife(life_.task, life_.kind, now);
    }
    const GuardAction action = guard_.Update(now);
    if (action.mode) modes_by_guard_.push_back(*action.mode);
    if (action.text != nullptr) reported += std::string(action.text) + "\n";
    SendAction(action, life_, [this](const auto& message) { Carry(guard_writer_.Write(message)); });
  }

  void Carry(std::span<const std::uint8_t> frame) {
    companion_.Parse(frame, [this](const mavlink::Packet& packet) {
      set_points += packet.id == mavlink::GimbalManagerSetPitchyaw::kId ? 1 : 0;
      if (const auto message = CompanionMessageOf(packet)) Send(*message);
    });
  }
  template <class Message>
  void Deliver(const Message& message) {
    from_autopilot_.Parse(writer_.Write(message), [this](const mavlink::Packet& packet) {
      if (hides_landed_state && packet.id == mavlink::ExtendedSysState::kId) return;
      TakePacket(packet, life_, now, &guard_);
      if (!is_alive_) return CountRefusal(packet);
      autopilot_.Handle(packet, now);
      if (pointed_) pointed_->Handle(packet);
    });
  }

  void CountRefusal(const mavlink::Packet& packet) {
    const auto ack = packet.As<mavlink::CommandAck>();
    if (ack && ack->result != mavlink::kResultAccepted) ++refusals;
  }

  mavlink::PacketParser companion_, from_autopilot_;
  mavlink::PacketWriter writer_{1, 1};
  Connection connection_;
  Autopilot autopilot_;
  FlightGuard guard_{std::chrono::milliseconds(200)};
  GuardLife life_;
  mavlink::PacketWriter guard_writer_{1, 191};
  std::vector<FlightMode> modes_by_guard_;
  bool is_alive_ = true;
};

}  // namespace kestrel
