// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "kestrel/app/web_server/console_options.h"
#include "kestrel/app/web_server/live_page.h"
#include "kestrel/app/web_server/request_guard.h"
#include "kestrel/app/web_server/viewer_hub.h"
#include "kestrel/app/web_server/web_asset.h"

namespace kestrel {

class WebSocket;

// The state that the connections of a server share. Used by the server's thread; any thread may
// read the counters.
class WebHub {
 public:
  // 'options' are valid; 'page', 'assets' and 'channels' outlive the hub. 'channels': messages that
  // viewers can subscribe to; null: none.
  WebHub(const ConsoleOptions& options, LivePage* page, std::span<const WebAsset> assets, int port,
         ChannelFeed* channels);

  const ConsoleOptions& options() const { return options_; }
  const RequestGuard& guard() const { return guard_; }
  LivePage& page() { return *page_; }
  // Null when there are no channels to subscribe to.
  ViewerHub* viewer_hub() { return viewers_ ? &*viewers_ : nullptr; }
  // Returns null when there is no asset with this path.
  const WebAsset* FindAsset(std::string_view path) const;

  // Returns a connection's slot, held as long as the connection lives; null when all are taken.
  std::shared_ptr<void> TakeSlot();
  void CountRefusal() { ++refused_; }

  // Adds an open socket. It must leave before it is destroyed.
  void Join(WebSocket* socket);
  void Leave(WebSocket* socket);
  bool has_clients() const { return !sockets_.empty(); }

  // Sends new messages to all clients.
  void Tick(Time now);

  int sockets() const { return socket_count_; }
  int viewers() const { return viewers_ ? viewers_->viewers() : 0; }
  std::uint64_t connections() const { return connections_; }
  std::uint64_t refused() const { return refused_; }

 private:
  ConsoleOptions options_;
  LivePage* page_;
  std::span<const WebAsset> assets_;
  RequestGuard guard_;
  std::optional<ViewerHub> viewers_;
  std::vector<WebSocket*> sockets_;
  int slots_ = 0;
  std::atomic<int> socket_count_{0};
  std::atomic<std::uint64_t> connections_{0}, refused_{0};
};

}  // namespace kestrel
