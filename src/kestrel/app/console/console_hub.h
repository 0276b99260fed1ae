// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <deque>
#include <memory>
#include <span>
#include <variant>
#include <vector>

#include "kestrel/app/console/console_feed.h"
#include "kestrel/app/console/console_options.h"
#include "kestrel/app/console/image_channel.h"
#include "kestrel/app/console/request_guard.h"
#include "kestrel/app/console/telemetry_channel.h"
#include "kestrel/app/console/viewer_hub.h"
#include "kestrel/app/console/web_assets.h"

namespace kestrel {

// One browser, as the hub sees it.
class ConsoleClient {
 public:
  virtual ~ConsoleClient() = default;

  virtual void Push(const SharedMessage& message) = 0;
  // Sends the next message, unless one is on its way.
  virtual void SendNext() = 0;
  virtual void PushLinkReport(int clients) = 0;
};

// The state that the connections of the console share. Used by the console's thread; any thread may
// read the counters.
class ConsoleHub {
 public:
  // 'options' are valid; 'feed', 'assets' and 'channels' outlive the hub. 'channels': messages that
  // viewers can subscribe to; null: none.
  ConsoleHub(const ConsoleOptions& options, ConsoleFeed* feed, std::span<const WebAsset> assets,
             int port, ChannelFeed* channels);

  const ConsoleOptions& options() const { return options_; }
  const RequestGuard& guard() const { return guard_; }
  ImageChannel& images() { return images_; }
  // Returns null when there is no asset with this path.
  const WebAsset* FindAsset(std::string_view path) const;

  // Returns a connection's slot, held as long as the connection lives; null when all are taken.
  std::shared_ptr<void> TakeSlot();
  void CountRefusal() { ++refused_; }

  // Adds a browser and sends it the present state. It must leave before it is destroyed.
  void Join(ConsoleClient* client);
  void Leave(ConsoleClient* client);
  bool has_clients() const { return !clients_.empty() || (viewers_ && !viewers_->empty()); }
  // Null when there are no channels to subscribe to.
  ViewerHub* viewer_hub() { return viewers_ ? &*viewers_ : nullptr; }

  // Sends new updates and frames to all clients.
  void Tick(Time now);
  void Command(const ConsoleCommand& command) { feed_->Command(command); }
  void Ask(const ColorRequest& request) { feed_->Ask(request); }
  bool CanExport(const ExportRequest& request) const {
    const ConsoleFeed::Description& description = feed_->description();
    return description.has_exports || (description.has_colors && IsOfColors(request));
  }
  void Export(PendingExport pending) { feed_->Export(std::move(pending)); }

  int clients() const { return client_count_; }
  int viewers() const { return viewers_ ? viewers_->viewers() : 0; }
  std::uint64_t connections() const { return connections_; }
  std::uint64_t refused() const { return refused_; }
  std::uint64_t encoded() const { return encoded_; }

 private:
  void Broadcast(const ConsoleUpdate& update);
  void CountClients();

  ConsoleOptions options_;
  ConsoleFeed* feed_;
  std::span<const WebAsset> assets_;
  RequestGuard guard_;
  ImageChannel images_;
  std::optional<ViewerHub> viewers_;
  SharedMessage hello_;
  // The newest message of each kind except samples and ages, for browsers that join later.
  std::array<SharedMessage, std::variant_size_v<ConsoleUpdate>> newest_;
  std::deque<SharedMessage> events_;
  std::vector<ConsoleClient*> clients_;
  Time reported_{};
  int slots_ = 0;
  std::atomic<int> client_count_{0};
  std::atomic<std::uint64_t> connections_{0}, refused_{0}, encoded_{0};
};

}  // namespace kestrel
