// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/web_server/console_options.h"

#include <algorithm>
#include <boost/asio/ip/address.hpp>
#include <cctype>
#include <ifaddrs.h>
#include <net/if.h>
#include <netinet/in.h>
#include <random>
#include <sstream>
#include <unistd.h>

#include <climits>
#include <fmt/format.h>

#include "kestrel/core/base/error.h"
#include "kestrel/core/base/parse_number.h"

namespace kestrel {
namespace {

bool IsTokenCharacter(unsigned char c) { return std::isalnum(c) || c == '-' || c == '_'; }

bool IsToken(const std::string& token) {
  return token.size() >= 16 && token.size() <= 128 &&
         std::all_of(token.begin(), token.end(), IsTokenCharacter);
}

std::string InLowerCase(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return std::tolower(c); });
  return text;
}

// The comma-separated parts, in lower case, without blanks.
std::vector<std::string> PartsOf(const std::string& list) {
  std::vector<std::string> parts;
  std::istringstream stream(list);
  for (std::string part; std::getline(stream, part, ',');) {
    std::erase_if(part, [](unsigned char c) { return std::isspace(c); });
    if (!part.empty()) parts.push_back(InLowerCase(part));
  }
  return parts;
}

// True for an origin such as "https://app.foxglove.dev", without a path. "null" is not accepted, as
// any page can claim it.
bool IsOrigin(const std::string& text) {
  const std::size_t colon = text.find("://");
  if (colon == text.npos || colon == 0) return false;
  return text == "file://" ||
         (text.size() > colon + 3 && text.find_first_of("/*?#", colon + 3) == text.npos);
}

}  // namespace

std::vector<std::string> ConsoleOptions::Validate() const {
  std::vector<std::string> violations;
  boost::system::error_code error;
  boost::asio::ip::make_address(address, error);
  if (error) violations.push_back(fmt::format("address is '{}', expected an IP address", address));
  // The message does not repeat the token: it is a secret.
  if (!token.empty() && !IsToken(token)) {
    violations.push_back("token is not 16 to 128 of A-Z a-z 0-9 - _");
  }
  for (const std::string& origin : ViewerOrigins()) {
    if (origin == "file://" && token.empty()) {
      violations.push_back("viewer_origins has 'file://', any HTML file, expected a token with it");
    }
    if (IsOrigin(origin)) continue;
    violations.push_back(fmt::format(
        "viewer_origins has '{}', expected origins as https://app.foxglove.dev, without a path",
        origin));
  }
  return violations;
}

bool ConsoleOptions::IsLoopback() const {
  boost::system::error_code error;
  const auto ip = boost::asio::ip::make_address(address, error);
  return !error && ip.is_loopback();
}

std::vector<std::string> ConsoleOptions::HostNames() const {
  std::vector<std::string> names = PartsOf(host_names);
  const std::string own = OwnHostName();
  names.insert(names.end(), {own, own + ".local"});
  return names;
}

std::vector<std::string> ConsoleOptions::ViewerOrigins() const { return PartsOf(viewer_origins); }

std::string OwnHostName() {
  char name[HOST_NAME_MAX + 1] = {};
  gethostname(name, sizeof(name) - 1);
  return InLowerCase(name);
}

std::vector<std::string> OwnAddresses() {
  std::vector<std::string> addresses;
  ifaddrs* interfaces = nullptr;
  if (getifaddrs(&interfaces) != 0) return addresses;
  for (const ifaddrs* one = interfaces; one != nullptr; one = one->ifa_next) {
    const bool is_up = (one->ifa_flags & IFF_UP) != 0 && (one->ifa_flags & IFF_LOOPBACK) == 0;
    if (!is_up || one->ifa_addr == nullptr || one->ifa_addr->sa_family != AF_INET) continue;
    const auto* const address = reinterpret_cast<const sockaddr_in*>(one->ifa_addr);
    addresses.push_back(boost::asio::ip::address_v4(ntohl(address->sin_addr.s_addr)).to_string());
  }
  freeifaddrs(interfaces);
  return addresses;
}

ConsoleOptions WithToken(ConsoleOptions options) {
  constexpr int kWords = 4;
  if (!options.token.empty() || options.IsLoopback()) return options;
  std::random_device random;
  for (int i = 0; i < kWords; ++i) options.token += fmt::format("{:08x}", random());
  return options;
}

ConsoleOptions WithAddress(ConsoleOptions options, const std::string& text,
                           const std::string& argument) {
  const std::size_t colon = text.rfind(':');
  std::string address = text.substr(0, colon);
  if (address.starts_with('[') && address.ends_with(']')) {
    address = address.substr(1, address.size() - 2);
  }
  const int port = colon == text.npos
                       ? -1
                       : ParseNumber<int>(std::string_view(text).substr(colon + 1)).value_or(-1);
  boost::system::error_code error;
  const auto ip = boost::asio::ip::make_address(address, error);
  const bool is_bracketed = text.starts_with('[');
  if (error || port < 0 || port > 65535 || ip.is_v6() != is_bracketed) {
    throw InputError(fmt::format("{} '{}': expected ADDRESS:PORT, as 127.0.0.1:8080 or [::1]:8080",
                                 argument, text));
  }
  options.address = address;
  options.port = port;
  return options;
}

}  // namespace kestrel
