// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "kestrel/app/console/channel_feed.h"
#include "kestrel/app/console/viewer_request.h"
#include "kestrel/core/base/time.h"

namespace kestrel {

// A message on its way to a viewer: its head, which is of this viewer alone, and what all viewers
// share, null where that is nothing.
struct ViewerMessage {
  std::string head;
  std::shared_ptr<const std::string> content;
  bool is_text = false;
};

// What one viewer has subscribed to, and what waits for it. Of images only the newest waits, and
// only until there is nothing else; of all else the oldest goes when there is too much. By one
// thread.
class ViewerFlow {
 public:
  // 'capacity': of messages that wait, at least 1. 'channels' outlive this.
  ViewerFlow(const std::vector<LiveChannel>* channels, std::size_t capacity);

  // Takes what the viewer has sent. What cannot be done is said to it.
  void Take(const ViewerRequest& request);

  // A bit for each channel that it has subscribed to.
  std::uint64_t wanted() const;

  // Takes a message that the viewer has subscribed to; any other is none of its business.
  void Offer(const ChannelMessage& message);
  void Say(std::string text);  // JSON
  // Says how many messages were left out since it was said the last time, if any were.
  void SayLosses();

  // What is to be sent next; nothing when nothing waits.
  std::optional<ViewerMessage> Pop();

 private:
  void Subscribe(const ViewerSubscription& subscription);
  void Unsubscribe(std::uint32_t id);
  void Push(ViewerMessage message);
  void Warn(const std::string& text);

  const std::vector<LiveChannel>* channels_;
  std::size_t capacity_;
  std::map<std::size_t, std::uint32_t> ids_;  // of subscriptions, by channel
  std::deque<ViewerMessage> waiting_;
  std::map<std::size_t, ChannelMessage> images_;  // by channel
  std::uint64_t lost_messages_ = 0, lost_images_ = 0;
};

// What a viewer is told first: {"op": "serverInfo", ...}. 'session': of this run of the program.
std::string ServerInfoJson(const std::string& name, const std::string& session);
// {"op": "advertise", ...}: a channel's number is its place in the list.
std::string AdvertiseJson(const std::vector<LiveChannel>& channels);

}  // namespace kestrel
