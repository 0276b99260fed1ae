// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/doctor/check_list.h"

#include <array>

#include <fmt/format.h>

#include "kestrel/flight/doctor/parameter_checks.h"

namespace kestrel {
namespace {

constexpr std::array<ListedCheck, 44> kChecks = {{
    {"image size", "images have the size of the calibration"},
    {"lens model", "every pixel has a ray: the distortion does not bend back before the rim"},
    {"principal point, pixels", "the optical axis is near the middle, and pixels are square"},
    {"calibration by the pattern", "edges of the pattern are where the calibration projects them"},
    {"images", "the camera opens (rights: the group video) and delivers"},
    {"frame rate", "at least 12 images per second; below 8 is wrong"},
    {"steadiness", "images come at equal intervals"},
    {"missed images", "the program takes every image of the camera"},
    {"frozen images", "no image comes twice"},
    {"capture clock", "times of capture rise without jumps and are not old"},
    {"video delay", "the delay of a network's camera is known and short enough"},
    {"exposure", "neither dark nor saturated"},
    {"focus", "sharp edges are at most 3.5 px wide"},
    {"mount", "T_BS has the camera look down: body x ahead, y left, z up"},
    {"mount against gravity", "by mount and attitude the pattern is level"},
    {"mount against motion", "by mount and poses the pattern stays where it is"},
    {"beside the first camera", "a further one shows the pattern there, and at the same time"},
    {"line", "it opens (rights: the group dialout), and packets arrive whole: baud, wires"},
    {"signing", "both sides sign with the same key, or neither"},
    {"heartbeat", "there is an autopilot, and it does not restart"},
    {"version", "ArduPilot or PX4, not too old"},
    {"vehicle", "a multicopter"},
    {"attitude", "comes as often as requested"},
    {"position", "comes as often as requested"},
    {"position estimate", "the autopilot trusts its own position"},
    {"origin", "--pad-position: there is one, or fly.pad_origin"},
    {"autopilot's clock", "TIMESYNC is answered, and the clock does not jump"},
    {"round trip", "at most 100 ms, with px4-vte 10 ms"},
    {"others on the line", "one companion, one set of ids, one source of landing targets"},
    {"gimbal", "of a camera on one: reports at least 10 times a second"},
    {"gimbal's motors", "its attitude neither jumps nor tilts with the UAV"},
    {"gimbal against images", "by its reports the pattern stays where it is"},
    {"gimbal's control", "--point, --guide: nobody else has it"},
    {"gimbal's range", "the camera can look straight down"},
    {"frame of the target", "--profile is that of the autopilot"},
    {"moving target", "with PX4 only by kestrel fly --guide"},
    {"latency", "from light to message as PLND_LAG has it, and below 150 ms"},
    {"parameters", "the autopilot reports them"},
    {"detection time", "well below the interval of the images"},
    {"load", "at most 1.5 processes on each core"},
    {"heat", "below 78 deg C, never slowed since the start"},
    {"power", "no undervoltage of a Raspberry Pi, now or since its start"},
    {"disk", "with --record: writable, fast, not worn, room for a flight of 15 min"},
    {"time of day", "with --record or --signing-key: synchronised (NTP, chrony, GNSS)"},
}};

std::string Rows(const char* title, std::span<const ListedCheck> checks) {
  std::string rows = fmt::format("{}\n", title);
  for (const ListedCheck& check : checks) {
    rows += fmt::format("  {:27}{}\n", check.name, check.wants);
  }
  return rows + "\n";
}

}  // namespace

std::span<const ListedCheck> ListedChecks() { return kChecks; }

std::string CheckTable() {
  return Rows("The checks, and what is good:", kChecks) +
         Rows("Parameters of ArduPilot:", CheckedParameters(AutopilotKind::kArduPilot)) +
         Rows("Parameters of PX4:", CheckedParameters(AutopilotKind::kPx4));
}

}  // namespace kestrel
