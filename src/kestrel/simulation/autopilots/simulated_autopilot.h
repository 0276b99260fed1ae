// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <string>
#include <thread>

#include "kestrel/comms/mavlink/connection.h"
#include "kestrel/core/base/limits.h"
#include "kestrel/core/base/random.h"
#include "kestrel/core/base/time.h"
#include "kestrel/simulation/autopilot_rules/autopilot_parameters.h"
#include "kestrel/simulation/autopilots/autopilot_messages.h"
#include "kestrel/simulation/autopilots/autopilot_model.h"
#include "kestrel/simulation/autopilots/link_faults.h"
#include "kestrel/simulation/autopilots/vehicle_world.h"

namespace kestrel {

struct SimulatedAutopilotOptions {
  std::string firmware = "ardupilot";
  AutopilotModelOptions model;
  LinkFaultOptions link;
  std::string signing_key;

  static void Visit(auto& self, auto&& visit) {
    visit("firmware", self.firmware, OneOf{{"ardupilot", "px4"}}, "simulated firmware");
    visit("signing_key", self.signing_key, "file with the key of signed packets");
    visit.Group(self.model);
    visit.Group("link", self.link);
  }
};

// A simulated UAV behind real MAVLink: an autopilot that flies in real time, on the clock of Now().
// It shares only the socket with its companion, and the vehicle below. Any thread may call all
// functions but Start, Stop and Step.
class SimulatedAutopilot {
 public:
  // 'url': its line, as udpout://127.0.0.1:14550 (where the companion listens). The world must
  // outlive this. Throws InputError when the options or the URL are not valid.
  SimulatedAutopilot(const SimulatedAutopilotOptions& options, const std::string& url,
                     VehicleWorld* world, std::uint64_t seed);
  ~SimulatedAutopilot() { Stop(); }
  SimulatedAutopilot(const SimulatedAutopilot&) = delete;
  SimulatedAutopilot& operator=(const SimulatedAutopilot&) = delete;

  // Between Start and Stop a thread of its own calls Step.
  void Start();
  void Stop();

  // Waits up to 'wait' for messages, and flies on to the present time.
  void Step(Duration wait);

  SitlResult result() const;
  PoseSample truth() const;
  bool is_armed() const;
  std::uint32_t custom_mode() const;

  // Faults, in addition to those of the options.
  void set_link_down(bool down) {
    is_link_down_ = down;
  }  // as by the options, until it is up again
  void SetNanAttitude(bool nan);
  void Reboot();
  void JumpClock(Duration change);
  void SendGarbage(std::size_t bytes);  // from a port of its own

 private:
  struct Received {
    CompanionMessage message;
    std::uint8_t system;
    std::uint8_t component;
  };

  std::string url_;
  LinkFaultOptions link_;
  Time start_;
  std::atomic<bool> is_link_down_ = false;
  std::atomic<bool> stops_ = false;
  Connection connection_;
  Random random_;
  DelayLine<AutopilotMessage> outgoing_;
  DelayLine<Received> incoming_;
  mutable std::mutex mutex_;  // guards the model
  AutopilotModel model_;
  std::thread thread_;
};

}  // namespace kestrel
