// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "kestrel/app/web_server/channel_feed.h"
#include "kestrel/app/web_server/live_page.h"
#include "kestrel/app/web_server/viewer_request.h"
#include "kestrel/core/base/time.h"

namespace kestrel {

// The subscriptions of one viewer and its queue of messages. Of each image channel only the newest
// image waits, and it is sent only when no other message waits. When the queue of other messages is
// full the oldest is dropped. Used by one thread.
class ViewerFlow {
 public:
  // 'capacity': length of the queue, at least 1. 'channels' outlive this.
  ViewerFlow(const std::vector<LiveChannel>* channels, std::size_t capacity);

  // Executes a viewer's request. Sends the viewer an error if it cannot be executed.
  void Take(const ViewerRequest& request);

  // Returns one bit for each channel with a subscription.
  std::uint64_t wanted() const;

  // Queues a message if the viewer has subscribed to its channel; otherwise does nothing.
  void Offer(const ChannelMessage& message);
  void Report(std::string text);  // 'text': JSON
  // Reports to the viewer how many messages were dropped since the last report, if any.
  void ReportLosses();

  // Returns the message to be sent next; nothing when none waits.
  std::optional<WebMessage> Pop();

 private:
  void Subscribe(const ViewerSubscription& subscription);
  void Unsubscribe(std::uint32_t id);
  void Push(WebMessage message);
  void Warn(const std::string& text);

  const std::vector<LiveChannel>* channels_;
  std::size_t capacity_;
  std::map<std::size_t, std::uint32_t> ids_;  // ids of subscriptions, by channel
  std::deque<WebMessage> waiting_;
  std::map<std::size_t, ChannelMessage> images_;  // by channel
  std::uint64_t lost_messages_ = 0, lost_images_ = 0;
};

// The first message to a viewer: {"op": "serverInfo", ...}. 'session': id of this run of the
// program.
std::string ServerInfoJson(const std::string& name, const std::string& session);
// Returns {"op": "advertise", ...}. A channel's id is its index in the list.
std::string AdvertiseJson(const std::vector<LiveChannel>& channels);

}  // namespace kestrel
