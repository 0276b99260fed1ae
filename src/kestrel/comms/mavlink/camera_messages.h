// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

// The messages of MAVLink's camera protocol v2 (mavlink.io/en/services/camera), described as those
// of messages.h.
namespace kestrel::mavlink {

struct CameraInformation {
  static constexpr std::uint32_t kId = 259;
  static constexpr std::string_view kName = "CAMERA_INFORMATION";
  std::uint32_t time_boot_ms = 0;
  std::array<std::uint8_t, 32> vendor_name{};
  std::array<std::uint8_t, 32> model_name{};
  std::uint32_t firmware_version = 0;
  float focal_length = 0;
  float sensor_size_h = 0;
  float sensor_size_v = 0;
  std::uint16_t resolution_h = 0;
  std::uint16_t resolution_v = 0;
  std::uint8_t lens_id = 0;
  std::uint32_t flags = 0;
  std::uint16_t cam_definition_version = 0;
  std::array<char, 140> cam_definition_uri{};
  std::uint8_t gimbal_device_id = 0;
  std::uint8_t camera_device_id = 0;

  static constexpr void Visit(auto& self, auto&& visitor) {
    visitor("time_boot_ms", self.time_boot_ms, "ms");
    visitor("vendor_name", self.vendor_name, "");
    visitor("model_name", self.model_name, "");
    visitor("firmware_version", self.firmware_version, "");
    visitor("focal_length", self.focal_length, "mm");
    visitor("sensor_size_h", self.sensor_size_h, "mm");
    visitor("sensor_size_v", self.sensor_size_v, "mm");
    visitor("resolution_h", self.resolution_h, "pix");
    visitor("resolution_v", self.resolution_v, "pix");
    visitor("lens_id", self.lens_id, "");
    visitor("flags", self.flags, "");
    visitor("cam_definition_version", self.cam_definition_version, "");
    visitor("cam_definition_uri", self.cam_definition_uri, "");
    visitor.Extensions();
    visitor("gimbal_device_id", self.gimbal_device_id, "");
    visitor("camera_device_id", self.camera_device_id, "");
  }
};

struct CameraSettings {
  static constexpr std::uint32_t kId = 260;
  static constexpr std::string_view kName = "CAMERA_SETTINGS";
  std::uint32_t time_boot_ms = 0;
  std::uint8_t mode_id = 0;
  float zoom_level = 0;
  float focus_level = 0;
  std::uint8_t camera_device_id = 0;

  static constexpr void Visit(auto& self, auto&& visitor) {
    visitor("time_boot_ms", self.time_boot_ms, "ms");
    visitor("mode_id", self.mode_id, "");
    visitor.Extensions();
    visitor("zoomLevel", self.zoom_level, "");
    visitor("focusLevel", self.focus_level, "");
    visitor("camera_device_id", self.camera_device_id, "");
  }
};

struct CameraCaptureStatus {
  static constexpr std::uint32_t kId = 262;
  static constexpr std::string_view kName = "CAMERA_CAPTURE_STATUS";
  std::uint32_t time_boot_ms = 0;
  std::uint8_t image_status = 0;
  std::uint8_t video_status = 0;
  float image_interval = 0;
  std::uint32_t recording_time_ms = 0;
  float available_capacity = 0;
  std::int32_t image_count = 0;
  std::uint8_t camera_device_id = 0;

  static constexpr void Visit(auto& self, auto&& visitor) {
    visitor("time_boot_ms", self.time_boot_ms, "ms");
    visitor("image_status", self.image_status, "");
    visitor("video_status", self.video_status, "");
    visitor("image_interval", self.image_interval, "s");
    visitor("recording_time_ms", self.recording_time_ms, "ms");
    visitor("available_capacity", self.available_capacity, "MiB");
    visitor.Extensions();
    visitor("image_count", self.image_count, "");
    visitor("camera_device_id", self.camera_device_id, "");
  }
};

struct VideoStreamInformation {
  static constexpr std::uint32_t kId = 269;
  static constexpr std::string_view kName = "VIDEO_STREAM_INFORMATION";
  std::uint8_t stream_id = 0;
  std::uint8_t count = 0;
  std::uint8_t type = 0;
  std::uint16_t flags = 0;
  float framerate = 0;
  std::uint16_t resolution_h = 0;
  std::uint16_t resolution_v = 0;
  std::uint32_t bitrate = 0;
  std::uint16_t rotation = 0;
  std::uint16_t hfov = 0;
  std::array<char, 32> name{};
  std::array<char, 160> uri{};
  std::uint8_t encoding = 0;
  std::uint8_t camera_device_id = 0;

  static constexpr void Visit(auto& self, auto&& visitor) {
    visitor("stream_id", self.stream_id, "");
    visitor("count", self.count, "");
    visitor("type", self.type, "");
    visitor("flags", self.flags, "");
    visitor("framerate", self.framerate, "Hz");
    visitor("resolution_h", self.resolution_h, "pix");
    visitor("resolution_v", self.resolution_v, "pix");
    visitor("bitrate", self.bitrate, "bits/s");
    visitor("rotation", self.rotation, "deg");
    visitor("hfov", self.hfov, "deg");
    visitor("name", self.name, "");
    visitor("uri", self.uri, "");
    visitor.Extensions();
    visitor("encoding", self.encoding, "");
    visitor("camera_device_id", self.camera_device_id, "");
  }
};

struct VideoStreamStatus {
  static constexpr std::uint32_t kId = 270;
  static constexpr std::string_view kName = "VIDEO_STREAM_STATUS";
  std::uint8_t stream_id = 0;
  std::uint16_t flags = 0;
  float framerate = 0;
  std::uint16_t resolution_h = 0;
  std::uint16_t resolution_v = 0;
  std::uint32_t bitrate = 0;
  std::uint16_t rotation = 0;
  std::uint16_t hfov = 0;
  std::uint8_t camera_device_id = 0;

