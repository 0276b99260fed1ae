// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "kestrel/core/base/limits.h"

namespace kestrel {

// Returns the name of this computer in lower case.
std::string OwnHostName();

// Returns the IPv4 addresses at which other devices reach this computer.
std::vector<std::string> OwnAddresses();

// Address of the web page, who may use it, and the limits of its cost.
struct ConsoleOptions {
  std::string address = "127.0.0.1";
  int port = 8080;
  std::string token;
  std::string host_names;
  std::string viewer_origins;
  int max_connections = 64;  // others are refused
  double max_image_rate_hz = 20;
  int jpeg_quality = 70;
  int message_queue = 256;
  double idle_timeout_s = 20;  // silence, pings included, after which a browser counts as gone

  static void Visit(auto& self, auto&& visit) {
    visit("address", self.address, "address of the page");
    visit("port", self.port, Range{0, 65535}, "port of the page; 0: any free one");
    visit("token", self.token,
          "secret that a browser must present, 16 to 128 of A-Z a-z 0-9 - _; empty: a new one for "
          "each start, where others can reach the address");
    visit("host_names", self.host_names, "further names of this computer, separated by commas");
    visit("viewer_origins", self.viewer_origins,
          "origins of the pages that may connect to /foxglove, separated by commas");
    visit("max_image_rate_hz", self.max_image_rate_hz, Range{0.1, 200},
          "largest rate of the live image");
    visit("jpeg_quality", self.jpeg_quality, Range{1, 100}, "JPEG quality of the live image");
    visit("message_queue", self.message_queue, Range{1, 100000},
          "messages that may wait for a browser");
    visit.Gone({"max_connections", "idle_timeout_s"});
  }
  std::vector<std::string> Validate() const;

  // True when only programs on this computer can reach the address.
  bool IsLoopback() const;
  // Returns the parts of host_names and this computer's own name, as "uav" and "uav.local", in
  // lower case.
  std::vector<std::string> HostNames() const;
  // Returns the parts of viewer_origins in lower case.
  std::vector<std::string> ViewerOrigins() const;
};

// Returns the options with a random token where others can reach the address and none is set.
ConsoleOptions WithToken(ConsoleOptions options);

// Returns the options with the address that the user gave, as "127.0.0.1:8080" or "[::1]:0". Throws
// InputError that names 'argument' when the text is malformed.
ConsoleOptions WithAddress(ConsoleOptions options, const std::string& text,
                           const std::string& argument);

}  // namespace kestrel
