// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

namespace kestrel {

// Returns the name of this computer in lower case.
std::string OwnHostName();

// Address of the web page, who may use it, and the limits of its cost.
struct ConsoleOptions {
  // IPv4 or IPv6 address. Any address that other computers can reach (all but 127.0.0.0/8 and ::1)
  // has a token.
  std::string address = "127.0.0.1";
  int port = 8080;  // 0: any free port
  // 16 to 128 characters of A-Z, a-z, 0-9, - and _; empty: none, or a random one where one is
  // needed.
  std::string token;
  // Comma-separated host names that requests may use beside addresses, localhost and this
  // computer's own name, with ".local" or without; with any other name another site may pose as
  // this page (DNS rebinding).
  std::string host_names;
  // Comma-separated origins of other pages that may subscribe to a flight's messages at /foxglove,
  // as "https://app.foxglove.dev". They see all that the flight shows and can change nothing.
  // Programs other than browsers need not be listed.
  std::string viewer_origins;
  int max_connections = 64;
  double max_image_rate_hz = 20;
  int jpeg_quality = 70;
  // Messages that wait for a slow browser. When the queue is full the oldest is dropped and
  // Time without a message or a pong after which a browser counts as gone.
  int message_queue = 256;
  // Silence, pings included, after which a browser counts as gone.
  double idle_timeout_s = 20;

  template <class Self, class Visitor>
  static void Visit(Self& self, Visitor&& visitor) {
    visitor("address", self.address, "", "address of the page");
    visitor("port", self.port, "1", "port of the page; 0: any free one");
    visitor(
        "token", self.token, "",
        "secret that a browser must present, 16 to 128 of A-Z a-z 0-9 - _; empty: a new one for "
        "each start, where others can reach the address");
    visitor("host_names", self.host_names, "",
            "further names of this computer, separated by commas");
    visitor("viewer_origins", self.viewer_origins, "",
            "origins of the pages that may connect to /foxglove, separated by commas");
    visitor("max_connections", self.max_connections, "1",
            "number of simultaneous connections; others are refused");
    visitor("max_image_rate_hz", self.max_image_rate_hz, "Hz", "largest rate of the live image");
    visitor("jpeg_quality", self.jpeg_quality, "1", "JPEG quality of the live image, 1 to 100");
    visitor("message_queue", self.message_queue, "1",
            "number of messages that may wait for a slow browser");
    visitor("idle_timeout_s", self.idle_timeout_s, "s",
            "time after which a silent browser is disconnected");
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
