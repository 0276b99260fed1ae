// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "kestrel/app/web_server/channel_feed.h"
#include "kestrel/app/web_server/console_options.h"
#include "kestrel/app/web_server/live_page.h"
#include "kestrel/app/web_server/web_asset.h"

namespace kestrel {

// A server in a thread of its own. It serves a page's files by HTTP and all live data by a
// WebSocket at /live. HTTP only reads: all requests of a user that change something come
// by the WebSocket, whose origin is checked. Viewers that speak Foxglove's protocol
// (foxglove.sdk.v1, foxglove.websocket.v1) connect to /foxglove and can only look. No request names
// a file of this computer: the files that are served are part of the program.
class WebServer {
 public:
  struct Counters {
    std::uint64_t connections = 0;  // accepted so far
    std::uint64_t refused = 0;      // refused connections and requests
    int clients = 0;                // pages that are open now
    int viewers = 0;                // viewers that are connected now
  };

  // Starts the server. 'assets' and 'channels' outlive it. 'channels': messages that viewers can
  // subscribe to; null: none. Throws InputError when the options are not valid or the address
  // cannot be listened on.
  WebServer(const ConsoleOptions& options, std::unique_ptr<LivePage> page,
            std::span<const WebAsset> assets, ChannelFeed* channels = nullptr);
  // Ends all connections.
  ~WebServer();
  WebServer(WebServer&& other) noexcept;

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
