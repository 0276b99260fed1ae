// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>

#include "kestrel/comms/mavlink/packet.h"
#include "kestrel/comms/mavlink/time_sync.h"
#include "kestrel/core/base/time.h"
#include "kestrel/core/poses/zoom_history.h"

namespace kestrel {

// Makes samples, on the local clock, from the reports of one camera's field of view:
// CAMERA_FOV_STATUS by the clock of its sender, the autopilot or a component of its own, and
// VIDEO_STREAM_INFORMATION, whose whole degrees count as long as nothing else comes, when it
// arrives.
class ZoomReports {
 public:
  // 'device_id': the camera, 1 to 6 behind the autopilot, else its component; 0: the first one that
  // is heard.
  explicit ZoomReports(int device_id) : wanted_(device_id) {}

  // Returns the sample in a packet of the vehicle; nothing when the packet is no report, is of
  // another camera, has no field of view, or its clock is not known yet. 'autopilot' and 'clock'
  // are the component and the clock of the autopilot.
  std::optional<ZoomSample> Handle(const mavlink::Packet& packet, Time received,
                                   std::uint8_t autopilot, const TimeSync& clock);

 private:
  bool IsWanted(int device_id);

  int wanted_;
  int device_id_ = 0;            // that is used; 0: none was heard yet
  bool has_fov_status_ = false;  // VIDEO_STREAM_INFORMATION is then not needed
  TimeSync own_clock_;
};

}  // namespace kestrel
