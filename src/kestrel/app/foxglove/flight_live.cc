// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/foxglove/flight_live.h"

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

#include "kestrel/app/foxglove/foxglove_topics.h"
#include "kestrel/app/foxglove/observation_writer.h"
#include "kestrel/core/base/error.h"

namespace kestrel {
namespace {

constexpr std::size_t kLiveFrames = 16;
// Images are left out while more frames than this wait.
constexpr std::size_t kFramesInTime = 2;
// The threads that fly have priority.
constexpr int kNiceness = 10;

LiveChannel ChannelOf(const FoxgloveTopicInfo& topic, std::string_view name) {
  return {.topic = std::string(name),
          .encoding = "protobuf",
          .schema_name = std::string(topic.type),
          .schema_encoding = "protobuf",
          .schema = topic.schema(),
          .is_image = topic.type == InfoOf(kImageTopic).type};
}

std::vector<LiveChannel> ChannelsOf(const TaskView& view,
                                    const std::vector<FlightLive::FurtherCamera>& further) {
  std::vector<LiveChannel> channels;
  for (const FoxgloveTopicInfo& topic : kObservationTopics) {
    if (topic.name == kTargetTopic.name && std::holds_alternative<HuntView>(view)) continue;
    channels.push_back(ChannelOf(topic, topic.name));
  }
  for (const FlightLive::FurtherCamera& camera : further) {
    const CameraTopics topics(camera.name);
    channels.push_back(ChannelOf(InfoOf(kImageTopic), topics.image));
    channels.push_back(ChannelOf(InfoOf(kCalibrationTopic), topics.calibration));
    channels.push_back(ChannelOf(InfoOf(kAnnotationsTopic), topics.annotations));
    channels.push_back(ChannelOf(InfoOf(kCameraPoseTopic), topics.pose));
  }
  return channels;
}

// Index of a topic of ChannelsOf among the channels.
std::size_t IndexOf(const std::vector<LiveChannel>& channels, std::string_view topic) {
  const auto channel = std::find_if(channels.begin(), channels.end(),
                                    [&](const LiveChannel& each) { return each.topic == topic; });
  return static_cast<std::size_t>(channel - channels.begin());
}

// Passes messages to the feed.
class FeedSink : public FoxgloveSink {
 public:
  FeedSink(ChannelFeed* feed, double max_image_rate_hz)
      : feed_(*feed),
        min_image_interval_(DurationFromSeconds(1 / max_image_rate_hz)),
        images_made_(feed->channels().size()) {}

  void set_waiting_frames(std::size_t waiting) { waiting_frames_ = waiting; }

 private:
  bool Wants(std::string_view topic) override {
    const std::size_t channel = IndexOf(feed_.channels(), topic);
    if (!feed_.IsWanted(channel)) return false;
    return !feed_.channels()[channel].is_image || IsTimeForImage(channel);
  }

  void Put(const FoxgloveTopicInfo& topic, Time time, std::string message) override {
    const std::size_t channel = IndexOf(feed_.channels(), topic.name);
    if (!feed_.IsWanted(channel)) return;
    feed_.Add({channel, time, std::make_shared<const std::string>(std::move(message))});
  }

  bool IsTimeForImage(std::size_t channel) {
    const Time now = Now();
    Time& made = images_made_[channel];
    if (now - made < min_image_interval_ || waiting_frames_ > kFramesInTime) return false;
    made = now;
    return true;
  }

  ChannelFeed& feed_;
  Duration min_image_interval_;
  std::vector<Time> images_made_;  // newest image of each channel
  std::size_t waiting_frames_ = 0;
};

class FeedWriter : public SinkWriter {
 public:
  FeedWriter(ChannelFeed* feed, const CameraIntrinsics& camera, const TaskView& view,
             double max_image_rate_hz, const std::vector<FlightLive::FurtherCamera>& further)
      : feed_(*feed), sink_(feed, max_image_rate_hz), writer_(&sink_, camera, view) {
    for (const auto& each : further) writer_.AddCamera(each.name, each.camera, each.view);
  }

  bool IsWanted() const override { return feed_.IsWatched(); }
  void Write(const Observation& observation, std::size_t waiting) override {
    sink_.set_waiting_frames(waiting);
    try {
      writer_.Write(observation);
    } catch (const InputError& error) {  // the image cannot be shown
      Write(SessionEvent{Now(), EventLevel::kWarning, error.what()});
    }
  }
  void Write(const SessionEvent& event) override { writer_.Write(event); }

 private:
  ChannelFeed& feed_;
  FeedSink sink_;
  ObservationWriter writer_;
};

}  // namespace

FlightLive::FlightLive(const CameraIntrinsics& camera, const TaskView& view,
                       double max_image_rate_hz, const std::vector<FurtherCamera>& further)
    : feed_(ChannelsOf(view, further)),
      messages_({.thread_name = "foxglove", .frames = kLiveFrames, .niceness = kNiceness},
                std::make_unique<FeedWriter>(&feed_, camera, view, max_image_rate_hz, further)) {}

}  // namespace kestrel
