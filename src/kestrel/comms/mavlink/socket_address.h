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

// Returns the address of the URL's host and port; a host name is looked up. Throws InputError when
// it is not known.
SocketAddress ResolveAddress(const LinkUrl& url);

// Returns a non-blocking socket (SOCK_DGRAM or SOCK_STREAM) bound to the address. Throws InputError
// when the port is in use or the address is not this computer's.
FileDescriptor BindSocket(const LinkUrl& url, const SocketAddress& address, int type);

// Returns a free port of 127.0.0.1, for programs that communicate on one computer. Throws
// InputError when there is none.
int FreeLoopbackPort();

// Throws InputError with the URL, what failed and the system's text for 'error' (errno).
[[noreturn]] void ThrowLinkError(const LinkUrl& url, const char* what, int error);

}  // namespace kestrel
