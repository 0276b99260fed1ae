// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <netinet/in.h>
#include <sys/socket.h>

#include "kestrel/comms/mavlink/file_descriptor.h"
#include "kestrel/comms/mavlink/link_url.h"

namespace kestrel {

// An IPv4 or IPv6 address with its port.
struct SocketAddress {
  sockaddr_storage storage{};
  socklen_t size = sizeof(sockaddr_storage);

  const sockaddr* get() const { return reinterpret_cast<const sockaddr*>(&storage); }
  sockaddr* get() { return reinterpret_cast<sockaddr*>(&storage); }
  bool operator==(const SocketAddress& other) const;
};

// Address of the URL's host and port; asks the name service where the host is a name. Throws
// InputError when nobody knows it.
SocketAddress ResolveAddress(const LinkUrl& url);

// A non-blocking socket (SOCK_DGRAM or SOCK_STREAM) that is bound to the address. Throws InputError
// when the port is in use or the address is not this computer's.
FileDescriptor BindSocket(const LinkUrl& url, const SocketAddress& address, int type);

// A port of 127.0.0.1 that nobody uses now, for programs that talk to each other on one computer.
// Throws InputError when there is none.
int FreeLoopbackPort();

// InputError with the URL, what failed and the system's own words for 'error' (errno).
[[noreturn]] void ThrowLinkError(const LinkUrl& url, const char* what, int error);

}  // namespace kestrel
