// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <string>
#include <thread>
#include <variant>

#include "kestrel/console/channel_feed.h"
#include "kestrel/foxglove/flight_writer.h"

namespace kestrel {

// A flight as the messages that viewers can subscribe to while it happens: the topics and messages
// of ObservationWriter, made by a thread of its own, and only those that somebody has subscribed
// to. Else a frame costs the vision one look at a number.
class FlightLive : public FlightWriter {
 public:
  // 'max_image_rate_hz': of /camera/image; all else is of each frame.
  FlightLive(const CameraIntrinsics& camera, std::variant<LandingView, HuntView> view,
             double max_image_rate_hz);
  ~FlightLive() override;

  // What a WebServer gives to viewers; for as long as this is there.
  ChannelFeed* channels() { return &feed_; }

 private:
  // Puts messages into the feed.
  class Sink : public FoxgloveSink {
   public:
    Sink(FlightLive* flight, double max_image_rate_hz);

   private:
    bool Wants(std::string_view topic) override;
    void Put(const FoxgloveTopicInfo& topic, Time time, std::string message) override;
    bool IsTimeForImage();

    FlightLive* flight_;
    Duration min_image_interval_;
    Time image_made_{};
  };

  bool IsWanted() const override { return feed_.IsWatched(); }
  void Run();

  ChannelFeed feed_;
  Sink sink_;
  ObservationWriter writer_;
  std::atomic<bool> is_over_{false};
  std::thread thread_;
};

}  // namespace kestrel
