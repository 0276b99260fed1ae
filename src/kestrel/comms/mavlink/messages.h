// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

// The messages of MAVLink (dialects minimal, common, ardupilotmega, development) that Kestrel reads
// or sends, with the protocol's own names, units and frames (NED, FRD); mavlink.io/en/messages has
// their meaning. Visit describes each message once: name, member (which has the type) and unit of
// every field in the order of the XML; the extensions of MAVLink 2 follow after Extensions(). The
// byte layout is derived from it (message_layout.h): a description that differs from the
// autopilot's has another CRC_EXTRA, so that the autopilot rejects it.
namespace kestrel::mavlink {

struct Heartbeat {
  static constexpr std::uint32_t kId = 0;
  static constexpr std::string_view kName = "HEARTBEAT";
  std::uint8_t type = 0;
  std::uint8_t autopilot = 0;
  std::uint8_t base_mode = 0;
  std::uint32_t custom_mode = 0;
  std::uint8_t system_status = 0;
  std::uint8_t mavlink_version = 0;

  static constexpr void Visit(auto& self, auto&& visitor) {
    visitor("type", self.type, "");
    visitor("autopilot", self.autopilot, "");
    visitor("base_mode", self.base_mode, "");
    visitor("custom_mode", self.custom_mode, "");
    visitor("system_status", self.system_status, "");
    visitor("mavlink_version", self.mavlink_version, "");
  }
};

struct SysStatus {
  static constexpr std::uint32_t kId = 1;
  static constexpr std::string_view kName = "SYS_STATUS";
  std::uint32_t onboard_control_sensors_present = 0;
  std::uint32_t onboard_control_sensors_enabled = 0;
  std::uint32_t onboard_control_sensors_health = 0;
  std::uint16_t load = 0;
  std::uint16_t voltage_battery = 0;
  std::int16_t current_battery = 0;
  std::int8_t battery_remaining = 0;
  std::uint16_t drop_rate_comm = 0;
  std::uint16_t errors_comm = 0;
  std::uint16_t errors_count1 = 0;
  std::uint16_t errors_count2 = 0;
  std::uint16_t errors_count3 = 0;
  std::uint16_t errors_count4 = 0;
  std::uint32_t onboard_control_sensors_present_extended = 0;
  std::uint32_t onboard_control_sensors_enabled_extended = 0;
  std::uint32_t onboard_control_sensors_health_extended = 0;

  static constexpr void Visit(auto& self, auto&& visitor) {
    visitor("onboard_control_sensors_present", self.onboard_control_sensors_present, "");
    visitor("onboard_control_sensors_enabled", self.onboard_control_sensors_enabled, "");
    visitor("onboard_control_sensors_health", self.onboard_control_sensors_health, "");
    visitor("load", self.load, "d%");
    visitor("voltage_battery", self.voltage_battery, "mV");
    visitor("current_battery", self.current_battery, "cA");
    visitor("battery_remaining", self.battery_remaining, "%");
    visitor("drop_rate_comm", self.drop_rate_comm, "c%");
    visitor("errors_comm", self.errors_comm, "");
    visitor("errors_count1", self.errors_count1, "");
    visitor("errors_count2", self.errors_count2, "");
    visitor("errors_count3", self.errors_count3, "");
    visitor("errors_count4", self.errors_count4, "");
    visitor.Extensions();
    visitor("onboard_control_sensors_present_extended",
            self.onboard_control_sensors_present_extended, "");
    visitor("onboard_control_sensors_enabled_extended",
            self.onboard_control_sensors_enabled_extended, "");
    visitor("onboard_control_sensors_health_extended", self.onboard_control_sensors_health_extended,
            "");
  }
};

struct SystemTime {
  static constexpr std::uint32_t kId = 2;
  static constexpr std::string_view kName = "SYSTEM_TIME";
  std::uint64_t time_unix_usec = 0;
  std::uint32_t time_boot_ms = 0;

  static constexpr void Visit(auto& self, auto&& visitor) {
    visitor("time_unix_usec", self.time_unix_usec, "us");
    visitor("time_boot_ms", self.time_boot_ms, "ms");
  }
};

struct SetMode {
  static constexpr std::uint32_t kId = 11;
  static constexpr std::string_view kName = "SET_MODE";
  std::uint8_t target_system = 0;
  std::uint8_t base_mode = 0;
  std::uint32_t custom_mode = 0;

  static constexpr void Visit(auto& self, auto&& visitor) {
    visitor("target_system", self.target_system, "");
    visitor("base_mode", self.base_mode, "");
    visitor("custom_mode", self.custom_mode, "");
  }
};

struct ParamRequestRead {
  static constexpr std::uint32_t kId = 20;
  static constexpr std::string_view kName = "PARAM_REQUEST_READ";
  std::uint8_t target_system = 0;
  std::uint8_t target_component = 0;
  std::array<char, 16> param_id{};
  std::int16_t param_index = 0;

  static constexpr void Visit(auto& self, auto&& visitor) {
    visitor("target_system", self.target_system, "");
    visitor("target_component", self.target_component, "");
    visitor("param_id", self.param_id, "");
    visitor("param_index", self.param_index, "");
  }
};

struct ParamRequestList {
  static constexpr std::uint32_t kId = 21;
  static constexpr std::string_view kName = "PARAM_REQUEST_LIST";
  std::uint8_t target_system = 0;
  std::uint8_t target_component = 0;

  static constexpr void Visit(auto& self, auto&& visitor) {
    visitor("target_system", self.target_system, "");
    visitor("target_component", self.target_component, "");
  }
};

// ArduPilot converts every value to float; PX4 puts the bits of an INT32 into it.
struct ParamValue {
  static constexpr std::uint32_t kId = 22;
  static constexpr std::string_view kName = "PARAM_VALUE";
  std::array<char, 16> param_id{};
  float param_value = 0;
  std::uint8_t param_type = 0;
  std::uint16_t param_count = 0;
  std::uint16_t param_index = 0;

