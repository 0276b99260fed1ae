// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/comms/mavlink/zoom_reports.h"

#include "kestrel/comms/mavlink/autopilot_status.h"
#include "kestrel/comms/mavlink/camera_messages.h"
#include "kestrel/comms/mavlink/mavlink_enums.h"
#include "kestrel/core/geometry/angles.h"

namespace kestrel {
namespace {

int DeviceOf(int reported, const mavlink::Packet& packet) {
  return reported > 0 && reported <= mavlink::kLastDeviceBehindAutopilot ? reported
                                                                         : packet.component;
}

}  // namespace

bool ZoomReports::IsWanted(int device_id) {
  if (wanted_ != 0 && device_id != wanted_) return false;
  if (device_id_ == 0) device_id_ = device_id;
  return device_id == device_id_;
}

std::optional<ZoomSample> ZoomReports::Handle(const mavlink::Packet& packet, Time received,
                                              std::uint8_t autopilot, const TimeSync& clock) {
  if (const auto stream = packet.As<mavlink::VideoStreamInformation>()) {
    if (has_fov_status_ || stream->hfov == 0) return std::nullopt;
    if (!IsWanted(DeviceOf(stream->camera_device_id, packet))) return std::nullopt;
    return ZoomSample{received, Radians(stream->hfov)};
  }
  const auto status = packet.As<mavlink::CameraFovStatus>();
  if (!status || !(status->hfov > 0)) return std::nullopt;
  if (!IsWanted(DeviceOf(status->camera_device_id, packet))) return std::nullopt;
  has_fov_status_ = true;
  const std::int64_t remote_ns = NanosecondsOfBoot(status->time_boot_ms);
  if (packet.component != autopilot) own_clock_.AddOneWay(remote_ns, received);
  const TimeSync& its_clock = packet.component == autopilot ? clock : own_clock_;
  if (!its_clock.is_known()) return std::nullopt;
  return ZoomSample{its_clock.ToLocal(remote_ns), Radians(static_cast<double>(status->hfov))};
}

}  // namespace kestrel
