// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/web_server/web_hub.h"

#include <algorithm>

#include "kestrel/app/web_server/web_socket.h"

namespace kestrel {

WebHub::WebHub(const ConsoleOptions& options, LivePage* page, std::span<const WebAsset> assets,
               int port, ChannelFeed* channels)
    : options_(options), page_(page), assets_(assets), guard_(options, port) {
  if (channels != nullptr) viewers_.emplace(channels, page->title(), options.message_queue);
}

const WebAsset* WebHub::FindAsset(std::string_view path) const {
  const auto asset = std::find_if(assets_.begin(), assets_.end(),
                                  [&](const WebAsset& one) { return one.path == path; });
  return asset == assets_.end() ? nullptr : &*asset;
}

std::shared_ptr<void> WebHub::TakeSlot() {
  if (slots_ >= options_.max_connections) {
    CountRefusal();
    return nullptr;
  }
  ++slots_;
  ++connections_;
  return std::shared_ptr<void>(this, [](WebHub* hub) { --hub->slots_; });
}

void WebHub::Join(WebSocket* socket) {
  sockets_.push_back(socket);
  socket_count_ = static_cast<int>(sockets_.size());
}

void WebHub::Leave(WebSocket* socket) {
  std::erase(sockets_, socket);
  socket_count_ = static_cast<int>(sockets_.size());
}

void WebHub::Tick(Time now) {
  page_->Tick(now);
  if (viewers_) viewers_->Tick(now);
  for (WebSocket* socket : sockets_) socket->SendNext();
}

}  // namespace kestrel
