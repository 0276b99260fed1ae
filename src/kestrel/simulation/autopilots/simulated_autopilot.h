// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "kestrel/comms/autopilot_rules/autopilot_parameters.h"
#include "kestrel/comms/mavlink/connection.h"
#include "kestrel/core/base/random.h"
#include "kestrel/core/base/time.h"
#include "kestrel/simulation/autopilots/autopilot_messages.h"
#include "kestrel/simulation/autopilots/autopilot_model.h"
#include "kestrel/simulation/autopilots/link_faults.h"
#include "kestrel/simulation/autopilots/vehicle_world.h"

namespace kestrel {

struct SimulatedAutopilotOptions {
  std::string firmware = "ardupilot";  // ardupilot or px4
  AutopilotModelOptions model;
  LinkFaultOptions link;
  std::string signing_key;  // as of ConnectionOptions

  template <class Self, class Visitor>
  static void Visit(Self& self, Visitor&& visitor) {
    visitor("firmware", self.firmware, "", "ardupilot or px4");
    visitor("signing_key", self.signing_key, "", "file with the key of signed packets");
    AutopilotModelOptions::Visit(self.model, visitor);
    visitor.Group("link", self.link);
  }
  std::vector<std::string> Validate() const;
};

// A simulated UAV behind real MAVLink: an autopilot that flies in real time, on the clock of Now().
// The socket is all that it shares with who talks to it, and the vehicle below. All but Start, Stop
// and Step may be called from any thread.
class SimulatedAutopilot {
 public:
  // 'url': where its line goes, as udpout://127.0.0.1:14550 (the companion listens there). The
  // world must outlive it. Throws InputError when the options or the URL are not valid.
  SimulatedAutopilot(const SimulatedAutopilotOptions& options, const std::string& url,
                     VehicleWorld* world, std::uint64_t seed);
  ~SimulatedAutopilot() { Stop(); }
  SimulatedAutopilot(const SimulatedAutopilot&) = delete;
  SimulatedAutopilot& operator=(const SimulatedAutopilot&) = delete;

  // A thread of its own calls Step until Stop.
  void Start();
  void Stop();

  // Waits up to 'wait' for messages and flies on to the time that it is then.
  void Step(Duration wait);

  SitlResult result() const;
  PoseSample truth() const;
  bool is_armed() const;
  std::uint32_t custom_mode() const;

  // Faults, besides those of the options.
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
  mutable std::mutex mutex_;  // of the model
  AutopilotModel model_;
  std::thread thread_;
};

}  // namespace kestrel
