// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/console/console_hub.h"

#include <algorithm>
#include <string>

#include "kestrel/app/console/console_json.h"

namespace kestrel {
namespace {

constexpr std::size_t kEventsForNewcomers = 50;
constexpr Duration kReportInterval = std::chrono::milliseconds(500);

}  // namespace

ConsoleHub::ConsoleHub(const ConsoleOptions& options, ConsoleFeed* feed,
                       std::span<const WebAsset> assets, int port, ChannelFeed* channels)
    : options_(options),
      feed_(feed),
      assets_(assets),
      guard_(options, port),
      images_(feed, options.jpeg_quality, options.max_image_rate_hz),
      hello_(std::make_shared<const std::string>(ToJson(feed->description()))) {
  if (channels != nullptr) viewers_.emplace(channels, feed->description().title);
}

const WebAsset* ConsoleHub::FindAsset(std::string_view path) const {
  const auto asset = std::find_if(assets_.begin(), assets_.end(),
                                  [&](const WebAsset& one) { return one.path == path; });
  return asset == assets_.end() ? nullptr : &*asset;
}

std::shared_ptr<void> ConsoleHub::TakeSlot() {
  if (slots_ >= options_.max_connections) {
    CountRefusal();
    return nullptr;
  }
  ++slots_;
  ++connections_;
  return std::shared_ptr<void>(this, [](ConsoleHub* hub) { --hub->slots_; });
}

void ConsoleHub::Join(ConsoleClient* client) {
  clients_.push_back(client);
  CountClients();
  client->Push(hello_);
  for (const SharedMessage& message : newest_) {
    if (message) client->Push(message);
  }
  for (const SharedMessage& message : events_) client->Push(message);
  client->SendNext();
}

void ConsoleHub::Leave(ConsoleClient* client) {
  std::erase(clients_, client);
  CountClients();
}

void ConsoleHub::CountClients() {
  client_count_ = static_cast<int>(clients_.size());
  feed_->SetWatchers(client_count_);
}

void ConsoleHub::Tick(Time now) {
  while (const std::optional<ConsoleUpdate> update = feed_->TakeUpdate()) Broadcast(*update);
  if (now - reported_ >= kReportInterval) {
    for (ConsoleClient* client : clients_) client->PushLinkReport(client_count_);
    reported_ = now;
  }
  for (ConsoleClient* client : clients_) client->SendNext();
  if (viewers_) viewers_->Tick(now);
  encoded_ = images_.encoded();
}

void ConsoleHub::Broadcast(const ConsoleUpdate& update) {
  // Values of the moment are not kept: a page that connects later needs the next ones.
  const bool is_fleeting =
      std::holds_alternative<ViewSample>(update) || std::holds_alternative<ConsoleSources>(update);
  if (is_fleeting && clients_.empty()) return;
  const auto message = std::make_shared<const std::string>(ToJson(update));
  if (std::holds_alternative<SessionEvent>(update)) {
    events_.push_back(message);
    if (events_.size() > kEventsForNewcomers) events_.pop_front();
  } else if (!is_fleeting) {
    newest_[update.index()] = message;
  }
  for (ConsoleClient* client : clients_) client->Push(message);
}

}  // namespace kestrel
