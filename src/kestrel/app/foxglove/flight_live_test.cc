// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/foxglove/flight_live.h"

#include <map>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "kestrel/app/foxglove/test_observations.h"
#include "kestrel/app/foxglove/test_protobuf.h"
#include "kestrel/core/base/test_eventually.h"

namespace kestrel {
namespace {

using namespace std::chrono_literals;

constexpr double kAnyRate_hz = 1e6;

std::size_t ChannelOf(FlightLive* flight, const std::string& topic) {
  const auto& channels = flight->channels()->channels();
  std::size_t channel = 0;
  while (channel < channels.size() && channels[channel].topic != topic) ++channel;
  return channel;
}

// Takes messages, by topic, until there are so many of /result.
std::map<std::string, std::vector<ChannelMessage>> TakeFrames(FlightLive* flight,
                                                              std::size_t frames) {
  std::map<std::string, std::vector<ChannelMessage>> messages;
  Eventually([&] {
    while (auto message = flight->channels()->Take()) {
      messages[flight->channels()->channels()[message->channel].topic].push_back(*message);
    }
    return messages["/result"].size() >= frames;
  });
  return messages;
}

void SeeFrame(FlightLive* flight, int index) {
  const Frame frame = ObservedFrame(index);
  flight->Take(Observation{frame, ObservedLanding(frame.time)});
}

TEST(FlightLiveTest, GivesSameMessagesAsFile) {
  FlightLive flight(ObservedCamera(), ObservedView(), kAnyRate_hz);
  flight.channels()->SetWanted(~std::uint64_t{0});
  for (int i = 0; i < 3; ++i) {
    SeeFrame(&flight, i);
    const auto messages = TakeFrames(&flight, 1);
    for (const char* topic : {"/camera/image", "/camera/calibration", "/camera/annotations",
                              "/camera/pose", "/tf", "/landing/target", "/scene", "/result"}) {
      ASSERT_EQ(messages.count(topic), 1u) << topic;
      EXPECT_EQ(messages.at(topic)[0].time, ObservedFrame(i).time) << topic;
    }
    const ProtobufFields result(*messages.at("/result")[0].content);
    EXPECT_EQ(result.time(1), ObservedFrame(i).time);
  }
}

TEST(FlightLiveTest, MakesRequestedMessagesOnly) {
  FlightLive flight(ObservedCamera(), ObservedView(), kAnyRate_hz);
  const Frame frame = ObservedFrame(0);
  flight.Take(Observation{frame, ObservedLanding(frame.time)});
  EXPECT_EQ(frame.image.u->refcount, 1);  // nobody looks: it is not even stored
  flight.channels()->SetWanted(std::uint64_t{1} << ChannelOf(&flight, "/result"));
  SeeFrame(&flight, 1);
  const auto messages = TakeFrames(&flight, 1);
  EXPECT_EQ(messages.size(), 1u);
}

TEST(FlightLiveTest, LimitsImageRate) {
  FlightLive flight(ObservedCamera(), ObservedView(), /*max_image_rate_hz=*/0.1);
  flight.channels()->SetWanted(~std::uint64_t{0});
  for (int i = 0; i < 5; ++i) SeeFrame(&flight, i);
  const auto messages = TakeFrames(&flight, 5);
  EXPECT_EQ(messages.at("/result").size(), 5u);
  EXPECT_EQ(messages.at("/camera/image").size(), 1u);
}

TEST(FlightLiveTest, ReportsEvents) {
  FlightLive flight(ObservedCamera(), ObservedView(), kAnyRate_hz);
  flight.channels()->SetWanted(~std::uint64_t{0});
  flight.Take(SessionEvent{Now(), EventLevel::kWarning, "camera came back"});
  SeeFrame(&flight, 0);
  const auto messages = TakeFrames(&flight, 1);
  ASSERT_GE(messages.count("/log"), 1u);
  EXPECT_EQ(ProtobufFields(*messages.at("/log")[0].content).bytes(3), "camera came back");
}

}  // namespace
}  // namespace kestrel
