// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "kestrel/comms/mavlink/camera_reports.h"
#include "kestrel/comms/mavlink/messages.h"
#include "kestrel/comms/mavlink/packet.h"
#include "kestrel/core/base/time.h"

namespace kestrel {

// All functions are called in the thread that calls CameraComponent; none may be empty.
struct CameraListener {
  std::function<void(const CameraMessage&)> send;
  // A person has marked a region in the picture that was shown at 'time'. The middle of the region
  // is within the image. 'request' names the mark for CameraComponent::Answer.
  std::function<void(int request, const ImageRegion& region, Time time)> mark;
  // Nothing is to be followed any more.
  std::function<void()> stop;
  // A line for the user. 'is_warning': something was refused, or is wrong.
  std::function<void(const std::string& text, bool is_warning)> report;
};

// The camera component of the vehicle, at which ground stations mark what is followed: MAVLink's
// camera protocol v2 (mavlink.io/en/services/camera). It describes the camera, takes marks, and
// sends the state of the tracking to whom asked for it. Each ground station has intervals and
// commands of its own: none ends what another one wants. Does not throw; allocates for lines to the
// user only.
class CameraComponent {
 public:
  // After so long without an answer a mark is refused.
  static constexpr Duration kMarkPatience = std::chrono::seconds(1);

  CameraComponent(const CameraDescription& camera, CameraListener listener);

  // Takes a packet of the link. 'system': the vehicle's.
  void Handle(const mavlink::Packet& packet, std::uint8_t system, Time received);
  // Sends what is due at 'now': the heartbeat, and the reports whose intervals are set.
  void Tick(Time now, const CameraTracking& tracking);
  // Takes the outcome of a mark: why it was refused, or empty when it is followed.
  void Answer(int request, const std::string& refusal);

 private:
  // The newest mark of a ground station.
  struct Mark {
    mavlink::CommandLong command;
    Time received;
    int request = 0;
    std::optional<std::uint8_t> result = {};  // MAV_RESULT; nothing: not known yet
  };
  struct Station {
    std::uint8_t system = 0;  // 0: none
    std::uint8_t component = 0;
    Time heard{};
    std::array<Duration, kCameraReports.size()> intervals{};  // 0: not sent
    std::optional<Mark> mark = {};

    std::string Name() const;
  };
  using Result = std::optional<std::uint8_t>;  // MAV_RESULT; nothing: it is sent later

  void ReportClash(const mavlink::Packet& packet);
  bool IsForThis(const mavlink::CommandLong& command, std::uint8_t system) const;
  Station& StationOf(const mavlink::Packet& packet);
  Result Obey(const mavlink::CommandLong& command, Station* station);
  Result SendReport(float id);
  Result SetInterval(const mavlink::CommandLong& command, Station* station);
  Result SendInterval(float id);
  Result TakeMark(const mavlink::CommandLong& command, Station* station);
  Result Stop(const mavlink::CommandLong& command, const Station& station);
  bool IsRepeated(const mavlink::CommandLong& command, const std::optional<Mark>& mark) const;
  bool IsOwn(float camera_id) const;
  ImageRegion RegionOf(const mavlink::CommandLong& command) const;
  std::optional<std::string> FaultOf(const mavlink::CommandLong& command) const;
  void Refuse(Station* station, std::uint8_t result, const std::string& reason);
  void Acknowledge(const Station& station, std::uint16_t command, std::uint8_t result);
  void RefuseLateMarks();
  void SendReports();
  Duration IntervalOf(std::size_t report) const;

  CameraDescription camera_;
  CameraListener listener_;
  Time now_{};  // when it was last called
  CameraTracking tracking_;
  std::array<Station, 4> stations_{};  // the last ones that sent commands
  std::array<Time, kCameraReports.size()> due_{};
  Time heartbeat_due_{};
  int requests_ = 0;
  bool is_clash_reported_ = false;
};

}  // namespace kestrel
