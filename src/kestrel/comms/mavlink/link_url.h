// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace kestrel {

enum class LinkScheme {
  kSerial,             // serial://DEVICE:BAUD
  kSerialFlowControl,  // serial_flowcontrol://DEVICE:BAUD, with RTS and CTS
  kUdpIn,              // waits there for anyone who sends
  kUdpOut,             // sends first
  kTcpIn,              // tcpin://ADDRESS:PORT, a server
  kTcpOut,             // tcpout://HOST:PORT, a client
};

// Address of an autopilot, in the notation of MAVSDK. A numeric IPv6 address is in brackets.
struct LinkUrl {
  std::string text;  // as given, for messages
  LinkScheme scheme = LinkScheme::kSerial;
  std::string place;  // device, host name or address
  int number = 0;     // baud rate of a serial line, else the port
};

bool IsSerial(LinkScheme scheme);

// Throws InputError when 'text' is not valid, with the fault, the right syntax and, if it can be
// guessed, the URL that was probably meant.
LinkUrl ParseLinkUrl(const std::string& text);

}  // namespace kestrel
