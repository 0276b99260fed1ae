// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/console/viewer_hub.h"

namespace kestrel {
namespace {

constexpr Duration kLossInterval = std::chrono::seconds(10);

}  // namespace

// The session id tells a returning viewer whether this is the same run of the program.
ViewerHub::ViewerHub(ChannelFeed* feed, const std::string& name)
    : feed_(feed),
      server_info_(ServerInfoJson(name, std::to_string(ToNanoseconds(Now())))),
      advertisement_(AdvertiseJson(feed->channels())) {}

void ViewerHub::Join(ViewerClient* viewer) {
  viewers_.push_back(viewer);
  viewer_count_ = static_cast<int>(viewers_.size());
  viewer->flow().Say(server_info_);
  viewer->flow().Say(advertisement_);
  viewer->SendNext();
}

void ViewerHub::Leave(ViewerClient* viewer) {
  std::erase(viewers_, viewer);
  viewer_count_ = static_cast<int>(viewers_.size());
  CountSubscriptions();
}

void ViewerHub::CountSubscriptions() {
  std::uint64_t wanted = 0;
  for (ViewerClient* viewer : viewers_) wanted |= viewer->flow().wanted();
  feed_->SetWanted(wanted);
}

void ViewerHub::Tick(Time now) {
  while (const auto message = feed_->Take()) {
    for (ViewerClient* viewer : viewers_) viewer->flow().Offer(*message);
  }
  if (now - losses_told_ >= kLossInterval) {
    for (ViewerClient* viewer : viewers_) viewer->flow().SayLosses();
    losses_told_ = now;
  }
  for (ViewerClient* viewer : viewers_) viewer->SendNext();
}

}  // namespace kestrel