  static constexpr void Visit(auto& self, auto&& visitor) {
    visitor("param_id", self.param_id, "");
    visitor("param_value", self.param_value, "");
    visitor("param_type", self.param_type, "");
    visitor("param_count", self.param_count, "");
    visitor("param_index", self.param_index, "");
  }
};

struct ParamSet {
  static constexpr std::uint32_t kId = 23;
  static constexpr std::string_view kName = "PARAM_SET";
  std::uint8_t target_system = 0;
  std::uint8_t target_component = 0;
  std::array<char, 16> param_id{};
  float param_value = 0;
  std::uint8_t param_type = 0;

  static constexpr void Visit(auto& self, auto&& visitor) {
    visitor("target_system", self.target_system, "");
    visitor("target_component", self.target_component, "");
    visitor("param_id", self.param_id, "");
    visitor("param_value", self.param_value, "");
    visitor("param_type", self.param_type, "");
  }
};

struct GpsRawInt {
  static constexpr std::uint32_t kId = 24;
  static constexpr std::string_view kName = "GPS_RAW_INT";
  std::uint64_t time_usec = 0;
  std::uint8_t fix_type = 0;
  std::int32_t lat = 0;
  std::int32_t lon = 0;
  std::int32_t alt = 0;
  std::uint16_t eph = 0;
  std::uint16_t epv = 0;
  std::uint16_t vel = 0;
  std::uint16_t cog = 0;
  std::uint8_t satellites_visible = 0;
  std::int32_t alt_ellipsoid = 0;
  std::uint32_t h_acc = 0;
  std::uint32_t v_acc = 0;
  std::uint32_t vel_acc = 0;
  std::uint32_t hdg_acc = 0;
  std::uint16_t yaw = 0;

  static constexpr void Visit(auto& self, auto&& visitor) {
    visitor("time_usec", self.time_usec, "us");
    visitor("fix_type", self.fix_type, "");
    visitor("lat", self.lat, "degE7");
    visitor("lon", self.lon, "degE7");
    visitor("alt", self.alt, "mm");
    visitor("eph", self.eph, "");
    visitor("epv", self.epv, "");
    visitor("vel", self.vel, "cm/s");
    visitor("cog", self.cog, "cdeg");
    visitor("satellites_visible", self.satellites_visible, "");
    visitor.Extensions();
    visitor("alt_ellipsoid", self.alt_ellipsoid, "mm");
    visitor("h_acc", self.h_acc, "mm");
    visitor("v_acc", self.v_acc, "mm");
    visitor("vel_acc", self.vel_acc, "mm");
    visitor("hdg_acc", self.hdg_acc, "degE5");
    visitor("yaw", self.yaw, "cdeg");
  }
};

struct RawImu {
  static constexpr std::uint32_t kId = 27;
  static constexpr std::string_view kName = "RAW_IMU";
  std::uint64_t time_usec = 0;
  std::int16_t xacc = 0;
  std::int16_t yacc = 0;
  std::int16_t zacc = 0;
  std::int16_t xgyro = 0;
  std::int16_t ygyro = 0;
  std::int16_t zgyro = 0;
  std::int16_t xmag = 0;
  std::int16_t ymag = 0;
  std::int16_t zmag = 0;
  std::uint8_t id = 0;
  std::int16_t temperature = 0;

  static constexpr void Visit(auto& self, auto&& visitor) {
    visitor("time_usec", self.time_usec, "us");
    visitor("xacc", self.xacc, "");
    visitor("yacc", self.yacc, "");
    visitor("zacc", self.zacc, "");
    visitor("xgyro", self.xgyro, "");
    visitor("ygyro", self.ygyro, "");
    visitor("zgyro", self.zgyro, "");
    visitor("xmag", self.xmag, "");
    visitor("ymag", self.ymag, "");
    visitor("zmag", self.zmag, "");
    visitor.Extensions();
    visitor("id", self.id, "");
    visitor("temperature", self.temperature, "cdegC");
  }
};

struct Attitude {
  static constexpr std::uint32_t kId = 30;
  static constexpr std::string_view kName = "ATTITUDE";
  std::uint32_t time_boot_ms = 0;
  float roll = 0;
  float pitch = 0;
  float yaw = 0;
  float rollspeed = 0;
  float pitchspeed = 0;
  float yawspeed = 0;

  static constexpr void Visit(auto& self, auto&& visitor) {
    visitor("time_boot_ms", self.time_boot_ms, "ms");
    visitor("roll", self.roll, "rad");
    visitor("pitch", self.pitch, "rad");
    visitor("yaw", self.yaw, "rad");
    visitor("rollspeed", self.rollspeed, "rad/s");
    visitor("pitchspeed", self.pitchspeed, "rad/s");
    visitor("yawspeed", self.yawspeed, "rad/s");
  }
};

struct AttitudeQuaternion {
  static constexpr std::uint32_t kId = 31;
  static constexpr std::string_view kName = "ATTITUDE_QUATERNION";
  std::uint32_t time_boot_ms = 0;
  float q1 = 0;
  float q2 = 0;
  float q3 = 0;
  float q4 = 0;
  float rollspeed = 0;
  float pitchspeed = 0;
  float yawspeed = 0;
  std::array<float, 4> repr_offset_q{};

  static constexpr void Visit(auto& self, auto&& visitor) {
    visitor("time_boot_ms", self.time_boot_ms, "ms");
    visitor("q1", self.q1, "");
    visitor("q2", self.q2, "");
    visitor("q3", self.q3, "");
    visitor("q4", self.q4, "");
    visitor("rollspeed", self.rollspeed, "rad/s");
    visitor("pitchspeed", self.pitchspeed, "rad/s");
    visitor("yawspeed", self.yawspeed, "rad/s");
    visitor.Extensions();
    visitor("repr_offset_q", self.repr_offset_q, "");
  }
};

struct LocalPositionNed {
  static constexpr std::uint32_t kId = 32;
  static constexpr std::string_view kName = "LOCAL_POSITION_NED";
  std::uint32_t time_boot_ms = 0;
  float x = 0;
  float y = 0;
  float z = 0;
  float vx = 0;
  float vy = 0;
  float vz = 0;

