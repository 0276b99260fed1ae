// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "kestrel/app/views/task_view.h"
#include "kestrel/app/web_server/channel_feed.h"
#include "kestrel/flight/session/asynchronous_sink.h"

namespace kestrel {

// Makes messages of a running flight for viewers, with the topics and messages of
// ObservationWriter. A thread of its own makes only the messages of topics with a subscription.
// Without any a frame costs the vision thread one read of a number.
class FlightLive : public ObservationSink {
 public:
  // A camera after the first one: its topics have its name, as /cam1/image.
  struct FurtherCamera {
    std::string name;
    CameraIntrinsics camera;
    TaskView view;
  };

  // 'max_image_rate_hz': limit for the images of a camera; the other messages are made for each
  // frame.
  FlightLive(const CameraIntrinsics& camera, const TaskView& view, double max_image_rate_hz,
             const std::vector<FurtherCamera>& further = {});

  // The channels for a WebServer; valid as long as this.
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
