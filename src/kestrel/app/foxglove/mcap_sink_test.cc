// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/foxglove/mcap_sink.h"

#include <filesystem>
#include <mutex>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kestrel/app/foxglove/test_observations.h"
#include "kestrel/app/foxglove/test_protobuf.h"
#include "kestrel/app/views/hunt_view.h"
#include "kestrel/app/views/landing_view.h"
#include "kestrel/core/base/test_eventually.h"
#include "kestrel/core/base/test_folder.h"
#include "kestrel/flight/session/land_task.h"
#include "kestrel/io/bags/mcap_reader.h"

namespace kestrel {
namespace {

using ::testing::IsEmpty;

TEST(McapSinkTest, WritesAllObservationsAndEvents) {
  const TestFolder folder;
  const std::string path = folder / "flight.mcap";
  std::vector<std::string> reported;
  {
    const auto mcap = OpenMcapSink(path, false, LandTask({}), ObservedCalibration(), {},
                                   [&](const std::string& text) { reported.push_back(text); });
    mcap->Take(SessionEvent{Now(), EventLevel::kWarning, "the autopilot is gone"});
    for (int i = 0; i < 20; ++i) {
      const Frame frame = ObservedFrame(i);
      mcap->Take(Observation{frame, ObservedLanding(frame.time)});
    }
  }
  EXPECT_THAT(reported, IsEmpty());
  const auto messages = ReadMessages(path);
  EXPECT_EQ(messages.at("/result").size(), 20u);
  ASSERT_EQ(messages.at("/log").size(), 2u);
  EXPECT_EQ(messages.at("/log")[0].fields.bytes(3), "the autopilot is gone");
  EXPECT_EQ(messages.at("/log")[0].fields.number<std::int64_t>(2), 3);
}

// After a crash the file would be like this: readable, although nothing follows.
TEST(McapSinkTest, WritesFrameWithinASecond) {
  const TestFolder folder;
  const std::string path = folder / "flight.mcap";
  const auto mcap =
      OpenMcapSink(path, false, LandTask({}), ObservedCalibration(), {}, [](const std::string&) {});
  const Frame frame = ObservedFrame(0);
  mcap->Take(Observation{frame, ObservedLanding(frame.time)});
  EXPECT_TRUE(Eventually([&] {
    std::size_t topics = 0;
    // The file may be missing, or may not be complete enough yet.
    InputErrorOf([&] { topics = McapReader(path).topics().size(); });
    return topics == 9;
  }));
}

TEST(McapSinkTest, ReportsFullDiskAndContinuesFlight) {
  std::mutex mutex;
  std::vector<std::string> reported;
  {
    const auto mcap = OpenMcapSink("/dev/full", true, LandTask({}), ObservedCalibration(), {},
                                   [&](const std::string& text) {
                                     const std::lock_guard lock(mutex);
                                     reported.push_back(text);
                                   });
    for (int i = 0; i < 40; ++i) {
      const Frame frame = ObservedFrame(i);
      mcap->Take(Observation{frame, ObservedLanding(frame.time)});
    }
  }
  ASSERT_EQ(reported.size(), 1u);
  EXPECT_EQ(reported[0], "/dev/full: cannot be written: the flight goes on without it");
}

}  // namespace
}  // namespace kestrel