  static constexpr void Visit(auto& self, auto&& visitor) {
    visitor("time_boot_ms", self.time_boot_ms, "ms");
    visitor("x", self.x, "m");
    visitor("y", self.y, "m");
    visitor("z", self.z, "m");
    visitor("vx", self.vx, "m/s");
    visitor("vy", self.vy, "m/s");
    visitor("vz", self.vz, "m/s");
  }
};

struct GlobalPositionInt {
  static constexpr std::uint32_t kId = 33;
  static constexpr std::string_view kName = "GLOBAL_POSITION_INT";
  std::uint32_t time_boot_ms = 0;
  std::int32_t lat = 0;
  std::int32_t lon = 0;
  std::int32_t alt = 0;
  std::int32_t relative_alt = 0;
  std::int16_t vx = 0;
  std::int16_t vy = 0;
  std::int16_t vz = 0;
  std::uint16_t hdg = 0;

  static constexpr void Visit(auto& self, auto&& visitor) {
    visitor("time_boot_ms", self.time_boot_ms, "ms");
    visitor("lat", self.lat, "degE7");
    visitor("lon", self.lon, "degE7");
    visitor("alt", self.alt, "mm");
    visitor("relative_alt", self.relative_alt, "mm");
    visitor("vx", self.vx, "cm/s");
    visitor("vy", self.vy, "cm/s");
    visitor("vz", self.vz, "cm/s");
    visitor("hdg", self.hdg, "cdeg");
  }
};

struct SetGpsGlobalOrigin {
  static constexpr std::uint32_t kId = 48;
  static constexpr std::string_view kName = "SET_GPS_GLOBAL_ORIGIN";
  std::uint8_t target_system = 0;
  std::int32_t latitude = 0;
  std::int32_t longitude = 0;
  std::int32_t altitude = 0;
  std::uint64_t time_usec = 0;

  static constexpr void Visit(auto& self, auto&& visitor) {
    visitor("target_system", self.target_system, "");
    visitor("latitude", self.latitude, "degE7");
    visitor("longitude", self.longitude, "degE7");
    visitor("altitude", self.altitude, "mm");
    visitor.Extensions();
    visitor("time_usec", self.time_usec, "us");
  }
};

struct GpsGlobalOrigin {
  static constexpr std::uint32_t kId = 49;
  static constexpr std::string_view kName = "GPS_GLOBAL_ORIGIN";
  std::int32_t latitude = 0;
  std::int32_t longitude = 0;
  std::int32_t altitude = 0;
  std::uint64_t time_usec = 0;

  static constexpr void Visit(auto& self, auto&& visitor) {
    visitor("latitude", self.latitude, "degE7");
    visitor("longitude", self.longitude, "degE7");
    visitor("altitude", self.altitude, "mm");
    visitor.Extensions();
    visitor("time_usec", self.time_usec, "us");
  }
};

struct RcChannels {
  static constexpr std::uint32_t kId = 65;
  static constexpr std::string_view kName = "RC_CHANNELS";
  std::uint32_t time_boot_ms = 0;
  std::uint8_t chancount = 0;
  std::uint16_t chan1_raw = 0;
  std::uint16_t chan2_raw = 0;
  std::uint16_t chan3_raw = 0;
  std::uint16_t chan4_raw = 0;
  std::uint16_t chan5_raw = 0;
  std::uint16_t chan6_raw = 0;
  std::uint16_t chan7_raw = 0;
  std::uint16_t chan8_raw = 0;
  std::uint16_t chan9_raw = 0;
  std::uint16_t chan10_raw = 0;
  std::uint16_t chan11_raw = 0;
  std::uint16_t chan12_raw = 0;
  std::uint16_t chan13_raw = 0;
  std::uint16_t chan14_raw = 0;
  std::uint16_t chan15_raw = 0;
  std::uint16_t chan16_raw = 0;
  std::uint16_t chan17_raw = 0;
  std::uint16_t chan18_raw = 0;
  std::uint8_t rssi = 0;

  static constexpr void Visit(auto& self, auto&& visitor) {
    visitor("time_boot_ms", self.time_boot_ms, "ms");
    visitor("chancount", self.chancount, "");
    visitor("chan1_raw", self.chan1_raw, "us");
    visitor("chan2_raw", self.chan2_raw, "us");
    visitor("chan3_raw", self.chan3_raw, "us");
    visitor("chan4_raw", self.chan4_raw, "us");
    visitor("chan5_raw", self.chan5_raw, "us");
    visitor("chan6_raw", self.chan6_raw, "us");
    visitor("chan7_raw", self.chan7_raw, "us");
    visitor("chan8_raw", self.chan8_raw, "us");
    visitor("chan9_raw", self.chan9_raw, "us");
    visitor("chan10_raw", self.chan10_raw, "us");
    visitor("chan11_raw", self.chan11_raw, "us");
    visitor("chan12_raw", self.chan12_raw, "us");
    visitor("chan13_raw", self.chan13_raw, "us");
    visitor("chan14_raw", self.chan14_raw, "us");
    visitor("chan15_raw", self.chan15_raw, "us");
    visitor("chan16_raw", self.chan16_raw, "us");
    visitor("chan17_raw", self.chan17_raw, "us");
    visitor("chan18_raw", self.chan18_raw, "us");
    visitor("rssi", self.rssi, "");
  }
};

struct RequestDataStream {
  static constexpr std::uint32_t kId = 66;
  static constexpr std::string_view kName = "REQUEST_DATA_STREAM";
  std::uint8_t target_system = 0;
  std::uint8_t target_component = 0;
  std::uint8_t req_stream_id = 0;
  std::uint16_t req_message_rate = 0;
  std::uint8_t start_stop = 0;

  static constexpr void Visit(auto& self, auto&& visitor) {
    visitor("target_system", self.target_system, "");
    visitor("target_component", self.target_component, "");
    visitor("req_stream_id", self.req_stream_id, "");
    visitor("req_message_rate", self.req_message_rate, "Hz");
    visitor("start_stop", self.start_stop, "");
  }
};

struct VfrHud {
  static constexpr std::uint32_t kId = 74;
  static constexpr std::string_view kName = "VFR_HUD";
  float airspeed = 0;
  float groundspeed = 0;
  std::int16_t heading = 0;
  std::uint16_t throttle = 0;
  float alt = 0;
  float climb = 0;

