// SPDX-License-Identifier: BSD-3-Clause
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kestrel/core/base/error.h"
#include "kestrel/core/base/test_folder.h"
#include "kestrel/flight/onboard/session.h"
#include "kestrel/flight/session/observation_sinks.h"

namespace kestrel {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr int kWidth_px = 8;
constexpr int kHeight_px = 6;

Time AtSecond(double seconds) { return Time(DurationFromSeconds(seconds)); }

// Frames at 1, 2, 3 s; poses at 0.5, 1.5, 2.5 s.
class ThreeFrames : public FrameSource {
 public:
  bool ReadNext(Frame* frame) override {
    if (next_ == 3) return false;
    ++next_;
    *frame = {"frame " + std::to_string(next_), AtSecond(next_),
              cv::Mat::zeros(kHeight_px, width_px, CV_8UC1)};
    return true;
  }
  std::optional<std::size_t> frame_count() const override { return 3; }
  double rate_hz() const override { return 1; }
  std::vector<PoseSample> poses() const override {
    std::vector<PoseSample> poses(3);
    for (int i = 0; i < 3; ++i) poses[i].time = AtSecond(0.5 + i);
    return poses;
  }

  std::vector<GimbalSample> gimbal() const override { return reports; }

  int width_px = kWidth_px;
  std::vector<GimbalSample> reports;

 private:
  int next_ = 0;
};

// Writes down what it gets, and when.
class LoggedVision : public Vision {
 public:
  void AddPose(const PoseSample& pose) override {
    log.push_back("pose " + std::to_string(ToNanoseconds(pose.time) / 100'000'000));
  }
  void AddGimbal(const GimbalSample& report) override {
    log.push_back("gimbal " + std::to_string(ToNanoseconds(report.time) / 100'000'000));
  }
  Duration pose_lead() const override { return Duration::zero(); }
  Observation Process(const Frame& frame) override {
    log.push_back(frame.name);
    return {frame, LandingObservation()};
  }
  void Finish() override { log.emplace_back("finish"); }
  std::string Warning() const override { return log.back() == warned_at ? "mind the gap" : ""; }
  std::string Found() const override { return ""; }

  std::vector<std::string> log;
  std::string warned_at = "no frame";
};

class FrameNames : public ObservationSink {
 public:
  void Take(const Observation& observation) override { names.push_back(observation.frame.name); }
  void Take(const SessionEvent& event) override { events.push_back(event); }
  std::vector<std::string> names;
  std::vector<SessionEvent> events;
};

class RecordedSessionTest : public ::testing::Test {
 protected:
  RecordedSessionTest() {
    auto source = std::make_unique<ThreeFrames>();
    source_ = source.get();
    opened_.source = std::move(source);
    opened_.calibration.intrinsics.width_px = kWidth_px;
    opened_.calibration.intrinsics.height_px = kHeight_px;
  }

  OpenedSource opened_;
  ThreeFrames* source_;
  LoggedVision* vision_ = new LoggedVision();
  std::unique_ptr<Session> session_ = MakeSession(opened_, std::unique_ptr<Vision>(vision_));
  FrameNames* sink_ = session_->sinks().Add(std::make_unique<FrameNames>());
};

TEST_F(RecordedSessionTest, FrameFollowsPosesItNeeds) {
  EXPECT_EQ(session_->Run().outcome, FlightOutcome::kSourceEnded);
  EXPECT_THAT(vision_->log, ElementsAre("pose 5", "pose 15", "frame 1", "pose 25", "frame 2",
                                        "frame 3", "finish"));
  EXPECT_THAT(sink_->names, ElementsAre("frame 1", "frame 2", "frame 3"));
}

TEST(RecordedSessionOnGimbalTest, FrameFollowsReportsItNeeds) {
  auto source = std::make_unique<ThreeFrames>();
  for (const double seconds : {0.8, 1.6, 2.4, 3.2})
    source->reports.push_back({AtSecond(seconds), Eigen::Quaterniond::Identity()});
  OpenedSource opened;
  opened.source = std::move(source);
  opened.calibration.intrinsics.width_px = kWidth_px;
  opened.calibration.intrinsics.height_px = kHeight_px;
  auto vision = std::make_unique<LoggedVision>();
  const auto& log = vision->log;
  const auto session = MakeSession(opened, std::move(vision));
  session->Run();
  EXPECT_THAT(log, ElementsAre("pose 5", "pose 15", "gimbal 8", "gimbal 16", "frame 1", "pose 25",
                               "gimbal 24", "gimbal 32", "frame 2", "frame 3", "finish"));
}

TEST_F(RecordedSessionTest, StopsBeforeNextFrame) {
  const FlightEnd end = session_->Run([this] { return sink_->names.size() == 2; });
  EXPECT_EQ(end.outcome, FlightOutcome::kStopped);
  EXPECT_THAT(sink_->names, ElementsAre("frame 1", "frame 2"));
  EXPECT_NE(vision_->log.back(), "finish");
}

TEST_F(RecordedSessionTest, SinksGetWarningOfVision) {
  vision_->warned_at = "frame 2";
  session_->Run();
  ASSERT_EQ(sink_->events.size(), 1u);
  EXPECT_EQ(sink_->events[0].time, AtSecond(2));
  EXPECT_EQ(sink_->events[0].level, EventLevel::kWarning);
  EXPECT_EQ(sink_->events[0].text, "mind the gap");
}

TEST_F(RecordedSessionTest, ReportsFrameOfAnotherSize) {
  source_->width_px = kWidth_px + 1;
  const std::string error = InputErrorOf([&] { session_->Run(); });
  EXPECT_THAT(error, HasSubstr("frame 1"));
  EXPECT_TRUE(sink_->names.empty());
}

TEST_F(RecordedSessionTest, FailingSinkEndsSession) {
  struct FullDisk : ObservationSink {
    void Take(const Observation&) override { throw InputError("the disk is full"); }
  };
  session_->sinks().Add(std::make_unique<FullDisk>());
  EXPECT_EQ(InputErrorOf([&] { session_->Run(); }), "the disk is full");
  EXPECT_THAT(sink_->names, ElementsAre("frame 1"));
}

}  // namespace
}  // namespace kestrel
