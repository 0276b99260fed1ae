// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/comms/mavlink/link_url.h"

#include <array>
#include <optional>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "kestrel/core/base/error.h"
#include "kestrel/core/base/parse_number.h"

namespace kestrel {
namespace {

constexpr std::string_view kForms =
    "serial:///dev/ttyAMA0:921600, udpin://0.0.0.0:14550, udpout://HOST:PORT, tcpout://HOST:PORT "
    "or tcpin://0.0.0.0:PORT";

[[noreturn]] void Refuse(const std::string& text, const std::string& what) {
  throw InputError(fmt::format("autopilot '{}': {}", text, what));
}

LinkScheme ParseScheme(const std::string& text, std::string_view name) {
  constexpr std::array<std::pair<std::string_view, LinkScheme>, 6> kSchemes = {{
      {"serial", LinkScheme::kSerial},
      {"serial_flowcontrol", LinkScheme::kSerialFlowControl},
      {"udpin", LinkScheme::kUdpIn},
      {"udpout", LinkScheme::kUdpOut},
      {"tcpin", LinkScheme::kTcpIn},
      {"tcpout", LinkScheme::kTcpOut},
  }};
  for (const auto& [known, scheme] : kSchemes) {
    if (name == known) return scheme;
  }
  if (name == "udp" || name == "tcp") {
    Refuse(text, fmt::format("'{0}' does not say who speaks first, expected {0}in or {0}out",
                             std::string(name)));
  }
  Refuse(text, fmt::format("unknown scheme '{}', expected {}", std::string(name), kForms));
}

bool IsSerial(LinkScheme scheme) {
  return scheme == LinkScheme::kSerial || scheme == LinkScheme::kSerialFlowControl;
}

int ParseLinkNumber(const std::string& text, bool is_serial, std::string_view digits) {
  const std::optional<int> number = ParseNumber<int>(digits);
  if (is_serial && (!number || *number <= 0)) {
    Refuse(text, fmt::format("'{}' is no baud rate, expected {}", digits, kForms));
  }
  constexpr int kMaxPort = 65535;
  if (!is_serial && (!number || *number <= 0 || *number > kMaxPort)) {
    Refuse(text, fmt::format("'{}' is no port, expected 1 to {}", digits, kMaxPort));
  }
  return *number;
}

std::string WithoutBrackets(std::string_view host) {
  if (host.size() > 2 && host.front() == '[' && host.back() == ']') {
    host = host.substr(1, host.size() - 2);
  }
  return std::string(host);
}

}  // namespace

LinkUrl ParseLinkUrl(const std::string& text) {
  constexpr std::string_view kSeparator = "://";
  const std::size_t separator = text.find(kSeparator);
  if (separator == std::string::npos) Refuse(text, fmt::format("expected {}", kForms));
  const std::string_view view(text);
  LinkUrl url;
  url.text = text;
  url.scheme = ParseScheme(text, view.substr(0, separator));
  const std::string_view rest = view.substr(separator + kSeparator.size());
  const std::size_t colon = rest.rfind(':');
  const bool is_serial = IsSerial(url.scheme);
  if (colon == std::string_view::npos || rest.find(']', colon) != std::string_view::npos) {
    Refuse(text,
           fmt::format("no {} at its end, expected {}", is_serial ? "baud rate" : "port", kForms));
  }
  url.place = WithoutBrackets(rest.substr(0, colon));
  if (url.place.empty()) {
    Refuse(text, fmt::format("no {}, expected {}", is_serial ? "device" : "host", kForms));
  }
  url.number = ParseLinkNumber(text, is_serial, rest.substr(colon + 1));
  return url;
}

}  // namespace kestrel