  static constexpr void Visit(auto& self, auto&& visitor) {
    visitor("airspeed", self.airspeed, "m/s");
    visitor("groundspeed", self.groundspeed, "m/s");
    visitor("heading", self.heading, "deg");
    visitor("throttle", self.throttle, "%");
    visitor("alt", self.alt, "m");
    visitor("climb", self.climb, "m/s");
  }
};

struct CommandLong {
  static constexpr std::uint32_t kId = 76;
  static constexpr std::string_view kName = "COMMAND_LONG";
  std::uint8_t target_system = 0;
  std::uint8_t target_component = 0;
  std::uint16_t command = 0;
  std::uint8_t confirmation = 0;
  float param1 = 0;
  float param2 = 0;
  float param3 = 0;
  float param4 = 0;
  float param5 = 0;
  float param6 = 0;
  float param7 = 0;

  static constexpr void Visit(auto& self, auto&& visitor) {
    visitor("target_system", self.target_system, "");
    visitor("target_component", self.target_component, "");
    visitor("command", self.command, "");
    visitor("confirmation", self.confirmation, "");
    visitor("param1", self.param1, "");
    visitor("param2", self.param2, "");
    visitor("param3", self.param3, "");
    visitor("param4", self.param4, "");
    visitor("param5", self.param5, "");
    visitor("param6", self.param6, "");
    visitor("param7", self.param7, "");
  }
};

struct CommandAck {
  static constexpr std::uint32_t kId = 77;
  static constexpr std::string_view kName = "COMMAND_ACK";
  std::uint16_t command = 0;
  std::uint8_t result = 0;
  std::uint8_t progress = 0;
  std::int32_t result_param2 = 0;
  std::uint8_t target_system = 0;
  std::uint8_t target_component = 0;

  static constexpr void Visit(auto& self, auto&& visitor) {
    visitor("command", self.command, "");
    visitor("result", self.result, "");
    visitor.Extensions();
    visitor("progress", self.progress, "%");
    visitor("result_param2", self.result_param2, "");
    visitor("target_system", self.target_system, "");
    visitor("target_component", self.target_component, "");
  }
};

struct SetAttitudeTarget {
  static constexpr std::uint32_t kId = 82;
  static constexpr std::string_view kName = "SET_ATTITUDE_TARGET";
  std::uint32_t time_boot_ms = 0;
  std::uint8_t target_system = 0;
  std::uint8_t target_component = 0;
  std::uint8_t type_mask = 0;
  std::array<float, 4> q{};
  float body_roll_rate = 0;
  float body_pitch_rate = 0;
  float body_yaw_rate = 0;
  float thrust = 0;
  std::array<float, 3> thrust_body{};

  static constexpr void Visit(auto& self, auto&& visitor) {
    visitor("time_boot_ms", self.time_boot_ms, "ms");
    visitor("target_system", self.target_system, "");
    visitor("target_component", self.target_component, "");
    visitor("type_mask", self.type_mask, "");
    visitor("q", self.q, "");
    visitor("body_roll_rate", self.body_roll_rate, "rad/s");
    visitor("body_pitch_rate", self.body_pitch_rate, "rad/s");
    visitor("body_yaw_rate", self.body_yaw_rate, "rad/s");
    visitor("thrust", self.thrust, "");
    visitor.Extensions();
    visitor("thrust_body", self.thrust_body, "");
  }
};

struct SetPositionTargetLocalNed {
  static constexpr std::uint32_t kId = 84;
  static constexpr std::string_view kName = "SET_POSITION_TARGET_LOCAL_NED";
  std::uint32_t time_boot_ms = 0;
  std::uint8_t target_system = 0;
  std::uint8_t target_component = 0;
  std::uint8_t coordinate_frame = 0;
  std::uint16_t type_mask = 0;
  float x = 0;
  float y = 0;
  float z = 0;
  float vx = 0;
  float vy = 0;
  float vz = 0;
  float afx = 0;
  float afy = 0;
  float afz = 0;
  float yaw = 0;
  float yaw_rate = 0;

  static constexpr void Visit(auto& self, auto&& visitor) {
    visitor("time_boot_ms", self.time_boot_ms, "ms");
    visitor("target_system", self.target_system, "");
    visitor("target_component", self.target_component, "");
    visitor("coordinate_frame", self.coordinate_frame, "");
    visitor("type_mask", self.type_mask, "");
    visitor("x", self.x, "m");
    visitor("y", self.y, "m");
    visitor("z", self.z, "m");
    visitor("vx", self.vx, "m/s");
    visitor("vy", self.vy, "m/s");
    visitor("vz", self.vz, "m/s");
    visitor("afx", self.afx, "m/s/s");
    visitor("afy", self.afy, "m/s/s");
    visitor("afz", self.afz, "m/s/s");
    visitor("yaw", self.yaw, "rad");
    visitor("yaw_rate", self.yaw_rate, "rad/s");
  }
};

struct HighresImu {
  static constexpr std::uint32_t kId = 105;
  static constexpr std::string_view kName = "HIGHRES_IMU";
  std::uint64_t time_usec = 0;
  float xacc = 0;
  float yacc = 0;
  float zacc = 0;
  float xgyro = 0;
  float ygyro = 0;
  float zgyro = 0;
  float xmag = 0;
  float ymag = 0;
  float zmag = 0;
  float abs_pressure = 0;
  float diff_pressure = 0;
  float pressure_alt = 0;
  float temperature = 0;
  std::uint16_t fields_updated = 0;
  std::uint8_t id = 0;

