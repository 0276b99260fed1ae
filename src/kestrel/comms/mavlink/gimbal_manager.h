// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include "kestrel/comms/mavlink/autopilot.h"
#include "kestrel/comms/mavlink/connection.h"
#include "kestrel/comms/mavlink/messages.h"
#include "kestrel/comms/mavlink/packet.h"
#include "kestrel/core/base/time.h"
#include "kestrel/core/poses/gimbal_angles.h"

namespace kestrel {

// The gimbal manager of an autopilot (mavlink.io/en/services/gimbal_v2), as this program uses it:
// requests primary control, sends attitudes, and notices when somebody else takes the gimbal. It is
// then left alone until control comes back or is requested again. Used by the link's thread only.
class GimbalManager {
 public:
  enum class Control {
    kNone,       // not requested
    kRequested,  // until the manager reports it
    kOwn,
    kTaken,  // somebody else moves the gimbal
  };

  // 'device_id': see GimbalReports. The autopilot and its connection must outlive this.
  GimbalManager(int device_id, Autopilot* autopilot, Connection* connection)
      : device_id_(device_id), autopilot_(*autopilot), connection_(*connection) {}

  // Takes a packet of the link.
  void Handle(const mavlink::Packet& packet);
  // Sends what is due at 'now': requests of control, and of the range of motion.
  void Tick(Time now);

  // Requests primary control.
  void TakeControl();
  // Leaves the gimbal to 'who', in words.
  void Yield(const std::string& who);

  // Sends the attitude to take, with the yaw in the world (ENU). No effect without control.
  void Send(const GimbalAngles& attitude);

  Control control() const { return control_; }
  // Who moves the gimbal, in words; while control is taken.
  const std::string& taken_by() const { return taken_by_; }
  // As the manager reports it; PX4 reports the half circle and the full one for every gimbal.
  const std::optional<GimbalRange>& range() const { return range_; }
  // The newest one since control was requested last.
  const std::optional<mavlink::GimbalManagerStatus>& status() const { return status_; }

 private:
  static constexpr std::size_t kChannels = 18;
  using Channels = std::array<std::uint16_t, kChannels>;

  void HandleStatus(const mavlink::GimbalManagerStatus& status);
  void HandleInformation(const mavlink::GimbalManagerInformation& information);
  void HandleChannels(const mavlink::RcChannels& message);
  bool IsStick(std::size_t channel) const;
  void WantStickOptions();
  void SendCommand(std::uint16_t command, const std::array<float, 4>& parameters, float last);

  int device_id_;
  Autopilot& autopilot_;
  Connection& connection_;
  Control control_ = Control::kNone;
  std::string taken_by_;
  std::optional<GimbalRange> range_;
  std::optional<mavlink::GimbalManagerStatus> status_;
  bool is_reported_own_ = false;    // by the newest status
  bool wants_options_ = false;      // the parameters that name the sticks are requested
  std::optional<Channels> sticks_;  // when control was taken
  Time request_due_{};
  int information_requests_ = 0;
};

}  // namespace kestrel
