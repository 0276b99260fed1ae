// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>

namespace kestrel {

// The DDS topic (Eclipse Cyclone DDS) of a team's messages: keyed by sender, reliable and
// transient-local for readers that request that. A TeamTopic does not: the digests of TeamMember
// find what it misses. CYCLONEDDS_URI sets how DDS finds the others. Send and Receive neither block
// nor throw.
class TeamTopic {
 public:
  // 'team': name of the team. 'sender': unique. Throws InputError when there is no such domain (0
  // to 232), no network, or DDS is not part of this build.
  TeamTopic(int domain, const std::string& team, const std::string& sender);
  TeamTopic(const TeamTopic&) = delete;
  TeamTopic& operator=(const TeamTopic&) = delete;
  ~TeamTopic();

  // Leaves out messages longer than 16400 bytes.
  void Send(std::span<const std::uint8_t> bytes);

  // Passes the messages of the others since the last call to 'hear'.
  void Receive(const std::function<void(std::span<const std::uint8_t>)>& hear);

 private:
  struct Entities;
  std::unique_ptr<Entities> entities_;
};

}  // namespace kestrel
