// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/comms/mavlink/tcp_transport.h"

#include <cerrno>
#include <netinet/tcp.h>

namespace kestrel {
namespace {

// Sends every message at once, without waiting for the next one.
void SendAtOnce(const FileDescriptor& file) {
  const int yes = 1;
  setsockopt(file.number(), IPPROTO_TCP, TCP_NODELAY, &yes, sizeof(yes));
}

}  // namespace

StreamTransport::Line TcpClient::Open() {
  FileDescriptor file(
      socket(server_.storage.ss_family, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
  if (!file.is_open()) return {};
  SendAtOnce(file);
  if (connect(file.number(), server_.get(), server_.size) == 0) return {std::move(file), false};
  if (errno == EINPROGRESS) return {std::move(file), true};
  return {};
}

TcpServer::TcpServer(const LinkUrl& url)
    : listener_(BindSocket(url, ResolveAddress(url), SOCK_STREAM)) {
  constexpr int kWaiting = 4;
  if (listen(listener_.number(), kWaiting) != 0) ThrowLinkError(url, "cannot listen there", errno);
}

StreamTransport::Line TcpServer::Open() {
  FileDescriptor file(accept4(listener_.number(), nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC));
  if (file.is_open()) SendAtOnce(file);
  return {std::move(file), false};
}

}  // namespace kestrel
