// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/simulation/autopilots/sitl_result.h"

#include <fmt/format.h>

#include "kestrel/core/geometry/angles.h"

namespace kestrel {
namespace {

std::string LandingInWords(const SitlResult& result) {
  if (!result.contact) return "did not come down in a landing mode\n";
  const std::string where =
      result.contact->on_board
          ? fmt::format(
                "on the board, {:.3f} m from the pattern's centre, {:.1f} degrees from its "
                "heading (true)",
                result.offset_m(), Degrees(result.contact->heading_in_pattern))
          : fmt::format("beside the board, {:.2f} m from the pattern's centre (true)",
                        result.offset_m());
  std::string disarmed = "not disarmed";
  if (result.is_disarmed) disarmed = fmt::format("disarmed {:.1f} s later", result.disarm_s);
  if (result.was_forced) disarmed = "disarmed by force";
  return fmt::format("came down {}, {:.1f} s after the landing began; {}\n", where,
                     result.landing_s, disarmed);
}

std::string GuidingInWords(const SitlResult& result) {
  if (result.guided_entries == 0) return "";
  std::string words =
      fmt::format("guided for {:.1f} s by {} set-points", result.guided_s, result.set_points);
  if (result.guided_entries > 1) words += fmt::format(", {} times", result.guided_entries);
  if (result.left) {
    words +=
        fmt::format("; {} set-points after the mode was left", result.set_points_after_take_back);
    if (result.set_points_after_take_back > 0) {
      words += fmt::format(", the last {:.2f} s later", result.last_set_point_after_s);
    }
  }
  return words + "\n";
}

std::string GrabbingInWords(const SitlResult& result) {
  if (!result.grab) return "";
  return fmt::format("the gripper closed {}: {} object {}, {:.3f} m from its middle (true)\n",
                     result.grabs == 1 ? "once" : fmt::format("{} times", result.grabs),
                     result.grab->is_taken ? "took" : "missed", result.grab->object,
                     result.grab->offset_m);
}

}  // namespace

std::string InWords(const SitlResult& result) {
  const std::string room = result.has_left_room ? "has touched a wall or the ceiling\n" : "";
  return LandingInWords(result) + GuidingInWords(result) + GrabbingInWords(result) + room;
}

}  // namespace kestrel
