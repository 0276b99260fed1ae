// SPDX-License-Identifier: BSD-3-Clause
// In the place of team_topic.cc where Cyclone DDS is not installed.
#include "kestrel/base/error.h"
#include "kestrel/dds/team_topic.h"

namespace kestrel {

struct TeamTopic::Entities {};

TeamTopic::TeamTopic(int /*domain*/, const std::string& /*team*/, const std::string& /*sender*/) {
  throw InputError(
      "this kestrel was built without DDS: run scripts/install-deps --dds and build it again");
}

TeamTopic::~TeamTopic() = default;

void TeamTopic::Send(std::span<const std::uint8_t> /*bytes*/) {}

void TeamTopic::Receive(const std::function<void(std::span<const std::uint8_t>)>& /*hear*/) {}

}  // namespace kestrel
