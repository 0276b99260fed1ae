// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <variant>

#include "kestrel/comms/mavlink/autopilot_kind.h"
#include "kestrel/comms/mavlink/camera_messages.h"
#include "kestrel/comms/mavlink/global_position.h"
#include "kestrel/comms/mavlink/mavlink_enums.h"
#include "kestrel/comms/mavlink/messages.h"
#include "kestrel/comms/mavlink/target_profile.h"

namespace kestrel {

// A camera as ground stations see it.
struct CameraDescription {
  std::uint8_t component = mavlink::kComponentCamera;
  std::string model;
  int width_px = 0;
  int height_px = 0;
  double horizontal_fov_deg = std::numeric_limits<double>::quiet_NaN();
  double vertical_fov_deg = std::numeric_limits<double>::quiet_NaN();
  std::uint8_t gimbal_device_id = 0;  // as GIMBAL_DEVICE_ATTITUDE_STATUS has it; 0: no gimbal
  std::string stream_uri;             // where its video is, H.264 by RTSP; empty: there is none
  double stream_rate_hz = 0;

  bool has_stream() const { return !stream_uri.empty(); }
};

// A region of the image: shares of its width and height, from the upper left corner.
struct ImageRegion {
  double left = 0;
  double top = 0;
  double right = 0;
  double bottom = 0;
};

// The thing that the camera follows at present.
struct CameraTracking {
  enum class State { kIdle, kActive, kCoasting, kLost };

  State state = State::kIdle;
  std::optional<ImageRegion> region = {};                      // where it is, or is predicted
  std::optional<mavlink::CameraTrackingGeoStatus> place = {};  // see GeoStatusOf
};

// All messages that a camera sends.
using CameraMessage =
    std::variant<mavlink::Heartbeat, mavlink::CommandAck, mavlink::MessageInterval,
                 mavlink::CameraInformation, mavlink::CameraSettings, mavlink::CameraCaptureStatus,
                 mavlink::VideoStreamInformation, mavlink::VideoStreamStatus,
                 mavlink::CameraFovStatus, mavlink::CameraTrackingImageStatus,
                 mavlink::CameraTrackingGeoStatus>;

// The ids of those that are sent by request.
inline constexpr std::array kCameraReports = {
    mavlink::CameraInformation::kId,         mavlink::CameraSettings::kId,
    mavlink::CameraCaptureStatus::kId,       mavlink::VideoStreamInformation::kId,
    mavlink::VideoStreamStatus::kId,         mavlink::CameraFovStatus::kId,
    mavlink::CameraTrackingImageStatus::kId, mavlink::CameraTrackingGeoStatus::kId};

// Returns one of them; nothing for another id, and for a stream that is not there. 'boot_ms': time
// on the camera's clock.
std::optional<CameraMessage> CameraReportOf(std::uint32_t id, const CameraDescription& camera,
                                            const CameraTracking& tracking, std::uint32_t boot_ms);

// Returns the target's position on the Earth; CameraReportOf adds the state.
mavlink::CameraTrackingGeoStatus GeoStatusOf(const TargetState& target, AutopilotKind kind,
                                             const GlobalPosition& origin);

}  // namespace kestrel
