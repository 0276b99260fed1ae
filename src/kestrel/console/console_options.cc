// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/console/console_options.h"

#include <algorithm>
#include <array>
#include <boost/asio/ip/address.hpp>
#include <cctype>
#include <cstdint>
#include <sstream>
#include <unistd.h>

#include <fmt/format.h>

#include "kestrel/base/error.h"
#include "kestrel/base/violations.h"

namespace kestrel {
namespace {

bool IsTokenCharacter(unsigned char c) { return std::isalnum(c) || c == '-' || c == '_'; }

bool IsToken(const std::string& token) {
  return token.size() >= 16 && token.size() <= 128 &&
         std::all_of(token.begin(), token.end(), IsTokenCharacter);
}

}  // namespace

std::vector<std::string> ConsoleOptions::Validate() const {
  std::vector<std::string> violations;
  boost::system::error_code error;
  boost::asio::ip::make_address(address, error);
  if (error) violations.push_back(fmt::format("address is '{}', expected an IP address", address));
  // What was given is not repeated: it is a secret.
  if (!token.empty() && !IsToken(token)) {
    violations.push_back("token is not 16 to 128 of A-Z a-z 0-9 - _");
  }
  RequireIn(port, 0, 65535, "port", &violations);
  RequireIn(max_connections, 1, 1000, "max_connections", &violations);
  RequireIn(max_image_rate_hz, 0.1, 200, "max_image_rate_hz", &violations);
  RequireIn(jpeg_quality, 1, 100, "jpeg_quality", &violations);
  RequireIn(message_queue, 1, 100000, "message_queue", &violations);
  RequireIn(idle_timeout_s, 1, 3600, "idle_timeout_s", &violations);
  return violations;
}

bool ConsoleOptions::IsLoopback() const {
  boost::system::error_code error;
  const auto ip = boost::asio::ip::make_address(address, error);
  return !error && ip.is_loopback();
}

std::vector<std::string> ConsoleOptions::HostNames() const {
  std::vector<std::string> names;
  std::istringstream list(host_names);
  for (std::string name; std::getline(list, name, ',');) {
    std::erase_if(name, [](unsigned char c) { return std::isspace(c); });
    std::transform(name.begin(), name.end(), name.begin(),
                   [](unsigned char c) { return std::tolower(c); });
    if (!name.empty()) names.push_back(name);
  }
  return names;
}

std::string MakeToken() {
  std::array<std::uint8_t, 16> bytes;
  if (getentropy(bytes.data(), bytes.size()) != 0) {
    throw InputError("no random numbers from the system for the console's token");
  }
  std::string token;
  for (const std::uint8_t byte : bytes) token += fmt::format("{:02x}", byte);
  return token;
}

}  // namespace kestrel
