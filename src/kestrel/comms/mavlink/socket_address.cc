// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/comms/mavlink/socket_address.h"

#include <cerrno>
#include <cstring>
#include <memory>
#include <netdb.h>
#include <system_error>

#include <fmt/format.h>

#include "kestrel/core/base/error.h"

namespace kestrel {

bool SocketAddress::operator==(const SocketAddress& other) const {
  return size == other.size && std::memcmp(&storage, &other.storage, size) == 0;
}

void ThrowLinkError(const LinkUrl& url, const char* what, int error) {
  throw InputError(fmt::format("autopilot '{}': {}: {}", url.text, what,
                               std::generic_category().message(error)));
}

SocketAddress ResolveAddress(const LinkUrl& url) {
  addrinfo hints{};
  hints.ai_family = AF_UNSPEC;
  hints.ai_flags = AI_NUMERICSERV;
  addrinfo* list = nullptr;
  const int error =
      getaddrinfo(url.place.c_str(), std::to_string(url.number).c_str(), &hints, &list);
  if (error != 0) {
    throw InputError(fmt::format("autopilot '{}': host '{}' is not known: {}", url.text, url.place,
                                 gai_strerror(error)));
  }
  const std::unique_ptr<addrinfo, decltype(&freeaddrinfo)> owner(list, &freeaddrinfo);
  // "localhost" is ::1 first, on which simulated autopilots do not listen.
  const addrinfo* chosen = list;
  while (chosen != nullptr && chosen->ai_family != AF_INET) chosen = chosen->ai_next;
  if (chosen == nullptr) chosen = list;
  SocketAddress address;
  std::memcpy(&address.storage, chosen->ai_addr, chosen->ai_addrlen);
  address.size = chosen->ai_addrlen;
  return address;
}

FileDescriptor BindSocket(const LinkUrl& url, const SocketAddress& address, int type) {
  FileDescriptor bound(socket(address.storage.ss_family, type | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
  if (!bound.is_open()) ThrowLinkError(url, "no socket", errno);
  // With this option a server's port is free again at once after the program has ended. A datagram
  // port always is, and there the option would let two programs share it.
  const int yes = 1;
  if (type == SOCK_STREAM) {
    setsockopt(bound.number(), SOL_SOCKET, SO_REUSEADDR, &yes, sizeof(yes));
  }
  if (bind(bound.number(), address.get(), address.size) != 0) {
    if (errno == EADDRINUSE) {
      throw InputError(fmt::format(
          "autopilot '{}': port {} is in use by another program (a ground station, a router, "
          "another kestrel)",
          url.text, url.number));
    }
    ThrowLinkError(url, "cannot listen there", errno);
  }
  return bound;
}

int FreeLoopbackPort() {
  const LinkUrl url{"udpin://127.0.0.1:0", LinkScheme::kUdpIn, "127.0.0.1", 0};
  const FileDescriptor file = BindSocket(url, ResolveAddress(url), SOCK_DGRAM);
  SocketAddress address;
  getsockname(file.number(), address.get(), &address.size);
  return ntohs(reinterpret_cast<const sockaddr_in*>(&address.storage)->sin_port);
}

}  // namespace kestrel