  static constexpr void Visit(auto& self, auto&& visitor) {
    visitor("stream_id", self.stream_id, "");
    visitor("flags", self.flags, "");
    visitor("framerate", self.framerate, "Hz");
    visitor("resolution_h", self.resolution_h, "pix");
    visitor("resolution_v", self.resolution_v, "pix");
    visitor("bitrate", self.bitrate, "bits/s");
    visitor("rotation", self.rotation, "deg");
    visitor("hfov", self.hfov, "deg");
    visitor.Extensions();
    visitor("camera_device_id", self.camera_device_id, "");
  }
};

struct CameraFovStatus {
  static constexpr std::uint32_t kId = 271;
  static constexpr std::string_view kName = "CAMERA_FOV_STATUS";
  std::uint32_t time_boot_ms = 0;
  std::int32_t lat_camera = 0;
  std::int32_t lon_camera = 0;
  std::int32_t alt_camera = 0;
  std::int32_t lat_image = 0;
  std::int32_t lon_image = 0;
  std::int32_t alt_image = 0;
  std::array<float, 4> q{};
  float hfov = 0;
  float vfov = 0;
  std::uint8_t camera_device_id = 0;

  static constexpr void Visit(auto& self, auto&& visitor) {
    visitor("time_boot_ms", self.time_boot_ms, "ms");
    visitor("lat_camera", self.lat_camera, "degE7");
    visitor("lon_camera", self.lon_camera, "degE7");
    visitor("alt_camera", self.alt_camera, "mm");
    visitor("lat_image", self.lat_image, "degE7");
    visitor("lon_image", self.lon_image, "degE7");
    visitor("alt_image", self.alt_image, "mm");
    visitor("q", self.q, "");
    visitor("hfov", self.hfov, "deg");
    visitor("vfov", self.vfov, "deg");
    visitor.Extensions();
    visitor("camera_device_id", self.camera_device_id, "");
  }
};

// Places in the image: shares of its width and height, from the upper left corner.
struct CameraTrackingImageStatus {
  static constexpr std::uint32_t kId = 275;
  static constexpr std::string_view kName = "CAMERA_TRACKING_IMAGE_STATUS";
  std::uint8_t tracking_status = 0;
  std::uint8_t tracking_mode = 0;
  std::uint8_t target_data = 0;
  float point_x = 0;
  float point_y = 0;
  float radius = 0;
  float rec_top_x = 0;
  float rec_top_y = 0;
  float rec_bottom_x = 0;
  float rec_bottom_y = 0;
  std::uint8_t camera_device_id = 0;

  static constexpr void Visit(auto& self, auto&& visitor) {
    visitor("tracking_status", self.tracking_status, "");
    visitor("tracking_mode", self.tracking_mode, "");
    visitor("target_data", self.target_data, "");
    visitor("point_x", self.point_x, "");
    visitor("point_y", self.point_y, "");
    visitor("radius", self.radius, "");
    visitor("rec_top_x", self.rec_top_x, "");
    visitor("rec_top_y", self.rec_top_y, "");
    visitor("rec_bottom_x", self.rec_bottom_x, "");
    visitor("rec_bottom_y", self.rec_bottom_y, "");
    visitor.Extensions();
    visitor("camera_device_id", self.camera_device_id, "");
  }
};

struct CameraTrackingGeoStatus {
  static constexpr std::uint32_t kId = 276;
  static constexpr std::string_view kName = "CAMERA_TRACKING_GEO_STATUS";
  std::uint8_t tracking_status = 0;
  std::int32_t lat = 0;
  std::int32_t lon = 0;
  float alt = 0;
  float h_acc = 0;
  float v_acc = 0;
  float vel_n = 0;
  float vel_e = 0;
  float vel_d = 0;
  float vel_acc = 0;
  float dist = 0;
  float hdg = 0;
  float hdg_acc = 0;
  std::uint8_t camera_device_id = 0;

  static constexpr void Visit(auto& self, auto&& visitor) {
    visitor("tracking_status", self.tracking_status, "");
    visitor("lat", self.lat, "degE7");
    visitor("lon", self.lon, "degE7");
    visitor("alt", self.alt, "m");
    visitor("h_acc", self.h_acc, "m");
    visitor("v_acc", self.v_acc, "m");
    visitor("vel_n", self.vel_n, "m/s");
    visitor("vel_e", self.vel_e, "m/s");
    visitor("vel_d", self.vel_d, "m/s");
    visitor("vel_acc", self.vel_acc, "m/s");
    visitor("dist", self.dist, "m");
    visitor("hdg", self.hdg, "rad");
    visitor("hdg_acc", self.hdg_acc, "rad");
    visitor.Extensions();
    visitor("camera_device_id", self.camera_device_id, "");
  }
};

}  // namespace kestrel::mavlink
