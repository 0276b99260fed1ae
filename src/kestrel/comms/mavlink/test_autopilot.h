// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "kestrel/comms/mavlink/autopilot.h"
#include "kestrel/comms/mavlink/mavlink_enums.h"
#include "kestrel/comms/mavlink/packet_parser.h"
#include "kestrel/comms/mavlink/packet_writer.h"

namespace kestrel {

// A scripted autopilot with a clock of its own, at the other end of a line that takes 2 ms each
// way. Time is simulated.
class AutopilotTest : public testing::Test {
 protected:
  void Start(const AutopilotOptions& options = {}, const ConnectionOptions& connection = {}) {
    connection_ =
        std::make_unique<Connection>("udpout://127.0.0.1:9", connection, [this](auto frame, Time) {
          parser_.Parse(frame, [this](const auto& packet) { Hear(packet); });
        });
    autopilot_ = std::make_unique<Autopilot>(
        options, connection_.get(),
        AutopilotListener{
            .pose = [this](const PoseSample& pose) { poses_.push_back(pose); },
            .true_pose = [this](const PoseSample& pose) { true_poses_.push_back(pose); },
            .event = [this](const AutopilotEvent& event) { events_.push_back(event); },
            .text = [this](std::uint8_t, std::string_view text) { texts_.emplace_back(text); },
            .gimbal = [this](const GimbalSample& sample) { gimbal_.push_back(sample); },
            .zoom = [this](const ZoomSample& sample) { zoom_.push_back(sample); },
            .attitude = [this](const PoseSample& pose) { attitudes_.push_back(pose); },
            .acceleration =
                [this](Time, const Eigen::Vector3d& acceleration) {
                  accelerations_.push_back(acceleration);
                }});
  }

  // Receives Kestrel's packets.
  void Hear(const mavlink::Packet& packet) {
    ++heard_[packet.id];
    last_heard_[packet.id] = packet;
    if (const auto question = packet.As<mavlink::Timesync>(); question && answers_timesync_) {
      if (question->tc1 == 0) {
        const Time requested = TimeFromNanoseconds(question->ts1);
        mavlink::Timesync answer;
        answer.tc1 = RemoteAt(requested + std::chrono::milliseconds(2));
        answer.ts1 = question->ts1;
        due_.push_back({requested + std::chrono::milliseconds(4), answer});
      }
    }
    const auto command = packet.As<mavlink::CommandLong>();
    if (command && command->command == mavlink::kCommandSetMessageInterval) {
      intervals_us_[static_cast<std::uint32_t>(command->param1)] = command->param2;
    }
  }

  std::int64_t RemoteAt(Time time) const { return (time - boot_).count(); }
  std::uint32_t BootMs() const { return static_cast<std::uint32_t>(RemoteAt(now_) / 1'000'000); }

  template <class Message>
  void SendMessage(const Message& message, int system = 1, int component = 1) {
    mavlink::PacketWriter& writer =
        writers_.try_emplace({system, component}, system, component).first->second;
    mavlink::PacketParser parser;
    parser.Parse(writer.Write(message),
                 [&](const mavlink::Packet& packet) { autopilot_->Handle(packet, now_); });
  }
  void SendHeartbeat(std::uint8_t autopilot = mavlink::kAutopilotArduPilot,
                     std::uint32_t mode = 4) {
    SendMessage(mavlink::Heartbeat{mavlink::kTypeQuadrotor, autopilot, mavlink::kModeFlagArmed,
                                   mode, 4, 3});
  }
  // Sends attitude and position: 3 m north, 1 m east, 5 m up, moving at 2 m/s east, heading east.
  void SendPose() {
    mavlink::LocalPositionNed position;
    position.time_boot_ms = BootMs();
    position.x = 3;
    position.y = 1;
    position.z = -5;
    position.vy = 2;
    SendMessage(position);
    SendMessage(AttitudeAt(BootMs() + 100));
  }
  mavlink::AttitudeQuaternion AttitudeAt(std::uint32_t boot_ms) const {
    mavlink::AttitudeQuaternion attitude;
    attitude.time_boot_ms = boot_ms;
    attitude.q1 = attitude.q4 = static_cast<float>(std::sqrt(0.5));
    attitude.rollspeed = 0.1f;
    attitude.pitchspeed = 0.2f;
    attitude.yawspeed = 0.3f;
    return attitude;
  }

  // Time passes in steps of 10 ms; what is due is sent, TIMESYNC is answered.
  void Pass(double seconds, bool has_heartbeat = true) {
    for (int i = 0; i < std::lround(100 * seconds); ++i) {
      now_ += std::chrono::milliseconds(10);
      if (has_heartbeat && i % 100 == 0) SendHeartbeat(kind_, mode_);
      const auto due = std::exchange(due_, {});
      for (const auto& [time, answer] : due) {
        if (time <= now_) {
          const Time now = std::exchange(now_, time);
          SendMessage(answer);
          now_ = now;
        } else {
          due_.push_back({time, answer});
        }
      }
      autopilot_->Tick(now_);
    }
  }
  int EventsOf(AutopilotEventKind kind) const {
    return static_cast<int>(std::count_if(events_.begin(), events_.end(),
                                          [&](const auto& event) { return event.kind == kind; }));
  }
  std::string TextOfEvent(AutopilotEventKind kind) const {
    for (const auto& event : events_) {
      if (event.kind == kind) return event.text;
    }
    return "";
  }

  Time now_ = TimeFromNanoseconds(1'000'000'000'000);
  Time boot_ = TimeFromNanoseconds(900'000'000'000);
  std::uint8_t kind_ = mavlink::kAutopilotArduPilot;
  std::uint32_t mode_ = 4;
  bool answers_timesync_ = true;
  std::unique_ptr<Connection> connection_;
  std::unique_ptr<Autopilot> autopilot_;
  mavlink::PacketParser parser_;
  std::map<std::pair<int, int>, mavlink::PacketWriter> writers_;
  std::map<std::uint32_t, int> heard_;
  std::map<std::uint32_t, mavlink::Packet> last_heard_;
  std::map<std::uint32_t, double> intervals_us_;
  std::vector<std::pair<Time, mavlink::Timesync>> due_;
  std::vector<PoseSample> poses_;
  std::vector<PoseSample> true_poses_;
  std::vector<GimbalSample> gimbal_;
  std::vector<PoseSample> attitudes_;
  std::vector<Eigen::Vector3d> accelerations_;
  std::vector<ZoomSample> zoom_;
  std::vector<AutopilotEvent> events_;
  std::vector<std::string> texts_;
};

}  // namespace kestrel
