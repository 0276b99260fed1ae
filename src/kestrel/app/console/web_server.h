// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "kestrel/app/console/channel_feed.h"
#include "kestrel/app/console/console_feed.h"
#include "kestrel/app/console/console_options.h"
#include "kestrel/app/console/web_assets.h"

namespace kestrel {

// The console: the page's files by HTTP, and everything that is live by one WebSocket at /live, on
// a thread of its own. HTTP only reads: all that a user asks for comes by the WebSocket, whose
// origin is checked. Viewers that speak Foxglove's protocol (foxglove.sdk.v1,
// foxglove.websocket.v1) connect to /foxglove, and only look. Nothing names a file of this
// computer: what is served is in the program.
class WebServer {
 public:
  struct Counters {
    std::uint64_t connections = 0;  // taken so far
    std::uint64_t refused = 0;      // connections and requests
    std::uint64_t encoded = 0;      // images made into JPEG
    int clients = 0;                // pages that look now
    int viewers = 0;                // that have subscribed, or may
  };

  // Serves from now on. 'feed', 'assets' and 'channels' outlive the server. 'channels': what
  // viewers can subscribe to; null: nothing. Throws InputError when the options are not valid, or
  // the address cannot be listened at.
  WebServer(const ConsoleOptions& options, ConsoleFeed* feed,
            std::span<const WebAsset> assets = WebAssets(), ChannelFeed* channels = nullptr);
  // Ends all connections.
  ~WebServer();
  WebServer(const WebServer&) = delete;
  WebServer& operator=(const WebServer&) = delete;

  int port() const;
  // What to open in a browser on this computer, with the token where there is one.
  std::string url() const;
  // The same for a viewer.
  std::string viewer_url() const;
  Counters counters() const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace kestrel
