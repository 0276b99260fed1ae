// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace kestrel {

enum class LinkScheme {
  kSerial,             // serial://DEVICE:BAUD
  kSerialFlowControl,  // serial_flowcontrol://DEVICE:BAUD, with RTS and CTS
  kUdpIn,              // udpin://ADDRESS:PORT, waits there for whoever speaks
  kUdpOut,             // udpout://HOST:PORT, speaks first
  kTcpIn,              // tcpin://ADDRESS:PORT, a server
  kTcpOut,             // tcpout://HOST:PORT, a client
};

// Where an autopilot is, as MAVSDK writes it. A numeric IPv6 address stands in brackets.
struct LinkUrl {
  std::string text;  // as it was given, for messages
  LinkScheme scheme = LinkScheme::kSerial;
  std::string place;  // device, host name or address
  int number = 0;     // baud of a serial line, else the port
};

// Throws InputError when 'text' is none: says what is wrong with it and how it is written.
LinkUrl ParseLinkUrl(const std::string& text);

}  // namespace kestrel
