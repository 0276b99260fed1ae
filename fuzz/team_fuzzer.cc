// SPDX-License-Identifier: BSD-3-Clause
// For anything that a UAV receives, it neither crashes nor throws, a message that it accepts can be
// sent again, and the map and the goal that it makes of it are finite.
#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <span>
#include <vector>

#include "kestrel/comms/team/team_goal.h"
#include "kestrel/comms/team/team_member.h"
#include "kestrel/comms/team/team_view.h"

namespace {

using Bytes = std::span<const std::uint8_t>;

// Splits the input before each beginning of a message.
std::vector<Bytes> Messages(Bytes bytes) {
  static const std::vector<std::uint8_t> kEmpty = kestrel::EncodeMessage({{"a", 1}, {}});
  const Bytes beginning = Bytes(kEmpty).first(4);
  std::vector<Bytes> messages;
  while (!bytes.empty()) {
    const auto next =
        std::search(bytes.begin() + 1, bytes.end(), beginning.begin(), beginning.end());
    messages.push_back(bytes.first(static_cast<std::size_t>(next - bytes.begin())));
    bytes = bytes.subspan(messages.back().size());
  }
  return messages;
}

void Hear(Bytes bytes, kestrel::Time now, kestrel::TeamMember* member) {
  if (const auto message = kestrel::ParseMessage(bytes)) {
    if (!kestrel::ParseMessage(kestrel::EncodeMessage(*message))) std::abort();
  }
  member->Hear(bytes, now);
}

void RequireFinite(bool is_finite) {
  if (!is_finite) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  kestrel::TeamMember member({"a", 1}, {});
  kestrel::TeamFusion fusion({}, {});
  kestrel::GoalChooser chooser(kestrel::DefaultObjectModel(), "red");
  const kestrel::FlightToObjects flight{.at = kestrel::UavFlight{}, .wants_object = true};
  kestrel::Time now;
  member.SetFlight(flight.at);
  for (int i = 0; i < 2; ++i) {
    for (const Bytes message : Messages({data, size})) Hear(message, now, &member);
    now += std::chrono::seconds(1);
    member.Tick(now, [](Bytes sent) {
      if (!kestrel::ParseMessage(sent)) std::abort();
    });
    const kestrel::TeamView view = kestrel::ViewTeam(member, now, &fusion);
    for (const auto& object : view.objects) RequireFinite(object.state.allFinite());
    const kestrel::TeamGoal& goal = chooser.Update(view, flight, now, &member);
    for (const auto& mate : goal.mates) {
      RequireFinite(mate.position.allFinite() && mate.velocity.allFinite());
    }
  }
  return 0;
}
