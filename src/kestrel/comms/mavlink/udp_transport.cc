// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/comms/mavlink/udp_transport.h"

#include <algorithm>
#include <array>
#include <cerrno>

#include "kestrel/comms/mavlink/wait_readable.h"

namespace kestrel {
namespace {

// Returns an address of the same family with port 0: the system chooses the port.
SocketAddress AnyAddress(const SocketAddress& like) {
  SocketAddress address;
  address.storage.ss_family = like.storage.ss_family;
  address.size = like.size;
  return address;
}

}  // namespace

UdpTransport::UdpTransport(const LinkUrl& url) {
  const SocketAddress address = ResolveAddress(url);
  if (url.scheme == LinkScheme::kUdpOut) {
    server_ = address;
    socket_ = BindSocket(url, AnyAddress(address), SOCK_DGRAM);
  } else {
    socket_ = BindSocket(url, address, SOCK_DGRAM);
  }
}

std::size_t UdpTransport::Receive(Duration timeout, std::span<std::uint8_t> buffer) {
  std::array<pollfd, 2> files = {{{socket_.number(), POLLIN, 0}, {bell().file(), POLLIN, 0}}};
  if (WaitForAny(files, timeout) <= 0) return 0;
  if (files[1].revents != 0) bell().Silence();
  if (files[0].revents == 0) return 0;
  SocketAddress sender;
  const ssize_t size =
      recvfrom(socket_.number(), buffer.data(), buffer.size(), 0, sender.get(), &sender.size);
  if (size <= 0 || (server_ && *server_ != sender)) return 0;
  sender_ = sender;
  return static_cast<std::size_t>(size);
}

void UdpTransport::Confirm() {
  const Time now = Now();
  const std::lock_guard lock(mutex_);
  Forget(now);
  const auto is_sender = [&](const auto& peer) { return peer && peer->address == sender_; };
  auto* place = std::find_if(peers_.begin(), peers_.end(), is_sender);
  if (place == peers_.end()) {
    place = std::min_element(peers_.begin(), peers_.end(), [](const auto& a, const auto& b) {
      return b && (!a || a->heard < b->heard);
    });
  }
  *place = Peer{sender_, now};
}

// A peer that has been silent for long is dropped as soon as somebody else sends: an autopilot that
// has restarted has another port.
void UdpTransport::Forget(Time now) {
  constexpr Duration kSilence = std::chrono::seconds(10);
  for (auto& peer : peers_) {
    if (peer && now - peer->heard > kSilence && peer->address != sender_) peer.reset();
  }
}

bool UdpTransport::Send(std::span<const std::uint8_t> frame) {
  const auto send_to = [&](const SocketAddress& address) {
    return sendto(socket_.number(), frame.data(), frame.size(), MSG_DONTWAIT | MSG_NOSIGNAL,
                  address.get(), address.size) == static_cast<ssize_t>(frame.size());
  };
  if (server_) return send_to(*server_);
  const std::lock_guard lock(mutex_);
  bool is_sent = false;
  for (const auto& peer : peers_) {
    if (peer && send_to(peer->address)) is_sent = true;
  }
  return is_sent;
}

bool UdpTransport::is_connected() const {
  const std::lock_guard lock(mutex_);
  return std::any_of(peers_.begin(), peers_.end(), [](const auto& peer) { return peer; });
}

}  // namespace kestrel
