// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/foxglove/flight_live.h"

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <memory>
#include <sys/resource.h>
#include <utility>
#include <vector>

#include "kestrel/base/error.h"
#include "kestrel/foxglove/foxglove_topics.h"
#include "kestrel/onboard/thread_setup.h"

namespace kestrel {
namespace {

constexpr std::size_t kLiveFrames = 16;
// With more that wait, images are left out until there are fewer.
constexpr std::size_t kFramesInTime = 2;
constexpr Duration kLivePatience = std::chrono::milliseconds(200);
// What flies goes first.
constexpr int kNiceness = 10;

std::vector<LiveChannel> ChannelsOf(bool is_hunt) {
  std::vector<LiveChannel> channels;
  for (const FoxgloveTopicInfo& topic : kObservationTopics) {
    if (is_hunt && topic.name == kTargetTopic.name) continue;
    channels.push_back({.topic = std::string(topic.name),
                        .encoding = "protobuf",
                        .schema_name = std::string(topic.type),
                        .schema_encoding = "protobuf",
                        .schema = topic.schema(),
                        .is_image = topic.name == kImageTopic.name});
  }
  return channels;
}

// The channel of a topic of kObservationTopics.
std::size_t ChannelOf(const std::vector<LiveChannel>& channels, std::string_view topic) {
  const auto channel = std::find_if(channels.begin(), channels.end(),
                                    [&](const LiveChannel& each) { return each.topic == topic; });
  return static_cast<std::size_t>(channel - channels.begin());
}

}  // namespace

FlightLive::Sink::Sink(FlightLive* flight, double max_image_rate_hz)
    : flight_(flight), min_image_interval_(DurationFromSeconds(1 / max_image_rate_hz)) {}

bool FlightLive::Sink::Wants(std::string_view topic) {
  const ChannelFeed& feed = flight_->feed_;
  if (!feed.IsWanted(ChannelOf(feed.channels(), topic))) return false;
  return topic != kImageTopic.name || IsTimeForImage();
}

bool FlightLive::Sink::IsTimeForImage() {
  const Time now = Now();
  if (now - image_made_ < min_image_interval_ || flight_->waiting_frames() > kFramesInTime) {
    return false;
  }
  image_made_ = now;
  return true;
}

void FlightLive::Sink::Put(const FoxgloveTopicInfo& topic, Time time, std::string message) {
  ChannelFeed& feed = flight_->feed_;
  const std::size_t channel = ChannelOf(feed.channels(), topic.name);
  if (!feed.IsWanted(channel)) return;
  feed.Add({channel, time, std::make_shared<const std::string>(std::move(message))});
}

FlightLive::FlightLive(const CameraIntrinsics& camera, std::variant<LandingView, HuntView> view,
                       double max_image_rate_hz)
    : FlightWriter(kLiveFrames),
      feed_(ChannelsOf(std::holds_alternative<HuntView>(view))),
      sink_(this, max_image_rate_hz),
      writer_(&sink_, camera, std::move(view)),
      thread_([this] { Run(); }) {}

FlightLive::~FlightLive() {
  is_over_ = true;
  EndFrames();
  thread_.join();
}

void FlightLive::Run() {
  SetUpThisThread("foxglove", {});
  // Of this thread alone, on Linux. Where it is not permitted all goes on as usual.
  setpriority(PRIO_PROCESS, 0, kNiceness);
  while (!is_over_) {
    try {
      WriteNext(&writer_, kLivePatience);
    } catch (const InputError& error) {  // an image that cannot be shown
      writer_.WriteLog(Now(), EventLevel::kWarning, error.what());
    }
  }
}

}  // namespace kestrel
