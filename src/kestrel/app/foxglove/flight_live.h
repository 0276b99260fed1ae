// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>
#include <variant>

#include "kestrel/app/console/channel_feed.h"
#include "kestrel/app/console/hunt_view.h"
#include "kestrel/app/console/landing_view.h"
#include "kestrel/flight/session/asynchronous_sink.h"

namespace kestrel {

// A flight as the messages that viewers can subscribe to while it happens: the topics and messages
// of ObservationWriter, made by a thread of its own, and only those that somebody has subscribed
// to. Else a frame costs the vision one look at a number.
class FlightLive : public ObservationSink {
 public:
  // 'max_image_rate_hz': of /camera/image; all else is of each frame.
  FlightLive(const CameraIntrinsics& camera, const std::variant<LandingView, HuntView>& view,
             double max_image_rate_hz);

  // What a WebServer gives to viewers; for as long as this is there.
  ChannelFeed* channels() { return &feed_; }

  bool IsWanted() const override { return feed_.IsWatched(); }
  void Take(const Observation& observation) override { messages_.Take(observation); }
  void Take(const SessionEvent& event) override {
    if (IsWanted()) messages_.Take(event);
  }
  void Finish() override { messages_.Finish(); }

 private:
  ChannelFeed feed_;
  AsynchronousSink messages_;
};

}  // namespace kestrel