  static constexpr void Visit(auto& self, auto&& visitor) {
    visitor("time_usec", self.time_usec, "us");
    visitor("xacc", self.xacc, "m/s/s");
    visitor("yacc", self.yacc, "m/s/s");
    visitor("zacc", self.zacc, "m/s/s");
    visitor("xgyro", self.xgyro, "rad/s");
    visitor("ygyro", self.ygyro, "rad/s");
    visitor("zgyro", self.zgyro, "rad/s");
    visitor("xmag", self.xmag, "gauss");
    visitor("ymag", self.ymag, "gauss");
    visitor("zmag", self.zmag, "gauss");
    visitor("abs_pressure", self.abs_pressure, "hPa");
    visitor("diff_pressure", self.diff_pressure, "hPa");
    visitor("pressure_alt", self.pressure_alt, "");
    visitor("temperature", self.temperature, "degC");
    visitor("fields_updated", self.fields_updated, "");
    visitor.Extensions();
    visitor("id", self.id, "");
  }
};

// True pose of a simulated vehicle. ArduPilot scales lat and lon wrongly: lat_int and lon_int are
// right.
struct SimState {
  static constexpr std::uint32_t kId = 108;
  static constexpr std::string_view kName = "SIM_STATE";
  float q1 = 0;
  float q2 = 0;
  float q3 = 0;
  float q4 = 0;
  float roll = 0;
  float pitch = 0;
  float yaw = 0;
  float xacc = 0;
  float yacc = 0;
  float zacc = 0;
  float xgyro = 0;
  float ygyro = 0;
  float zgyro = 0;
  float lat = 0;
  float lon = 0;
  float alt = 0;
  float std_dev_horz = 0;
  float std_dev_vert = 0;
  float vn = 0;
  float ve = 0;
  float vd = 0;
  std::int32_t lat_int = 0;
  std::int32_t lon_int = 0;

  static constexpr void Visit(auto& self, auto&& visitor) {
    visitor("q1", self.q1, "");
    visitor("q2", self.q2, "");
    visitor("q3", self.q3, "");
    visitor("q4", self.q4, "");
    visitor("roll", self.roll, "rad");
    visitor("pitch", self.pitch, "rad");
    visitor("yaw", self.yaw, "rad");
    visitor("xacc", self.xacc, "m/s/s");
    visitor("yacc", self.yacc, "m/s/s");
    visitor("zacc", self.zacc, "m/s/s");
    visitor("xgyro", self.xgyro, "rad/s");
    visitor("ygyro", self.ygyro, "rad/s");
    visitor("zgyro", self.zgyro, "rad/s");
    visitor("lat", self.lat, "deg");
    visitor("lon", self.lon, "deg");
    visitor("alt", self.alt, "m");
    visitor("std_dev_horz", self.std_dev_horz, "");
    visitor("std_dev_vert", self.std_dev_vert, "");
    visitor("vn", self.vn, "m/s");
    visitor("ve", self.ve, "m/s");
    visitor("vd", self.vd, "m/s");
    visitor.Extensions();
    visitor("lat_int", self.lat_int, "degE7");
    visitor("lon_int", self.lon_int, "degE7");
  }
};

// A request has tc1 = 0 and the requester's clock in ts1; an answer has the answerer's clock in tc1
// and the request's ts1.
struct Timesync {
  static constexpr std::uint32_t kId = 111;
  static constexpr std::string_view kName = "TIMESYNC";
  std::int64_t tc1 = 0;
  std::int64_t ts1 = 0;
  std::uint8_t target_system = 0;
  std::uint8_t target_component = 0;

  static constexpr void Visit(auto& self, auto&& visitor) {
    visitor("tc1", self.tc1, "ns");
    visitor("ts1", self.ts1, "ns");
    visitor.Extensions();
    visitor("target_system", self.target_system, "");
    visitor("target_component", self.target_component, "");
  }
};

struct HilStateQuaternion {
  static constexpr std::uint32_t kId = 115;
  static constexpr std::string_view kName = "HIL_STATE_QUATERNION";
  std::uint64_t time_usec = 0;
  std::array<float, 4> attitude_quaternion{};
  float rollspeed = 0;
  float pitchspeed = 0;
  float yawspeed = 0;
  std::int32_t lat = 0;
  std::int32_t lon = 0;
  std::int32_t alt = 0;
  std::int16_t vx = 0;
  std::int16_t vy = 0;
  std::int16_t vz = 0;
  std::uint16_t ind_airspeed = 0;
  std::uint16_t true_airspeed = 0;
  std::int16_t xacc = 0;
  std::int16_t yacc = 0;
  std::int16_t zacc = 0;

  static constexpr void Visit(auto& self, auto&& visitor) {
    visitor("time_usec", self.time_usec, "us");
    visitor("attitude_quaternion", self.attitude_quaternion, "");
    visitor("rollspeed", self.rollspeed, "rad/s");
    visitor("pitchspeed", self.pitchspeed, "rad/s");
    visitor("yawspeed", self.yawspeed, "rad/s");
    visitor("lat", self.lat, "degE7");
    visitor("lon", self.lon, "degE7");
    visitor("alt", self.alt, "mm");
    visitor("vx", self.vx, "cm/s");
    visitor("vy", self.vy, "cm/s");
    visitor("vz", self.vz, "cm/s");
    visitor("ind_airspeed", self.ind_airspeed, "cm/s");
    visitor("true_airspeed", self.true_airspeed, "cm/s");
    visitor("xacc", self.xacc, "mG");
    visitor("yacc", self.yacc, "mG");
    visitor("zacc", self.zacc, "mG");
  }
};

struct DistanceSensor {
  static constexpr std::uint32_t kId = 132;
  static constexpr std::string_view kName = "DISTANCE_SENSOR";
  std::uint32_t time_boot_ms = 0;
  std::uint16_t min_distance = 0;
  std::uint16_t max_distance = 0;
  std::uint16_t current_distance = 0;
  std::uint8_t type = 0;
  std::uint8_t id = 0;
  std::uint8_t orientation = 0;
  std::uint8_t covariance = 0;
  float horizontal_fov = 0;
  float vertical_fov = 0;
  std::array<float, 4> quaternion{};
  std::uint8_t signal_quality = 0;

  static constexpr void Visit(auto& self, auto&& visitor) {
    visitor("time_boot_ms", self.time_boot_ms, "ms");
    visitor("min_distance", self.min_distance, "cm");
    visitor("max_distance", self.max_distance, "cm");
    visitor("current_distance", self.current_distance, "cm");
    visitor("type", self.type, "");
    visitor("id", self.id, "");
    visitor("orientation", self.orientation, "");
    visitor("covariance", self.covariance, "cm^2");
    visitor.Extensions();
    visitor("horizontal_fov", self.horizontal_fov, "rad");
    visitor("vertical_fov", self.vertical_fov, "rad");
    visitor("quaternion", self.quaternion, "");
    visitor("signal_quality", self.signal_quality, "%");
  }
};

struct Altitude {
  static constexpr std::uint32_t kId = 141;
  static constexpr std::string_view kName = "ALTITUDE";
  std::uint64_t time_usec = 0;
  float altitude_monotonic = 0;
  float altitude_amsl = 0;
  float altitude_local = 0;
  float altitude_relative = 0;
  float altitude_terrain = 0;
  float bottom_clearance = 0;

