// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "kestrel/comms/mavlink/socket_address.h"
#include "kestrel/comms/mavlink/stream_transport.h"

namespace kestrel {

// tcpout://, a client.
class TcpClient : public StreamTransport {
 public:
  explicit TcpClient(const LinkUrl& url) : server_(ResolveAddress(url)) {}

 protected:
  Line Open() override;

 private:
  SocketAddress server_;
};

// tcpin://, with one client at a time.
class TcpServer : public StreamTransport {
 public:
  explicit TcpServer(const LinkUrl& url);

 protected:
  Line Open() override;
  int listener() const override { return listener_.number(); }

 private:
  FileDescriptor listener_;
};

}  // namespace kestrel
