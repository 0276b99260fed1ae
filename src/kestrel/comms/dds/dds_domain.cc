// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/comms/dds/dds_domain.h"

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <string_view>
#include <unistd.h>

#include <fmt/format.h>

#include "kestrel/core/base/error.h"
#include "kestrel/core/base/parse_number.h"
#include "kestrel/core/base/shown.h"

namespace kestrel {
namespace {

// Number of participants of one computer that are found without multicast: as in ROS 2.
constexpr char kByIndex[] =
    "<ParticipantIndex>auto</ParticipantIndex>"
    "<MaxAutoParticipantIndex>32</MaxAutoParticipantIndex>";

std::string Variable(const char* name) {
  const char* const value = std::getenv(name);
  return value == nullptr ? "" : value;
}

bool IsAddress(std::string_view text) {
  return std::all_of(text.begin(), text.end(), [](unsigned char c) {
    return std::isalnum(c) != 0 || c == '.' || c == ':' || c == '-' || c == '_';
  });
}

// Returns the addresses of ROS_STATIC_PEERS, "a;b".
std::string StaticPeers() {
  const std::string list = Variable("ROS_STATIC_PEERS");
  std::string peers;
  for (std::string_view rest = list; !rest.empty();) {
    const std::string_view peer = rest.substr(0, rest.find(';'));
    rest.remove_prefix(std::min(rest.size(), peer.size() + 1));
    if (peer.empty()) continue;
    if (!IsAddress(peer)) {
      throw InputError(
          fmt::format("ROS_STATIC_PEERS: '{}' is no address, expected A;B;...", Shown(peer)));
    }
    peers += fmt::format("<Peer Address=\"{}\"/>", peer);
  }
  return peers;
}

std::string WithPeers(const std::string& peers) {
  return fmt::format("<Discovery>{}<Peers><Peer Address=\"localhost\"/>{}</Peers></Discovery>",
                     kByIndex, peers);
}

}  // namespace

int DdsDomain(const std::optional<int>& given) {
  constexpr int kLastDomain = 232;
  const std::string ros = Variable("ROS_DOMAIN_ID");
  std::optional<int> domain = given;
  if (!domain) domain = ros.empty() ? 0 : ParseNumber<int>(ros);
  if (domain && *domain >= 0 && *domain <= kLastDomain) return *domain;
  const std::string name =
      given ? fmt::to_string(*given) : fmt::format("ROS_DOMAIN_ID '{}'", Shown(ros));
  throw InputError(fmt::format("{} is no DDS domain: expected 0 to {}", name, kLastDomain));
}

std::string DiscoverySettings() {
  const std::string range = Variable("ROS_LOCALHOST_ONLY") == "1"
                                ? "LOCALHOST"
                                : Variable("ROS_AUTOMATIC_DISCOVERY_RANGE");
  if (range == "SYSTEM_DEFAULT") return "";
  if (range == "OFF") {
    return fmt::format(
        "<General><AllowMulticast>false</AllowMulticast></General>"
        "<Discovery><ParticipantIndex>none</ParticipantIndex><Tag>kestrel_alone_{}</Tag>"
        "</Discovery>",
        getpid());
  }
  const std::string peers = StaticPeers();
  if (range == "LOCALHOST") {
    return "<General><AllowMulticast>false</AllowMulticast></General>" + WithPeers(peers);
  }
  if (!range.empty() && range != "SUBNET") {
    throw InputError(fmt::format(
        "ROS_AUTOMATIC_DISCOVERY_RANGE '{}': expected SUBNET, LOCALHOST, OFF or SYSTEM_DEFAULT",
        Shown(range)));
  }
  return peers.empty() ? "" : WithPeers(peers);
}

}  // namespace kestrel