  static constexpr void Visit(auto& self, auto&& visitor) {
    visitor("time_usec", self.time_usec, "us");
    visitor("altitude_monotonic", self.altitude_monotonic, "m");
    visitor("altitude_amsl", self.altitude_amsl, "m");
    visitor("altitude_local", self.altitude_local, "m");
    visitor("altitude_relative", self.altitude_relative, "m");
    visitor("altitude_terrain", self.altitude_terrain, "m");
    visitor("bottom_clearance", self.bottom_clearance, "m");
  }
};

struct FollowTarget {
  static constexpr std::uint32_t kId = 144;
  static constexpr std::string_view kName = "FOLLOW_TARGET";
  std::uint64_t timestamp = 0;
  std::uint8_t est_capabilities = 0;
  std::int32_t lat = 0;
  std::int32_t lon = 0;
  float alt = 0;
  std::array<float, 3> vel{};
  std::array<float, 3> acc{};
  std::array<float, 4> attitude_q{};
  std::array<float, 3> rates{};
  std::array<float, 3> position_cov{};
  std::uint64_t custom_state = 0;

  static constexpr void Visit(auto& self, auto&& visitor) {
    visitor("timestamp", self.timestamp, "ms");
    visitor("est_capabilities", self.est_capabilities, "");
    visitor("lat", self.lat, "degE7");
    visitor("lon", self.lon, "degE7");
    visitor("alt", self.alt, "m");
    visitor("vel", self.vel, "m/s");
    visitor("acc", self.acc, "m/s/s");
    visitor("attitude_q", self.attitude_q, "");
    visitor("rates", self.rates, "");
    visitor("position_cov", self.position_cov, "");
    visitor("custom_state", self.custom_state, "");
  }
};

struct AutopilotVersion {
  static constexpr std::uint32_t kId = 148;
  static constexpr std::string_view kName = "AUTOPILOT_VERSION";
  std::uint64_t capabilities = 0;
  std::uint32_t flight_sw_version = 0;
  std::uint32_t middleware_sw_version = 0;
  std::uint32_t os_sw_version = 0;
  std::uint32_t board_version = 0;
  std::array<std::uint8_t, 8> flight_custom_version{};
  std::array<std::uint8_t, 8> middleware_custom_version{};
  std::array<std::uint8_t, 8> os_custom_version{};
  std::uint16_t vendor_id = 0;
  std::uint16_t product_id = 0;
  std::uint64_t uid = 0;
  std::array<std::uint8_t, 18> uid2{};

  static constexpr void Visit(auto& self, auto&& visitor) {
    visitor("capabilities", self.capabilities, "");
    visitor("flight_sw_version", self.flight_sw_version, "");
    visitor("middleware_sw_version", self.middleware_sw_version, "");
    visitor("os_sw_version", self.os_sw_version, "");
    visitor("board_version", self.board_version, "");
    visitor("flight_custom_version", self.flight_custom_version, "");
    visitor("middleware_custom_version", self.middleware_custom_version, "");
    visitor("os_custom_version", self.os_custom_version, "");
    visitor("vendor_id", self.vendor_id, "");
    visitor("product_id", self.product_id, "");
    visitor("uid", self.uid, "");
    visitor.Extensions();
    visitor("uid2", self.uid2, "");
  }
};

struct LandingTarget {
  static constexpr std::uint32_t kId = 149;
  static constexpr std::string_view kName = "LANDING_TARGET";
  std::uint64_t time_usec = 0;
  std::uint8_t target_num = 0;
  std::uint8_t frame = 0;
  float angle_x = 0;
  float angle_y = 0;
  float distance = 0;
  float size_x = 0;
  float size_y = 0;
  float x = 0;
  float y = 0;
  float z = 0;
  std::array<float, 4> q{};
  std::uint8_t type = 0;
  std::uint8_t position_valid = 0;

  static constexpr void Visit(auto& self, auto&& visitor) {
    visitor("time_usec", self.time_usec, "us");
    visitor("target_num", self.target_num, "");
    visitor("frame", self.frame, "");
    visitor("angle_x", self.angle_x, "rad");
    visitor("angle_y", self.angle_y, "rad");
    visitor("distance", self.distance, "m");
    visitor("size_x", self.size_x, "rad");
    visitor("size_y", self.size_y, "rad");
    visitor.Extensions();
    visitor("x", self.x, "m");
    visitor("y", self.y, "m");
    visitor("z", self.z, "m");
    visitor("q", self.q, "");
    visitor("type", self.type, "");
    visitor("position_valid", self.position_valid, "");
  }
};

struct EkfStatusReport {
  static constexpr std::uint32_t kId = 193;
  static constexpr std::string_view kName = "EKF_STATUS_REPORT";
  std::uint16_t flags = 0;
  float velocity_variance = 0;
  float pos_horiz_variance = 0;
  float pos_vert_variance = 0;
  float compass_variance = 0;
  float terrain_alt_variance = 0;
  float airspeed_variance = 0;

  static constexpr void Visit(auto& self, auto&& visitor) {
    visitor("flags", self.flags, "");
    visitor("velocity_variance", self.velocity_variance, "");
    visitor("pos_horiz_variance", self.pos_horiz_variance, "");
    visitor("pos_vert_variance", self.pos_vert_variance, "");
    visitor("compass_variance", self.compass_variance, "");
    visitor("terrain_alt_variance", self.terrain_alt_variance, "");
    visitor.Extensions();
    visitor("airspeed_variance", self.airspeed_variance, "");
  }
};

struct EstimatorStatus {
  static constexpr std::uint32_t kId = 230;
  static constexpr std::string_view kName = "ESTIMATOR_STATUS";
  std::uint64_t time_usec = 0;
  std::uint16_t flags = 0;
  float vel_ratio = 0;
  float pos_horiz_ratio = 0;
  float pos_vert_ratio = 0;
  float mag_ratio = 0;
  float hagl_ratio = 0;
  float tas_ratio = 0;
  float pos_horiz_accuracy = 0;
  float pos_vert_accuracy = 0;

