// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>

namespace kestrel {

// The topic on which a team's messages go through DDS (Eclipse Cyclone DDS): keyed by sender,
// reliable and transient-local for those who ask for that, which a TeamTopic does not: what it
// misses TeamMember's digests find. How DDS finds the others can be set by CYCLONEDDS_URI. Send and
// Receive neither block nor throw.
class TeamTopic {
 public:
  // 'team': its name, 'sender': unique. Throws InputError when there is no such domain (0 to 232),
  // no network, or DDS is not part of this build.
  TeamTopic(int domain, const std::string& team, const std::string& sender);
  TeamTopic(const TeamTopic&) = delete;
  TeamTopic& operator=(const TeamTopic&) = delete;
  ~TeamTopic();

  // What is longer than 16400 bytes is left out.
  void Send(std::span<const std::uint8_t> bytes);

  // Gives 'hear' what the others have sent since the last call.
  void Receive(const std::function<void(std::span<const std::uint8_t>)>& hear);

 private:
  struct Entities;
  std::unique_ptr<Entities> entities_;
};

}  // namespace kestrel
