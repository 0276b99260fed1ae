// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "kestrel/app/web_server/channel_feed.h"
#include "kestrel/app/web_server/live_page.h"
#include "kestrel/app/web_server/viewer_flow.h"

namespace kestrel {

// The state that the viewers of a flight share. Used by the server's thread; any thread may call
// viewers().
class ViewerHub {
 public:
  // 'feed' outlives the hub. 'name': name of the flight for viewers. 'capacity': length of a
  // viewer's queue.
  ViewerHub(ChannelFeed* feed, const std::string& name, int capacity);

  // Begins the conversation with a viewer, which gets the list of the channels. It ends before the
  // hub.
  std::unique_ptr<WebConversation> Begin();

  // Gives new messages to the viewers.
  void Tick(Time now);

  int viewers() const { return viewer_count_; }

 private:
  class Viewer;

  void Join(Viewer* viewer);
  void Leave(Viewer* viewer);
  void CountSubscriptions();

  ChannelFeed* feed_;
  std::string server_info_, advertisement_;
  std::size_t capacity_;
  std::vector<Viewer*> viewers_;
  Time losses_reported_{};
  std::atomic<int> viewer_count_{0};
};

}  // namespace kestrel
