// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <mutex>
#include <optional>

#include "kestrel/comms/mavlink/file_descriptor.h"
#include "kestrel/comms/mavlink/socket_address.h"
#include "kestrel/comms/mavlink/transport.h"

namespace kestrel {

// Datagrams. udpout:// sends to one address and listens only to it; udpin:// sends to everybody who
// recently sent MAVLink to it.
class UdpTransport : public Transport {
 public:
  explicit UdpTransport(const LinkUrl& url);

  std::size_t Receive(Duration timeout, std::span<std::uint8_t> buffer) override;
  void Confirm() override;
  bool Send(std::span<const std::uint8_t> frame) override;
  bool is_connected() const override;
  bool has_datagrams() const override { return true; }
  std::array<int, 2> files() const override { return {socket_.number(), -1}; }

 private:
  struct Peer {
    SocketAddress address;
    Time heard;
  };

  void Forget(Time now);

  FileDescriptor socket_;
  std::optional<SocketAddress> server_;  // peer of udpout://
  SocketAddress sender_;                 // sender of the newest datagram
  mutable std::mutex mutex_;             // guards the peers
  std::array<std::optional<Peer>, 4> peers_;
};

}  // namespace kestrel
