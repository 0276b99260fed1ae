// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "kestrel/app/console/channel_feed.h"
#include "kestrel/app/console/console_feed.h"
#include "kestrel/app/console/console_options.h"
#include "kestrel/app/console/web_assets.h"

namespace kestrel {

// The console's server, in a thread of its own. It serves the page's files by HTTP and all live
// data by a WebSocket at /live. HTTP only reads: all requests of a user that change something come
// by the WebSocket, whose origin is checked. Viewers that speak Foxglove's protocol
// (foxglove.sdk.v1, foxglove.websocket.v1) connect to /foxglove and can only look. No request names
// a file of this computer: the files that are served are part of the program.
class WebServer {
 public:
  struct Counters {
    std::uint64_t connections = 0;  // accepted so far
    std::uint64_t refused = 0;      // refused connections and requests
    std::uint64_t encoded = 0;      // images encoded as JPEG
    int clients = 0;                // pages that are open now
    int viewers = 0;                // viewers that are connected now
  };

  // Starts the server. 'feed', 'assets' and 'channels' outlive it. 'channels': messages that
  // viewers can subscribe to; null: none. Throws InputError when the options are not valid or the
  // address cannot be listened on.
  WebServer(const ConsoleOptions& options, ConsoleFeed* feed,
            std::span<const WebAsset> assets = WebAssets(), ChannelFeed* channels = nullptr);
  // Ends all connections.
  ~WebServer();
  WebServer(const WebServer&) = delete;
  WebServer& operator=(const WebServer&) = delete;

  int port() const;
  // URLs of the page, with the token if there is one: the first for a browser on this computer, the
  // others for other devices, where it serves all addresses of this computer.
  std::vector<std::string> urls() const;
  // URL for a viewer.
  std::string viewer_url() const;
  Counters counters() const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace kestrel
