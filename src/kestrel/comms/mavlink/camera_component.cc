// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/comms/mavlink/camera_component.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "kestrel/comms/mavlink/mavlink_enums.h"

namespace kestrel {
namespace {

constexpr Duration kFastest = std::chrono::milliseconds(50);
// Half the width of the region around a point that has no radius, as a share of the image's width.
constexpr double kPointRadius = 0.03;
constexpr double kLeast_px = 4;  // as RegionTracker::Mark

using Command = mavlink::CommandLong;

// Returns the report that an older command requests; 0: the command is none of them.
std::uint32_t RequestedBy(std::uint16_t command) {
  switch (command) {
    case mavlink::kCommandRequestCameraInformation:
      return mavlink::CameraInformation::kId;
    case mavlink::kCommandRequestCameraSettings:
      return mavlink::CameraSettings::kId;
    case mavlink::kCommandRequestCaptureStatus:
      return mavlink::CameraCaptureStatus::kId;
    case mavlink::kCommandRequestStreamInformation:
      return mavlink::VideoStreamInformation::kId;
    case mavlink::kCommandRequestStreamStatus:
      return mavlink::VideoStreamStatus::kId;
    default:
      return 0;
  }
}

std::optional<std::size_t> IndexOf(float id) {
  const auto* found =
      std::find_if(kCameraReports.begin(), kCameraReports.end(),
                   [&](std::uint32_t one) { return static_cast<float>(one) == id; });
  if (found == kCameraReports.end()) return std::nullopt;
  return found - kCameraReports.begin();
}

bool IsBox(const Command& command) { return command.command == mavlink::kCommandTrackRectangle; }

// Parameters that are not given are NaN, or 0.
bool HasSameMark(const Command& a, const Command& b) {
  const auto equal = [](float x, float y) { return x == y || (std::isnan(x) && std::isnan(y)); };
  return a.command == b.command && equal(a.param1, b.param1) && equal(a.param2, b.param2) &&
         equal(a.param3, b.param3) && equal(a.param4, b.param4) && equal(a.param5, b.param5);
}

}  // namespace

CameraComponent::CameraComponent(const CameraDescription& camera, CameraListener listener)
    : camera_(camera), listener_(std::move(listener)) {}

std::string CameraComponent::Station::Name() const {
  return fmt::format("system {} component {}", system, component);
}

void CameraComponent::Handle(const mavlink::Packet& packet, std::uint8_t system, Time received) {
  now_ = received;
  if (packet.system == system && packet.component == camera_.component) return ReportClash(packet);
  const auto command = packet.As<Command>();
  if (!command || !IsForThis(*command, system)) return;
  Station& station = StationOf(packet);
  const Result result = Obey(*command, &station);
  // Whoever asks all components does not want to hear from each one that cannot answer.
  const bool is_for_all = command->target_component == 0;
  if (!result || (is_for_all && *result != mavlink::kResultAccepted)) return;
  Acknowledge(station, command->command, *result);
}

void CameraComponent::ReportClash(const mavlink::Packet& packet) {
  if (std::exchange(is_clash_reported_, true)) return;
  listener_.report(
      fmt::format("another camera sends as system {} component {}, or the link sends our own "
                  "messages back: expected another fly.link.camera_id",
                  packet.system, packet.component),
      true);
}

bool CameraComponent::IsForThis(const Command& command, std::uint8_t system) const {
  return (command.target_system == 0 || command.target_system == system) &&
         (command.target_component == 0 || command.target_component == camera_.component);
}

// A new one takes the place of the one that was silent for the longest time.
CameraComponent::Station& CameraComponent::StationOf(const mavlink::Packet& packet) {
  auto* station = std::find_if(stations_.begin(), stations_.end(), [&](const Station& one) {
    return one.system == packet.system && one.component == packet.component;
  });
  if (station == stations_.end()) {
    station =
        std::min_element(stations_.begin(), stations_.end(),
                         [](const Station& a, const Station& b) { return a.heard < b.heard; });
    *station = {.system = packet.system, .component = packet.component};
  }
  station->heard = now_;
  return *station;
}

CameraComponent::Result CameraComponent::Obey(const Command& command, Station* station) {
  switch (command.command) {
    case mavlink::kCommandRequestMessage:
      return SendReport(command.param1);
    case mavlink::kCommandSetMessageInterval:
      return SetInterval(command, station);
    case mavlink::kCommandGetMessageInterval:
      return SendInterval(command.param1);
    case mavlink::kCommandTrackPoint:
    case mavlink::kCommandTrackRectangle:
      return TakeMark(command, station);
    case mavlink::kCommandStopTracking:
      return Stop(command, *station);
    default:
      return SendReport(static_cast<float>(RequestedBy(command.command)));
  }
}

CameraComponent::Result CameraComponent::SendReport(float id) {
  const auto index = IndexOf(id);
  if (!index) return mavlink::kResultUnsupported;
  const auto boot_ms = static_cast<std::uint32_t>(
      std::chrono::duration_cast<std::chrono::milliseconds>(now_.time_since_epoch()).count());
  const auto report = CameraReportOf(kCameraReports[*index], camera_, tracking_, boot_ms);
  if (!report) return mavlink::kResultUnsupported;
  listener_.send(*report);
  return mavlink::kResultAccepted;
}

// An interval of 0 means the usual one, and of -1 the end; usually no report is sent.
CameraComponent::Result CameraComponent::SetInterval(const Command& command, Station* station) {
  constexpr float kLongest_us = 2e9f;  // the largest that MESSAGE_INTERVAL reports
  const auto index = IndexOf(command.param1);
  if (!index) return mavlink::kResultUnsupported;
  const float interval_us = command.param2;
  if (!(interval_us >= -1 && interval_us <= kLongest_us)) return mavlink::kResultDenied;
  Duration& interval = station->intervals[*index];
  interval = Duration::zero();
  if (interval_us > 0) {
    interval = std::max<Duration>(
        kFastest, std::chrono::microseconds(static_cast<std::int64_t>(interval_us)));
    due_[*index] = now_;
  }
  return mavlink::kResultAccepted;
}

CameraComponent::Result CameraComponent::SendInterval(float id) {
  const auto index = IndexOf(id);
  if (!index) return mavlink::kResultUnsupported;
  constexpr std::int32_t kOff = -1;
  const auto interval_us =
      std::chrono::duration_cast<std::chrono::microseconds>(IntervalOf(*index)).count();
  mavlink::MessageInterval message;
  message.message_id = static_cast<std::uint16_t>(kCameraReports[*index]);
  message.interval_us = interval_us > 0 ? static_cast<std::int32_t>(interval_us) : kOff;
  listener_.send(message);
  return mavlink::kResultAccepted;
}

// Returns the shortest interval that a ground station wants; 0: none wants the report.
Duration CameraComponent::IntervalOf(std::size_t report) const {
  Duration shortest = Duration::zero();
  for (const Station& station : stations_) {
    const Duration interval = station.intervals[report];
    if (interval == Duration::zero()) continue;
    shortest = shortest == Duration::zero() ? interval : std::min(shortest, interval);
  }
  return shortest;
}

// A mark that is repeated, as its acknowledgement was lost, would move the region back to where the
// thing was.
CameraComponent::Result CameraComponent::TakeMark(const Command& command, Station* station) {
  if (!IsOwn(IsBox(command) ? command.param5 : command.param4)) return mavlink::kResultDenied;
  if (IsRepeated(command, station->mark)) return station->mark->result;
  station->mark = Mark{command, now_, ++requests_};
  if (const auto fault = FaultOf(command)) {
    Refuse(station, mavlink::kResultDenied, *fault);
    return std::nullopt;
  }
  listener_.mark(requests_, RegionOf(command), now_);
  return std::nullopt;
}

CameraComponent::Result CameraComponent::Stop(const Command& command, const Station& station) {
  if (!IsOwn(command.param1)) return mavlink::kResultDenied;
  // The same mark once more is then a new one.
  for (Station& one : stations_) {
    if (one.mark && one.mark->result) one.mark.reset();
  }
  listener_.stop();
  listener_.report(station.Name() + " ends the following", false);
  return mavlink::kResultAccepted;
}

bool CameraComponent::IsRepeated(const Command& command, const std::optional<Mark>& mark) const {
  constexpr Duration kTwice = std::chrono::seconds(2), kRepeated = std::chrono::seconds(10);
  if (!mark || !HasSameMark(command, mark->command)) return false;
  return now_ - mark->received < (command.confirmation > 0 ? kRepeated : kTwice);
}

// Senders that do not know the parameter leave it out: NaN.
bool CameraComponent::IsOwn(float camera_id) const {
  return std::isnan(camera_id) || camera_id == 0 || camera_id == camera_.component;
}

ImageRegion CameraComponent::RegionOf(const Command& command) const {
  if (IsBox(command)) return {command.param1, command.param2, command.param3, command.param4};
  const double width = command.param3 > 0 ? command.param3 : kPointRadius;
  const double height = width * camera_.width_px / camera_.height_px;
  return {command.param1 - width, command.param2 - height, command.param1 + width,
          command.param2 + height};
}

std::optional<std::string> CameraComponent::FaultOf(const Command& command) const {
  constexpr float kLargestRadius = 0.5f;
  const auto is_inside = [](float share) { return share >= 0 && share <= 1; };  // false for NaN
  if (!is_inside(command.param1) || !is_inside(command.param2) ||
      (IsBox(command) && (!is_inside(command.param3) || !is_inside(command.param4)))) {
    return "it is not within the picture";
  }
  if (!IsBox(command) && (command.param3 < 0 || command.param3 > kLargestRadius)) {
    return "its radius is not within 0 to 0.5 of the picture's width";
  }
  const ImageRegion region = RegionOf(command);
  if ((region.right - region.left) * camera_.width_px < kLeast_px ||
      (region.bottom - region.top) * camera_.height_px < kLeast_px) {
    return fmt::format("it is smaller than {:g} px", kLeast_px);
  }
  return std::nullopt;
}

void CameraComponent::Refuse(Station* station, std::uint8_t result, const std::string& reason) {
  station->mark->result = result;
  Acknowledge(*station, station->mark->command.command, result);
  listener_.report(fmt::format("the mark of {} is refused: {}", station->Name(), reason), true);
}

void CameraComponent::Answer(int request, const std::string& refusal) {
  for (Station& station : stations_) {
    if (!station.mark || station.mark->request != request || station.mark->result) continue;
    if (!refusal.empty()) return Refuse(&station, mavlink::kResultTemporarilyRejected, refusal);
    station.mark->result = mavlink::kResultAccepted;
    Acknowledge(station, station.mark->command.command, mavlink::kResultAccepted);
    const ImageRegion region = RegionOf(station.mark->command);
    return listener_.report(
        fmt::format("follows what {} has marked: {:.0f} x {:.0f} px", station.Name(),
                    (region.right - region.left) * camera_.width_px,
                    (region.bottom - region.top) * camera_.height_px),
        false);
  }
}

void CameraComponent::Acknowledge(const Station& station, std::uint16_t command,
                                  std::uint8_t result) {
  mavlink::CommandAck ack;
  ack.command = command;
  ack.result = result;
  ack.target_system = station.system;
  ack.target_component = station.component;
  listener_.send(ack);
}

void CameraComponent::Tick(Time now, const CameraTracking& tracking) {
  constexpr Duration kHeartbeat = std::chrono::seconds(1);
  now_ = now;
  tracking_ = tracking;
  if (now >= heartbeat_due_) {
    heartbeat_due_ = now + kHeartbeat;
    constexpr std::uint8_t kMavlinkVersion = 3;
    mavlink::Heartbeat heartbeat;
    heartbeat.type = mavlink::kTypeCamera;
    heartbeat.autopilot = mavlink::kAutopilotInvalid;
    heartbeat.system_status = mavlink::kStateActive;
    heartbeat.mavlink_version = kMavlinkVersion;
    listener_.send(heartbeat);
  }
  RefuseLateMarks();
  SendReports();
}

void CameraComponent::RefuseLateMarks() {
  for (Station& station : stations_) {
    if (!station.mark || station.mark->result) continue;
    if (now_ - station.mark->received < kMarkPatience) continue;
    Refuse(&station, mavlink::kResultTemporarilyRejected, "the camera gives no picture");
  }
}

void CameraComponent::SendReports() {
  for (std::size_t i = 0; i < kCameraReports.size(); ++i) {
    const Duration interval = IntervalOf(i);
    if (interval == Duration::zero() || now_ < due_[i]) continue;
    due_[i] = now_ + interval;
    SendReport(static_cast<float>(kCameraReports[i]));
  }
}

}  // namespace kestrel
