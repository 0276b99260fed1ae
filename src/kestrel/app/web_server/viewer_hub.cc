// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/web_server/viewer_hub.h"

namespace kestrel {
namespace {

constexpr Duration kLossInterval = std::chrono::seconds(10);

}  // namespace

// A viewer that speaks Foxglove's WebSocket protocol.
class ViewerHub::Viewer final : public WebConversation {
 public:
  explicit Viewer(ViewerHub* hub) : hub_(hub), flow_(&hub->feed_->channels(), hub->capacity_) {
    hub_->Join(this);
  }
  ~Viewer() override { hub_->Leave(this); }
  Viewer(const Viewer&) = delete;
  Viewer& operator=(const Viewer&) = delete;

  ViewerFlow& flow() { return flow_; }

  bool Take(std::string_view message, bool is_text, Time) override {
    const auto request = is_text ? ParseViewerText(message) : ParseViewerBytes(message);
    if (!request) return false;
    flow_.Take(*request);
    hub_->CountSubscriptions();
    return true;
  }
  std::optional<WebMessage> Next(Time) override { return flow_.Pop(); }

 private:
  ViewerHub* hub_;
  ViewerFlow flow_;
};

// The time of the start is the session id: a viewer that returns recognizes a new run by it.
ViewerHub::ViewerHub(ChannelFeed* feed, const std::string& name, int capacity)
    : feed_(feed),
      server_info_(ServerInfoJson(name, std::to_string(ToNanoseconds(Now())))),
      advertisement_(AdvertiseJson(feed->channels())),
      capacity_(static_cast<std::size_t>(capacity)) {}

std::unique_ptr<WebConversation> ViewerHub::Begin() { return std::make_unique<Viewer>(this); }

void ViewerHub::Join(Viewer* viewer) {
  viewers_.push_back(viewer);
  viewer_count_ = static_cast<int>(viewers_.size());
  viewer->flow().Report(server_info_);
  viewer->flow().Report(advertisement_);
}

void ViewerHub::Leave(Viewer* viewer) {
  std::erase(viewers_, viewer);
  viewer_count_ = static_cast<int>(viewers_.size());
  CountSubscriptions();
}

void ViewerHub::CountSubscriptions() {
  std::uint64_t wanted = 0;
  for (Viewer* viewer : viewers_) wanted |= viewer->flow().wanted();
  feed_->SetWanted(wanted);
}

void ViewerHub::Tick(Time now) {
  while (const auto message = feed_->Take()) {
    for (Viewer* viewer : viewers_) viewer->flow().Offer(*message);
  }
  if (now - losses_reported_ < kLossInterval) return;
  for (Viewer* viewer : viewers_) viewer->flow().ReportLosses();
  losses_reported_ = now;
}

}  // namespace kestrel
