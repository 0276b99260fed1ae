// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/simulation/autopilots/simulated_autopilot.h"

#include <algorithm>
#include <chrono>
#include <variant>

#include "kestrel/comms/mavlink/link_url.h"
#include "kestrel/comms/mavlink/mavlink_enums.h"
#include "kestrel/comms/mavlink/transport.h"
#include "kestrel/core/base/options.h"

namespace kestrel {
namespace {

constexpr const char* kPx4Name = "px4";

AutopilotFirmware FirmwareOf(const std::string& name) {
  return name == kPx4Name ? AutopilotFirmware::kPx4 : AutopilotFirmware::kArduPilot;
}

ConnectionOptions ConnectionOf(const SimulatedAutopilotOptions& options) {
  ConnectionOptions connection;
  connection.system_id = options.model.system_id;
  connection.component_id = mavlink::kComponentAutopilot;
  connection.signing_key = options.signing_key;
  return connection;
}

}  // namespace

SimulatedAutopilot::SimulatedAutopilot(const SimulatedAutopilotOptions& options,
                                       const std::string& url, VehicleWorld* world,
                                       std::uint64_t seed)
    : url_(url),
      link_(options.link),
      start_(Now()),
      connection_(url, ConnectionOf(Checked(options))),
      random_(seed),
      outgoing_(options.link, Random(random_.Bits())),
      incoming_(options.link, Random(random_.Bits())),
      model_(FirmwareOf(options.firmware), options.model, world, start_, random_.Bits(),
             [this](const AutopilotMessage& message) { outgoing_.Push(Now(), message); }) {}

void SimulatedAutopilot::Start() {
  stops_ = false;
  thread_ = std::thread([this] {
    constexpr Duration kWait = std::chrono::milliseconds(2);
    while (!stops_) Step(kWait);
  });
}

void SimulatedAutopilot::Stop() {
  stops_ = true;
  if (thread_.joinable()) thread_.join();
}

void SimulatedAutopilot::Step(Duration wait) {
  connection_.Receive(wait, [this](const mavlink::Packet& packet, Time received) {
    const auto message = CompanionMessageOf(packet);
    if (message) incoming_.Push(received, {*message, packet.system, packet.component});
  });
  const bool is_down = is_link_down_ || link_.IsDown(ToSeconds(Now() - start_));
  {
    const Time now = Now();
    const std::lock_guard lock(mutex_);
    while (const auto received = incoming_.Pop(now)) {
      if (is_down) continue;
      model_.Handle(received->message, received->system, received->component, now);
    }
    model_.Step(now);
  }
  const Time now = Now();
  while (const auto message = outgoing_.Pop(now)) {
    if (is_down) continue;
    std::visit([this](const auto& typed) { connection_.Send(typed); }, *message);
  }
}

SitlResult SimulatedAutopilot::result() const {
  const std::lock_guard lock(mutex_);
  return model_.result();
}

PoseSample SimulatedAutopilot::truth() const {
  const std::lock_guard lock(mutex_);
  return model_.truth();
}

bool SimulatedAutopilot::is_armed() const {
  const std::lock_guard lock(mutex_);
  return model_.is_armed();
}

std::uint32_t SimulatedAutopilot::custom_mode() const {
  const std::lock_guard lock(mutex_);
  return model_.custom_mode();
}

void SimulatedAutopilot::SetNanAttitude(bool nan) {
  const std::lock_guard lock(mutex_);
  model_.set_nan_attitude(nan);
}

void SimulatedAutopilot::Reboot() {
  const std::lock_guard lock(mutex_);
  model_.Reboot(Now());
}

void SimulatedAutopilot::JumpClock(Duration change) {
  const std::lock_guard lock(mutex_);
  model_.JumpClock(change);
}

void SimulatedAutopilot::SendGarbage(std::size_t bytes) {
  constexpr std::size_t kDatagram = 1000;
  const auto transport = OpenTransport(ParseLinkUrl(url_));
  Random random(bytes);
  std::vector<std::uint8_t> garbage;
  for (; bytes > 0; bytes -= garbage.size()) {
    garbage.resize(std::min(bytes, kDatagram));
    for (std::uint8_t& byte : garbage) byte = static_cast<std::uint8_t>(random.Bits());
    transport->Send(garbage);
  }
}

}  // namespace kestrel
