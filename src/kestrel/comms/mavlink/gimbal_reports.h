// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>

#include "kestrel/comms/mavlink/messages.h"
#include "kestrel/comms/mavlink/packet.h"
#include "kestrel/comms/mavlink/time_sync.h"
#include "kestrel/core/base/time.h"
#include "kestrel/core/poses/gimbal_history.h"

namespace kestrel {

// Return the attitude in a report; its time is not set. Nothing where it is no rotation. The frame
// of the yaw follows from the flags: YAW_IN_VEHICLE_FRAME or YAW_IN_EARTH_FRAME; without either, as
// older gimbals send it, YAW_LOCK means the earth (MAVLink's gimbal protocol v2).
std::optional<GimbalSample> GimbalSampleOf(const mavlink::GimbalDeviceAttitudeStatus& report);
std::optional<GimbalSample> GimbalSampleOf(const mavlink::MountOrientation& report);

// Makes samples, on the local clock, from the reports of one gimbal: that of the autopilot, which
// relays them on its own clock, or of a component of its own with a clock of its own.
class GimbalReports {
 public:
  // 'device_id': the gimbal, 1 to 6 behind the autopilot, else its component; 0: the first one that
  // is heard.
  explicit GimbalReports(int device_id) : wanted_(device_id) {}

  // Returns the sample in a packet of the vehicle; nothing when the packet is no report, is of
  // another gimbal, repeats the one before, or its clock is not known yet. 'autopilot' and 'clock'
  // are the component and the clock of the autopilot.
  std::optional<GimbalSample> Handle(const mavlink::Packet& packet, Time received,
                                     std::uint8_t autopilot, const TimeSync& clock);

  // The gimbal that is used; 0: none was heard yet.
  int device_id() const { return device_id_; }

 private:
  bool IsWanted(int device_id);
  bool IsRepeated(const GimbalSample& sample);

  int wanted_;
  int device_id_ = 0;
  bool has_new_reports_ = false;  // MOUNT_ORIENTATION is then not needed
  std::optional<GimbalSample> newest_;
  TimeSync own_clock_;
};

}  // namespace kestrel
