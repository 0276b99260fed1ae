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

bool IsNumber(std::string_view text) { return ParseNumber<int>(text).has_value(); }

// Returns the URL of a serial line in a notation of others: "/dev/ttyACM0", "/dev/ttyUSB0,57600",
// "ttyAMA0:921600", "COM3".
std::string GuessedSerial(std::string_view text) {
  const std::size_t end = text.find_first_of(",:");
  std::string device(text.substr(0, end));
  const bool is_of_windows = device.size() > 3 && (device[0] | 0x20) == 'c' && device[3] <= '9';
  if (is_of_windows) device = "/dev/ttyACM0";  // a name that only Windows has
  if (!device.starts_with('/')) device = "/dev/" + device;
  const std::string_view baud = end == std::string_view::npos ? "" : text.substr(end + 1);
  return fmt::format("serial://{}:{}", device, IsNumber(baud) ? baud : "57600");
}

// Returns the URL of a host and a port. Autopilots and their simulations serve TCP at ports from
// 5760 on, and send UDP to 14550 and its neighbours.
std::string GuessedSocket(std::string_view scheme, std::string_view text) {
  constexpr int kUdp = 14000;
  const std::size_t colon = text.rfind(':');
  const bool has_port = colon != std::string_view::npos;
  const std::string_view given = has_port ? text.substr(colon + 1) : IsNumber(text) ? text : "";
  std::string host(has_port ? text.substr(0, colon) : IsNumber(text) ? "" : text);
  if (host.empty()) host = "0.0.0.0";
  const bool is_tcp = scheme.empty() ? IsNumber(given) && *ParseNumber<int>(given) < kUdp
                                     : scheme.starts_with("tcp");
  const bool is_here = host == "0.0.0.0" || host == "127.0.0.1" || host == "localhost";
  const std::string_view port = IsNumber(given) ? given : is_tcp ? "5760" : "14550";
  if (is_tcp && host == "0.0.0.0" && scheme != "tcpin") host = "127.0.0.1";
  const std::string_view guess = is_tcp ? "tcpout" : is_here ? "udpin" : "udpout";
  return fmt::format("{}://{}:{}",
                     scheme.ends_with('n') || scheme.ends_with("out") ? scheme : guess, host, port);
}

// Returns the URL that somebody who writes it as another program wants probably means.
std::string GuessedUrl(std::string_view text) {
  constexpr std::array<std::string_view, 7> kNames = {"udpin",  "udpout", "udp",   "tcpin",
                                                      "tcpout", "tcp",    "serial"};
  std::string_view scheme;
  for (const std::string_view name : kNames) {
    if (!scheme.empty() || !text.starts_with(name) || !text.substr(name.size()).starts_with(':')) {
      continue;
    }
    scheme = name;
    text.remove_prefix(name.size() + 1);
    if (text.starts_with("//")) text.remove_prefix(2);
  }
  const auto begins = [&](std::string_view word) { return text.starts_with(word); };
  const bool is_com =
      text.size() > 3 && (begins("com") || begins("COM")) && IsNumber(text.substr(3, 1));
  const bool is_device = begins("/") || begins("tty") || begins("serial") || is_com;
  return scheme == "serial" || is_device ? GuessedSerial(text) : GuessedSocket(scheme, text);
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
    Refuse(text,
           fmt::format("'{0}' does not say who speaks first, expected {0}in or {0}out, as {1}",
                       std::string(name), GuessedUrl(text)));
  }
  Refuse(text, fmt::format("unknown scheme '{}', expected {}", std::string(name), kForms));
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

bool IsSerial(LinkScheme scheme) {
  return scheme == LinkScheme::kSerial || scheme == LinkScheme::kSerialFlowControl;
}

LinkUrl ParseLinkUrl(const std::string& text) {
  constexpr std::string_view kSeparator = "://";
  const std::size_t separator = text.find(kSeparator);
  if (separator == std::string::npos) {
    Refuse(text,
           fmt::format("has no scheme, did you mean {}? Expected {}", GuessedUrl(text), kForms));
  }
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
