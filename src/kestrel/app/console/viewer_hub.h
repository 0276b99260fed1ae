// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <cstddef>
#include <string>
#include <vector>

#include "kestrel/app/console/channel_feed.h"
#include "kestrel/app/console/viewer_flow.h"

namespace kestrel {

// One viewer, as the hub sees it.
class ViewerClient {
 public:
  virtual ~ViewerClient() = default;

  virtual ViewerFlow& flow() = 0;
  // Sends the next message, unless one is on its way.
  virtual void SendNext() = 0;
};

// The state that the viewers of a flight share. Used by the console's thread; any thread may call
// viewers().
class ViewerHub {
 public:
  // 'feed' outlives the hub. 'name': name of the flight for viewers.
  ViewerHub(ChannelFeed* feed, const std::string& name);

  const std::vector<LiveChannel>& channels() const { return feed_->channels(); }

  // Adds a viewer and tells it the channels. It must leave before it is destroyed.
  void Join(ViewerClient* viewer);
  void Leave(ViewerClient* viewer);
  bool empty() const { return viewers_.empty(); }

  // To be called when a viewer's subscriptions have changed.
  void CountSubscriptions();

  // Sends new messages to the viewers.
  void Tick(Time now);

  int viewers() const { return viewer_count_; }

 private:
  ChannelFeed* feed_;
  std::string server_info_, advertisement_;
  std::vector<ViewerClient*> viewers_;
  Time losses_told_{};
  std::atomic<int> viewer_count_{0};
};

}  // namespace kestrel