  static constexpr void Visit(auto& self, auto&& visitor) {
    visitor("time_usec", self.time_usec, "us");
    visitor("flags", self.flags, "");
    visitor("vel_ratio", self.vel_ratio, "");
    visitor("pos_horiz_ratio", self.pos_horiz_ratio, "");
    visitor("pos_vert_ratio", self.pos_vert_ratio, "");
    visitor("mag_ratio", self.mag_ratio, "");
    visitor("hagl_ratio", self.hagl_ratio, "");
    visitor("tas_ratio", self.tas_ratio, "");
    visitor("pos_horiz_accuracy", self.pos_horiz_accuracy, "m");
    visitor("pos_vert_accuracy", self.pos_vert_accuracy, "m");
  }
};

struct HomePosition {
  static constexpr std::uint32_t kId = 242;
  static constexpr std::string_view kName = "HOME_POSITION";
  std::int32_t latitude = 0;
  std::int32_t longitude = 0;
  std::int32_t altitude = 0;
  float x = 0;
  float y = 0;
  float z = 0;
  std::array<float, 4> q{};
  float approach_x = 0;
  float approach_y = 0;
  float approach_z = 0;
  std::uint64_t time_usec = 0;

  static constexpr void Visit(auto& self, auto&& visitor) {
    visitor("latitude", self.latitude, "degE7");
    visitor("longitude", self.longitude, "degE7");
    visitor("altitude", self.altitude, "mm");
    visitor("x", self.x, "m");
    visitor("y", self.y, "m");
    visitor("z", self.z, "m");
    visitor("q", self.q, "");
    visitor("approach_x", self.approach_x, "m");
    visitor("approach_y", self.approach_y, "m");
    visitor("approach_z", self.approach_z, "m");
    visitor.Extensions();
    visitor("time_usec", self.time_usec, "us");
  }
};

struct MessageInterval {
  static constexpr std::uint32_t kId = 244;
  static constexpr std::string_view kName = "MESSAGE_INTERVAL";
  std::uint16_t message_id = 0;
  std::int32_t interval_us = 0;

  static constexpr void Visit(auto& self, auto&& visitor) {
    visitor("message_id", self.message_id, "");
    visitor("interval_us", self.interval_us, "us");
  }
};

struct ExtendedSysState {
  static constexpr std::uint32_t kId = 245;
  static constexpr std::string_view kName = "EXTENDED_SYS_STATE";
  std::uint8_t vtol_state = 0;
  std::uint8_t landed_state = 0;

  static constexpr void Visit(auto& self, auto&& visitor) {
    visitor("vtol_state", self.vtol_state, "");
    visitor("landed_state", self.landed_state, "");
  }
};

struct Statustext {
  static constexpr std::uint32_t kId = 253;
  static constexpr std::string_view kName = "STATUSTEXT";
  std::uint8_t severity = 0;
  std::array<char, 50> text{};
  std::uint16_t id = 0;
  std::uint8_t chunk_seq = 0;

  static constexpr void Visit(auto& self, auto&& visitor) {
    visitor("severity", self.severity, "");
    visitor("text", self.text, "");
    visitor.Extensions();
    visitor("id", self.id, "");
    visitor("chunk_seq", self.chunk_seq, "");
  }
};

// The old report of a gimbal: roll and pitch against the horizon, yaw against the vehicle.
struct MountOrientation {
  static constexpr std::uint32_t kId = 265;
  static constexpr std::string_view kName = "MOUNT_ORIENTATION";
  std::uint32_t time_boot_ms = 0;
  float roll = 0;
  float pitch = 0;
  float yaw = 0;
  float yaw_absolute = 0;

  static constexpr void Visit(auto& self, auto&& visitor) {
    visitor("time_boot_ms", self.time_boot_ms, "ms");
    visitor("roll", self.roll, "deg");
    visitor("pitch", self.pitch, "deg");
    visitor("yaw", self.yaw, "deg");
    visitor.Extensions();
    visitor("yaw_absolute", self.yaw_absolute, "deg");
  }
};

struct GimbalManagerInformation {
  static constexpr std::uint32_t kId = 280;
  static constexpr std::string_view kName = "GIMBAL_MANAGER_INFORMATION";
  std::uint32_t time_boot_ms = 0;
  std::uint32_t cap_flags = 0;
  std::uint8_t gimbal_device_id = 0;
  float roll_min = 0;
  float roll_max = 0;
  float pitch_min = 0;
  float pitch_max = 0;
  float yaw_min = 0;
  float yaw_max = 0;

  static constexpr void Visit(auto& self, auto&& visitor) {
    visitor("time_boot_ms", self.time_boot_ms, "ms");
    visitor("cap_flags", self.cap_flags, "");
    visitor("gimbal_device_id", self.gimbal_device_id, "");
    visitor("roll_min", self.roll_min, "rad");
    visitor("roll_max", self.roll_max, "rad");
    visitor("pitch_min", self.pitch_min, "rad");
    visitor("pitch_max", self.pitch_max, "rad");
    visitor("yaw_min", self.yaw_min, "rad");
    visitor("yaw_max", self.yaw_max, "rad");
  }
};

struct GimbalManagerStatus {
  static constexpr std::uint32_t kId = 281;
  static constexpr std::string_view kName = "GIMBAL_MANAGER_STATUS";
  std::uint32_t time_boot_ms = 0;
  std::uint32_t flags = 0;
  std::uint8_t gimbal_device_id = 0;
  std::uint8_t primary_control_sysid = 0;
  std::uint8_t primary_control_compid = 0;
  std::uint8_t secondary_control_sysid = 0;
  std::uint8_t secondary_control_compid = 0;

