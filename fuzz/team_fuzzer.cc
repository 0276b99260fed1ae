// SPDX-License-Identifier: BSD-3-Clause
// For anything that a UAV receives, it neither crashes nor throws, a message that it accepts can be
// sent again, and the map that it makes of it is finite.
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <span>

#include "kestrel/comms/team/team_member.h"
#include "kestrel/comms/team/team_view.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::span bytes(data, size);
  const auto message = kestrel::ParseMessage(bytes);
  if (!message) return 0;
  const auto again = kestrel::EncodeMessage(*message);
  if (!kestrel::ParseMessage(again)) std::abort();
  kestrel::TeamMember member({"a", 1}, {});
  kestrel::Time now;
  for (int i = 0; i < 2; ++i) {
    member.Hear(bytes, now);
    now += std::chrono::seconds(1);
    member.Tick(now, [](std::span<const std::uint8_t> sent) {
      if (!kestrel::ParseMessage(sent)) std::abort();
    });
  }
  kestrel::TeamFusion fusion({}, {});
  for (const auto& object : kestrel::ViewTeam(member, now, &fusion).objects) {
    if (!object.state.allFinite()) std::abort();
  }
  return 0;
}
