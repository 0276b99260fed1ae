// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/comms/mavlink/camera_reports.h"

#include <algorithm>
#include <cmath>
#include <string_view>

#include "kestrel/comms/mavlink/ned.h"

namespace kestrel {
namespace {

constexpr float kNotKnown = std::numeric_limits<float>::quiet_NaN();
constexpr std::int32_t kNoPlace = std::numeric_limits<std::int32_t>::max();
constexpr std::uint8_t kStream = 1;  // the only one

// Writes a text, truncated, with a zero at its end.
void WriteText(std::string_view text, auto* field) {
  text = text.substr(0, field->size() - 1);
  std::copy(text.begin(), text.end(), field->begin());
}

std::uint16_t WholeDegrees(double angle_deg) {
  constexpr double kFull = 360;
  return angle_deg > 0 ? static_cast<std::uint16_t>(std::lround(std::min(angle_deg, kFull))) : 0;
}

std::uint8_t StatusOf(CameraTracking::State state) {
  switch (state) {
    case CameraTracking::State::kIdle:
      return 0;
    case CameraTracking::State::kActive:
      return mavlink::kTrackingActive;
    case CameraTracking::State::kCoasting:
      return mavlink::kTrackingActive | mavlink::kTrackingCoasting;
    case CameraTracking::State::kLost:
      return mavlink::kTrackingError;
  }
  return 0;
}

mavlink::CameraInformation InformationOf(const CameraDescription& camera, std::uint32_t boot_ms) {
  mavlink::CameraInformation message;
  message.time_boot_ms = boot_ms;
  WriteText("Kestrel", &message.vendor_name);
  WriteText(camera.model, &message.model_name);
  message.focal_length = message.sensor_size_h = message.sensor_size_v = kNotKnown;
  message.resolution_h = static_cast<std::uint16_t>(camera.width_px);
  message.resolution_v = static_cast<std::uint16_t>(camera.height_px);
  message.flags =
      mavlink::kCameraTracksPoint | mavlink::kCameraTracksRectangle | mavlink::kCameraTracksOnEarth;
  if (camera.has_stream()) message.flags |= mavlink::kCameraHasStream;
  message.gimbal_device_id = camera.gimbal_device_id;
  return message;
}

mavlink::CameraSettings SettingsAt(std::uint32_t boot_ms) {
  mavlink::CameraSettings message;
  message.time_boot_ms = boot_ms;
  message.mode_id = mavlink::kCameraModeVideo;
  message.zoom_level = message.focus_level = kNotKnown;
  return message;
}

mavlink::CameraCaptureStatus CaptureStatusAt(std::uint32_t boot_ms) {
  mavlink::CameraCaptureStatus message;
  message.time_boot_ms = boot_ms;
  return message;
}

// Fills the fields that information and status of the stream share.
template <class Message>
Message StreamOf(const CameraDescription& camera) {
  Message message;
  message.stream_id = kStream;
  message.flags = mavlink::kStreamIsRunning;
  message.framerate = static_cast<float>(camera.stream_rate_hz);
  message.resolution_h = static_cast<std::uint16_t>(camera.width_px);
  message.resolution_v = static_cast<std::uint16_t>(camera.height_px);
  message.hfov = WholeDegrees(camera.horizontal_fov_deg);
  return message;
}

mavlink::VideoStreamInformation StreamInformationOf(const CameraDescription& camera) {
  auto message = StreamOf<mavlink::VideoStreamInformation>(camera);
  message.count = 1;
  message.encoding = mavlink::kStreamH264;
  WriteText("Kestrel", &message.name);
  WriteText(camera.stream_uri, &message.uri);
  return message;
}

mavlink::CameraFovStatus FieldOfViewOf(const CameraDescription& camera, std::uint32_t boot_ms) {
  mavlink::CameraFovStatus message;
  message.time_boot_ms = boot_ms;
  message.lat_camera = message.lon_camera = message.alt_camera = kNoPlace;
  message.lat_image = message.lon_image = message.alt_image = kNoPlace;
  message.q.fill(kNotKnown);
  message.hfov = static_cast<float>(camera.horizontal_fov_deg);
  message.vfov = static_cast<float>(camera.vertical_fov_deg);
  return message;
}

// A mark by a point has a box, too, and is reported by that.
mavlink::CameraTrackingImageStatus ImageStatusOf(const CameraDescription& camera,
                                                 const CameraTracking& tracking) {
  mavlink::CameraTrackingImageStatus message;
  message.tracking_status = StatusOf(tracking.state);
  message.point_x = message.point_y = message.radius = kNotKnown;
  message.rec_top_x = message.rec_top_y = message.rec_bottom_x = message.rec_bottom_y = kNotKnown;
  if (!tracking.region) return message;
  message.tracking_mode = mavlink::kTrackingRectangle;
  message.target_data = mavlink::kTargetInStatus;
  if (camera.has_stream()) message.target_data |= mavlink::kTargetRendered;
  message.rec_top_x = static_cast<float>(tracking.region->left);
  message.rec_top_y = static_cast<float>(tracking.region->top);
  message.rec_bottom_x = static_cast<float>(tracking.region->right);
  message.rec_bottom_y = static_cast<float>(tracking.region->bottom);
  return message;
}

mavlink::CameraTrackingGeoStatus UnknownPlace() {
  mavlink::CameraTrackingGeoStatus message;
  message.lat = message.lon = kNoPlace;
  message.alt = message.h_acc = message.v_acc = kNotKnown;
  message.vel_n = message.vel_e = message.vel_d = message.vel_acc = kNotKnown;
  message.dist = message.hdg = message.hdg_acc = kNotKnown;
  return message;
}

mavlink::CameraTrackingGeoStatus PlaceStatusOf(const CameraTracking& tracking) {
  mavlink::CameraTrackingGeoStatus message = tracking.place.value_or(UnknownPlace());
  message.tracking_status = StatusOf(tracking.state);
  return message;
}

}  // namespace

std::optional<CameraMessage> CameraReportOf(std::uint32_t id, const CameraDescription& camera,
                                            const CameraTracking& tracking, std::uint32_t boot_ms) {
  switch (id) {
    case mavlink::CameraInformation::kId:
      return InformationOf(camera, boot_ms);
    case mavlink::CameraSettings::kId:
      return SettingsAt(boot_ms);
    case mavlink::CameraCaptureStatus::kId:
      return CaptureStatusAt(boot_ms);
    case mavlink::VideoStreamInformation::kId:
      if (camera.has_stream()) return StreamInformationOf(camera);
      return std::nullopt;
    case mavlink::VideoStreamStatus::kId:
      if (camera.has_stream()) return StreamOf<mavlink::VideoStreamStatus>(camera);
      return std::nullopt;
    case mavlink::CameraFovStatus::kId:
      return FieldOfViewOf(camera, boot_ms);
    case mavlink::CameraTrackingImageStatus::kId:
      return ImageStatusOf(camera, tracking);
    case mavlink::CameraTrackingGeoStatus::kId:
      return PlaceStatusOf(tracking);
    default:
      return std::nullopt;
  }
}

mavlink::CameraTrackingGeoStatus GeoStatusOf(const TargetState& target, AutopilotKind kind,
                                             const GlobalPosition& origin) {
  constexpr double kMoving_mps = 0.5;  // a slower one has no heading that is worth a report
  const GlobalPosition place = GlobalFromLocal(kind, origin, target.position_in_world);
  const Eigen::Vector3d velocity = NedFromEnu(target.velocity_in_world);
  const Eigen::Vector3d variances = target.covariance.diagonal();
  mavlink::CameraTrackingGeoStatus message = UnknownPlace();
  message.lat = place.latitude_e7;
  message.lon = place.longitude_e7;
  message.alt = static_cast<float>(place.altitude_m);
  message.h_acc = static_cast<float>(std::sqrt(variances.x() + variances.y()));
  message.v_acc = static_cast<float>(std::sqrt(variances.z()));
  message.vel_n = static_cast<float>(velocity.x());
  message.vel_e = static_cast<float>(velocity.y());
  message.vel_d = static_cast<float>(velocity.z());
  message.dist =
      static_cast<float>((target.position_in_world - target.world_from_body.translation).norm());
  if (velocity.head<2>().norm() > kMoving_mps) {
    message.hdg = static_cast<float>(std::atan2(velocity.y(), velocity.x()));
  }
  return message;
}

}  // namespace kestrel