  static constexpr void Visit(auto& self, auto&& visitor) {
    visitor("time_boot_ms", self.time_boot_ms, "ms");
    visitor("flags", self.flags, "");
    visitor("gimbal_device_id", self.gimbal_device_id, "");
    visitor("primary_control_sysid", self.primary_control_sysid, "");
    visitor("primary_control_compid", self.primary_control_compid, "");
    visitor("secondary_control_sysid", self.secondary_control_sysid, "");
    visitor("secondary_control_compid", self.secondary_control_compid, "");
  }
};

struct GimbalDeviceAttitudeStatus {
  static constexpr std::uint32_t kId = 285;
  static constexpr std::string_view kName = "GIMBAL_DEVICE_ATTITUDE_STATUS";
  std::uint8_t target_system = 0;
  std::uint8_t target_component = 0;
  std::uint32_t time_boot_ms = 0;
  std::uint16_t flags = 0;
  std::array<float, 4> q{};
  float angular_velocity_x = 0;
  float angular_velocity_y = 0;
  float angular_velocity_z = 0;
  std::uint32_t failure_flags = 0;
  float delta_yaw = 0;
  float delta_yaw_velocity = 0;
  std::uint8_t gimbal_device_id = 0;

  static constexpr void Visit(auto& self, auto&& visitor) {
    visitor("target_system", self.target_system, "");
    visitor("target_component", self.target_component, "");
    visitor("time_boot_ms", self.time_boot_ms, "ms");
    visitor("flags", self.flags, "");
    visitor("q", self.q, "");
    visitor("angular_velocity_x", self.angular_velocity_x, "rad/s");
    visitor("angular_velocity_y", self.angular_velocity_y, "rad/s");
    visitor("angular_velocity_z", self.angular_velocity_z, "rad/s");
    visitor("failure_flags", self.failure_flags, "");
    visitor.Extensions();
    visitor("delta_yaw", self.delta_yaw, "rad");
    visitor("delta_yaw_velocity", self.delta_yaw_velocity, "rad/s");
    visitor("gimbal_device_id", self.gimbal_device_id, "");
  }
};

struct GimbalManagerSetPitchyaw {
  static constexpr std::uint32_t kId = 287;
  static constexpr std::string_view kName = "GIMBAL_MANAGER_SET_PITCHYAW";
  std::uint8_t target_system = 0;
  std::uint8_t target_component = 0;
  std::uint32_t flags = 0;
  std::uint8_t gimbal_device_id = 0;
  float pitch = 0;
  float yaw = 0;
  float pitch_rate = 0;
  float yaw_rate = 0;

  static constexpr void Visit(auto& self, auto&& visitor) {
    visitor("target_system", self.target_system, "");
    visitor("target_component", self.target_component, "");
    visitor("flags", self.flags, "");
    visitor("gimbal_device_id", self.gimbal_device_id, "");
    visitor("pitch", self.pitch, "rad");
    visitor("yaw", self.yaw, "rad");
    visitor("pitch_rate", self.pitch_rate, "rad/s");
    visitor("yaw_rate", self.yaw_rate, "rad/s");
  }
};

struct Odometry {
  static constexpr std::uint32_t kId = 331;
  static constexpr std::string_view kName = "ODOMETRY";
  std::uint64_t time_usec = 0;
  std::uint8_t frame_id = 0;
  std::uint8_t child_frame_id = 0;
  float x = 0;
  float y = 0;
  float z = 0;
  std::array<float, 4> q{};
  float vx = 0;
  float vy = 0;
  float vz = 0;
  float rollspeed = 0;
  float pitchspeed = 0;
  float yawspeed = 0;
  std::array<float, 21> pose_covariance{};
  std::array<float, 21> velocity_covariance{};
  std::uint8_t reset_counter = 0;
  std::uint8_t estimator_type = 0;
  std::int8_t quality = 0;

  static constexpr void Visit(auto& self, auto&& visitor) {
    visitor("time_usec", self.time_usec, "us");
    visitor("frame_id", self.frame_id, "");
    visitor("child_frame_id", self.child_frame_id, "");
    visitor("x", self.x, "m");
    visitor("y", self.y, "m");
    visitor("z", self.z, "m");
    visitor("q", self.q, "");
    visitor("vx", self.vx, "m/s");
    visitor("vy", self.vy, "m/s");
    visitor("vz", self.vz, "m/s");
    visitor("rollspeed", self.rollspeed, "rad/s");
    visitor("pitchspeed", self.pitchspeed, "rad/s");
    visitor("yawspeed", self.yawspeed, "rad/s");
    visitor("pose_covariance", self.pose_covariance, "");
    visitor("velocity_covariance", self.velocity_covariance, "");
    visitor.Extensions();
    visitor("reset_counter", self.reset_counter, "");
    visitor("estimator_type", self.estimator_type, "");
    visitor("quality", self.quality, "%");
  }
};

struct CurrentMode {
  static constexpr std::uint32_t kId = 436;
  static constexpr std::string_view kName = "CURRENT_MODE";
  std::uint8_t standard_mode = 0;
  std::uint32_t custom_mode = 0;
  std::uint32_t intended_custom_mode = 0;

  static constexpr void Visit(auto& self, auto&& visitor) {
    visitor("standard_mode", self.standard_mode, "");
    visitor("custom_mode", self.custom_mode, "");
    visitor("intended_custom_mode", self.intended_custom_mode, "");
  }
};

// Dialect development: message of PX4's vision target estimator.
struct TargetRelative {
  static constexpr std::uint32_t kId = 511;
  static constexpr std::string_view kName = "TARGET_RELATIVE";
  std::uint64_t timestamp = 0;
  std::uint8_t id = 0;
  std::uint8_t frame = 0;
  float x = 0;
  float y = 0;
  float z = 0;
  std::array<float, 3> pos_std{};
  float yaw_std = 0;
  std::array<float, 4> q_target{};
  std::array<float, 4> q_sensor{};
  std::uint8_t type = 0;

  static constexpr void Visit(auto& self, auto&& visitor) {
    visitor("timestamp", self.timestamp, "us");
    visitor("id", self.id, "");
    visitor("frame", self.frame, "");
    visitor("x", self.x, "m");
    visitor("y", self.y, "m");
    visitor("z", self.z, "m");
    visitor("pos_std", self.pos_std, "m");
    visitor("yaw_std", self.yaw_std, "rad");
    visitor("q_target", self.q_target, "");
    visitor("q_sensor", self.q_sensor, "");
    visitor("type", self.type, "");
  }
};

}  // namespace kestrel::mavlink
