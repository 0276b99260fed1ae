// SPDX-License-Identifier: BSD-3-Clause
// Kestrel's side of interop.js: "write [KEY]" prints a line of JSON for each message of messages.h,
// with all fields set, and its frame; "read [KEY]" reads frames in hexadecimal digits, one per
// line, and prints the same for them. With the file of a key the frames are signed, and must be.
#include <array>
#include <cstdint>
#include <iostream>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "kestrel/comms/mavlink/camera_messages.h"
#include "kestrel/comms/mavlink/messages.h"
#include "kestrel/comms/mavlink/packet_parser.h"
#include "kestrel/comms/mavlink/packet_writer.h"
#include "kestrel/comms/mavlink/signing.h"

namespace {

namespace mavlink = kestrel::mavlink;

constexpr std::uint64_t kUnixTime_ns = 1'700'000'000'000'000'000;

// Visitor that gives each field another value, with all bytes in use.
class FieldFiller {
 public:
  template <class Value>
  void operator()(std::string_view /*name*/, Value& value, std::string_view /*unit*/) {
    Fill(&value);
  }
  void Extensions() {}

 private:
  template <class Element, std::size_t count>
  void Fill(std::array<Element, count>* values) {
    for (Element& value : *values) Fill(&value);
  }
  template <class Value>
  void Fill(Value* value) {
    ++count_;
    if constexpr (std::is_same_v<Value, char>) {
      *value = static_cast<char>('a' + count_ % 26);
    } else if constexpr (std::is_floating_point_v<Value>) {
      *value = static_cast<Value>((count_ % 2 == 0 ? -1 : 1) * (count_ + 0.375));
    } else {
      *value = static_cast<Value>(std::numeric_limits<Value>::max() / 3 + count_);
    }
  }

  int count_ = 0;
};

// Visitor that writes fields as JSON: 64-bit numbers as texts, because JavaScript's have 53 bits.
class JsonWriter {
 public:
  explicit JsonWriter(std::string* json) : json_(json) {}

  template <class Value>
  void operator()(std::string_view name, const Value& value, std::string_view /*unit*/) {
    *json_ += fmt::format("{}\"{}\":{}", json_->empty() ? "" : ",", name, Text(value));
  }
  void Extensions() {}

 private:
  template <std::size_t count>
  static std::string Text(const std::array<char, count>& text) {
    return fmt::format("\"{}\"", std::string(text.data(), count));
  }
  template <class Element, std::size_t count>
  static std::string Text(const std::array<Element, count>& values) {
    std::vector<std::string> texts;
    for (const Element value : values) texts.push_back(Text(value));
    return fmt::format("[{}]", fmt::join(texts, ","));
  }
  template <class Value>
  static std::string Text(Value value) {
    return sizeof(Value) == 8 ? fmt::format("\"{}\"", value) : fmt::format("{}", value);
  }

  std::string* json_;
};

template <class Message>
std::string FieldsOf(const Message& message) {
  std::string json;
  Message::Visit(message, JsonWriter(&json));
  return json;
}

template <class Visitor, class... Messages>
void ForEachOf(const Visitor& visitor) {
  (visitor(Messages{}), ...);
}

template <class Visitor>
void ForEachMessage(const Visitor& visitor) {
  using namespace kestrel::mavlink;  // NOLINT(google-build-using-namespace)
  ForEachOf<Visitor, Heartbeat, SysStatus, SystemTime, SetMode, ParamRequestRead, ParamRequestList,
            ParamValue, ParamSet, GpsRawInt, Attitude, AttitudeQuaternion, LocalPositionNed,
            GlobalPositionInt, GpsGlobalOrigin, RcChannels, RequestDataStream, CommandLong,
            CommandAck, SetAttitudeTarget, SetPositionTargetLocalNed, SimState, Timesync,
            HilStateQuaternion, DistanceSensor, FollowTarget, AutopilotVersion, LandingTarget,
            EkfStatusReport, EstimatorStatus, HomePosition, MessageInterval, ExtendedSysState,
            Statustext, CameraInformation, CameraSettings, CameraCaptureStatus,
            VideoStreamInformation, VideoStreamStatus, CameraFovStatus, CameraTrackingImageStatus,
            CameraTrackingGeoStatus, CurrentMode, TargetRelative>(visitor);
}

void Print(std::uint32_t id, std::string_view name, const std::string& fields,
           std::span<const std::uint8_t> frame) {
  fmt::print("{{\"id\":{},\"name\":\"{}\",\"fields\":{{{}}},\"frame\":\"{:02x}\"}}\n", id, name,
             fields, fmt::join(frame, ""));
}

void Write(std::optional<mavlink::Signing> signing) {
  mavlink::PacketWriter writer(42, 191);
  ForEachMessage([&](auto message) {
    using Message = decltype(message);
    Message::Visit(message, FieldFiller());
    std::span<const std::uint8_t> frame = writer.Write(message, signing.has_value());
    if (signing) frame = signing->Sign(frame, writer.memory(), kUnixTime_ns);
    Print(Message::kId, Message::kName, FieldsOf(message), frame);
  });
}

void PrintPacket(const mavlink::Packet& packet) {
  ForEachMessage([&](auto message) {
    using Message = decltype(message);
    const auto read = packet.As<Message>();
    if (read) Print(Message::kId, Message::kName, FieldsOf(*read), packet.frame());
  });
}

void Read(std::optional<mavlink::Signing> signing) {
  mavlink::PacketParser parser;
  for (std::string line; std::getline(std::cin, line);) {
    std::vector<std::uint8_t> bytes;
    for (std::size_t i = 0; i + 1 < line.size(); i += 2) {
      bytes.push_back(static_cast<std::uint8_t>(std::stoi(line.substr(i, 2), nullptr, 16)));
    }
    parser.Parse(bytes, [&](const mavlink::Packet& packet) {
      if (!signing || signing->Check(packet, kUnixTime_ns) == mavlink::Signing::Verdict::kGood) {
        PrintPacket(packet);
      }
    });
  }
}

}  // namespace

int main(int argc, char** argv) {
  const std::vector<std::string> arguments(argv + 1, argv + argc);
  try {
    std::optional<mavlink::Signing> signing;
    if (arguments.size() > 1) signing.emplace(mavlink::ReadSigningKey(arguments[1]), 0);
    if (arguments.empty() || arguments[0] == "write") {
      Write(signing);
    } else {
      Read(signing);
    }
  } catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return 1;
  }
  return 0;
}
