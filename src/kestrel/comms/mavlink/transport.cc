// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/comms/mavlink/transport.h"

#include "kestrel/comms/mavlink/serial_transport.h"
#include "kestrel/comms/mavlink/tcp_transport.h"
#include "kestrel/comms/mavlink/udp_transport.h"

namespace kestrel {

std::unique_ptr<Transport> OpenTransport(const LinkUrl& url) {
  switch (url.scheme) {
    case LinkScheme::kSerial:
    case LinkScheme::kSerialFlowControl:
      return std::make_unique<SerialTransport>(url);
    case LinkScheme::kUdpIn:
    case LinkScheme::kUdpOut:
      return std::make_unique<UdpTransport>(url);
    case LinkScheme::kTcpIn:
      return std::make_unique<TcpServer>(url);
    case LinkScheme::kTcpOut:
      return std::make_unique<TcpClient>(url);
  }
  return nullptr;
}

}  // namespace kestrel
