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
  // Sends what there is to send, unless something is on its way.
  virtual void SendNext() = 0;
};

// What the viewers of a flight's messages share. By the console's thread, the number by any.
class ViewerHub {
 public:
  // 'feed' outlives the hub. 'name': of what is shown.
  ViewerHub(ChannelFeed* feed, const std::string& name);

  const std::vector<LiveChannel>& channels() const { return feed_->channels(); }

  // A viewer comes: it is told what there is. It leaves before it is destroyed.
  void Join(ViewerClient* viewer);
  void Leave(ViewerClient* viewer);
  bool empty() const { return viewers_.empty(); }

  // Some viewer has subscribed to something else.
  void CountSubscriptions();

  // Hands out what is new.
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
