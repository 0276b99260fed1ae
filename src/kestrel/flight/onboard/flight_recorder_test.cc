// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/onboard/flight_recorder.h"

#include <array>
#include <chrono>
#include <memory>
#include <mutex>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kestrel/app/evaluation/flight_truth.h"
#include "kestrel/app/evaluation/landing_truth.h"
#include "kestrel/core/base/read_file.h"
#include "kestrel/core/base/test_eventually.h"
#include "kestrel/io/bags/open_recording.h"
#include "kestrel/io/recording/euroc/euroc_recording.h"
#include "kestrel/io/recording/open_source.h"
#include "kestrel/io/recording/tables/csv_table.h"
#include "kestrel/io/recording/test_files.h"

namespace kestrel {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

Time Ms(int ms) { return Time(seconds(1000) + milliseconds(ms)); }

CameraCalibration Mounted() {
  CameraCalibration calibration;
  calibration.intrinsics = {.width_px = 64,
                            .height_px = 48,
                            .fx_px = 60,
                            .fy_px = 60,
                            .cx_px = 32,
                            .cy_px = 24,
                            .distortion = {}};
  calibration.body_from_camera = RigidTransform{};
  calibration.clock_offset = milliseconds(12);
  return calibration;
}

Frame FrameAt(int ms) { return {"", Ms(ms), NoiseImage(64, 48, CV_8UC1, ms + 1)}; }

class FlightRecorderTest : public ::testing::Test {
 protected:
  std::string Folder() const { return folder_ / "flight"; }
  std::string Mav0(const std::string& name) const { return folder_ / ("flight/mav0/" + name); }

  std::unique_ptr<FlightRecorder> Recorder(FlightRecorderOptions options = {},
                                           bool replace = false) {
    if (options.free_space_mb == FlightRecorderOptions{}.free_space_mb) options.free_space_mb = 0;
    options.commit_period_s = 0.02;
    return std::make_unique<FlightRecorder>(Folder(), replace, Mounted(), 50, options,
                                            [this](const std::string& text) {
                                              const std::lock_guard lock(mutex_);
                                              reported_.push_back(text);
                                            });
  }

  std::vector<std::string> Reported() {
    const std::lock_guard lock(mutex_);
    return reported_;
  }

  TestFolder folder_;
  std::mutex mutex_;
  std::vector<std::string> reported_;
};

TEST_F(FlightRecorderTest, WritesReadableRecording) {
  for (const char* compression : {"png", "jpg"}) {
    {
      const auto recorder = Recorder({.compression = compression}, true);
      for (int i = 0; i < 10; ++i) {
        recorder->AddPose({Ms(20 * i - 1), {Eigen::Quaterniond::Identity(), {0.5 * i, 0, 4}}});
        recorder->AddFrame(FrameAt(20 * i));
      }
    }
    const auto source = OpenSource({Folder()});
    ASSERT_EQ(source->frame_count(), 10u);
    ASSERT_THAT(source->poses(), SizeIs(10));
    EXPECT_EQ(source->poses()[3].time, Ms(59));
    EXPECT_EQ(source->poses()[3].world_from_body.translation.x(), 1.5);
    int i = 0;
    for (Frame frame; source->Next(&frame); ++i) {
      EXPECT_EQ(frame.time, Ms(20 * i));
      const double difference = cv::norm(frame.image, FrameAt(20 * i).image, cv::NORM_INF);
      EXPECT_LE(difference, compression == std::string("png") ? 0 : 60);
    }
    const CameraCalibration calibration = *source->calibration();
    EXPECT_EQ(calibration.intrinsics.width_px, 64);
    EXPECT_EQ(calibration.clock_offset, milliseconds(12));
    EXPECT_TRUE(calibration.body_from_camera);
  }
  EXPECT_THAT(Reported(), IsEmpty());
}

TEST_F(FlightRecorderTest, WritesTwoCamerasThatAreReadAsOneRecording) {
  {
    CameraCalibration second = Mounted();
    second.intrinsics.fx_px = 90;
    FlightRecorder recorder(Folder(), false, Mounted(), 50, {.free_space_mb = 0}, {}, {second});
    for (int i = 0; i < 5; ++i) {
      recorder.AddFrame(FrameAt(20 * i + 10));
      Frame frame = FrameAt(20 * i);  // earlier than that of the other camera
      frame.camera = 1;
      recorder.AddFrame(frame);
      recorder.AddFrame(frame);  // not later than the one before
    }
  }
  const OpenedSource opened = OpenRecording({.sources = {Folder()}, .all_cameras = true});
  ASSERT_THAT(opened.further, SizeIs(1));
  EXPECT_EQ(opened.further[0].name, "cam1");
  EXPECT_EQ(opened.further[0].intrinsics.fx_px, 90);
  std::array<int, 2> frames{};
  for (Frame frame; opened.source->Next(&frame);) ++frames[frame.camera];
  EXPECT_THAT(frames, ElementsAre(5, 5));
  EXPECT_THAT(ReadFile(Mav0("cam1/dropped.csv")), HasSubstr("not later than the image before"));
}

TEST_F(FlightRecorderTest, WritesTruthForEvaluation) {
  {
    const auto recorder = Recorder();
    for (int i = 0; i < 5; ++i) {
      TruePattern truth;
      truth.time = Ms(20 * i);
      truth.world_from_pattern.translation = {0.1 * i, 0, 0};
      truth.velocity_in_world = {5, 0, 0};
      truth.visible_fraction = 1;
      recorder->AddTruePose({Ms(20 * i), {Eigen::Quaterniond::Identity(), {0, 0, 4}}});
      recorder->AddFrame(FrameAt(20 * i), truth);
    }
  }
  const FlightTruth flight(Folder());
  EXPECT_THAT(flight.frames(), SizeIs(5));
  EXPECT_TRUE(flight.WorldFromCamera(Ms(30)));
  const std::string file = Mav0("landing_pattern0/data.csv");
  const auto patterns = ParseTruePatterns(ReadFile(file), file);
  ASSERT_THAT(patterns, SizeIs(5));
  EXPECT_NEAR(patterns[2].world_from_pattern.translation.x(), 0.2, 1e-9);
  EXPECT_EQ(patterns[2].velocity_in_world.x(), 5);
}

TEST_F(FlightRecorderTest, RowsHaveCompleteImagesWhileRecording) {
  const auto recorder = Recorder();
  int ms = 0;
  EXPECT_TRUE(Eventually([&] {
    recorder->AddFrame(FrameAt(ms++));
    if (!std::filesystem::exists(Mav0("cam0/data.csv"))) return false;
    const auto source = OpenSource({Folder()});
    for (Frame frame; source->Next(&frame);) EXPECT_EQ(frame.image.cols, 64);
    return *source->frame_count() >= 20;
  }));
}

TEST_F(FlightRecorderTest, DropsDataOutOfOrder) {
  {
    const auto recorder = Recorder();
    for (const int ms : {0, 20, 10, 20, 30}) {
      recorder->AddFrame(FrameAt(ms));
      recorder->AddPose({Ms(ms), {}});
      recorder->AddExposure(Ms(ms), 1e-3);
    }
  }
  const auto source = OpenSource({Folder()});
  EXPECT_EQ(source->frame_count(), 3u);
  EXPECT_THAT(source->poses(), SizeIs(3));
  EXPECT_EQ(ReadFile(Mav0("cam0/dropped.csv")),
            "#timestamp [ns],reason\n"
            "1000010000000,not later than the image before\n"
            "1000020000000,not later than the image before\n");
  EXPECT_EQ(ReadFile(Mav0("cam0/exposure.csv")),
            "#timestamp [ns],exposure [s]\n1000000000000,0.0010000\n1000020000000,0.0010000\n"
            "1000030000000,0.0010000\n");
}

TEST_F(FlightRecorderTest, DropsAndNotesFramesWhenDiskIsSlow) {
  RecorderCounters counters;
  constexpr int kFrames = 200;
  {
    const auto recorder = Recorder({.png_level = 9, .queue_frames = 2});
    const cv::Mat large = NoiseImage(752, 480, CV_8UC1);
    const Time start = Now();
    for (int i = 0; i < kFrames; ++i) recorder->AddFrame({"", Ms(i), large});
    EXPECT_LT(Now() - start, seconds(2)) << "the giver does not wait";
    Eventually([&] {
      counters = recorder->counters();
      return counters.images + counters.dropped == kFrames;
    });
  }
  EXPECT_EQ(counters.images + counters.dropped, kFrames);
  EXPECT_GT(counters.dropped, 0u);
  const std::string text = ReadFile(Mav0("cam0/dropped.csv"));
  const CsvTable dropped(text, "dropped.csv");
  EXPECT_EQ(dropped.row_count(), counters.dropped);
  EXPECT_EQ(dropped.Text(0, dropped.Column("reason")), "the disk is too slow");
  EXPECT_EQ(OpenSource({Folder()})->frame_count(), counters.images);
}

TEST_F(FlightRecorderTest, FullDiskStopsImagesOnly) {
  {
    const auto recorder = Recorder({.free_space_mb = 1e15});
    for (int i = 0; i < 3; ++i) {
      recorder->AddFrame(FrameAt(i));
      recorder->AddPose({Ms(i), {}});
    }
    EXPECT_TRUE(Eventually([&] { return recorder->counters().dropped == 3; }));
    EXPECT_FALSE(recorder->is_recording_images());
  }
  EXPECT_THAT(Reported(), ElementsAre(HasSubstr("no more images")));
  const std::string file = Mav0("nav0/data.csv");
  EXPECT_THAT(ParsePoseRows(ReadFile(file), file), SizeIs(3));
  EXPECT_THAT(ReadFile(Mav0("cam0/dropped.csv")), HasSubstr("the disk is full"));
}

TEST_F(FlightRecorderTest, ResumesImagesWhenDiskIsWritableAgain) {
  const std::string data = Mav0("cam0/data");
  {
    const auto recorder = Recorder();
    std::filesystem::remove(data);
    int ms = 0;
    const auto record_until = [&](bool is_recording) {
      EXPECT_TRUE(Eventually([&] {
        recorder->AddFrame(FrameAt(ms++));
        return recorder->is_recording_images() == is_recording;
      }));
    };
    record_until(false);
    std::filesystem::create_directory(data);
    record_until(true);
  }
  EXPECT_THAT(Reported(), ElementsAre(HasSubstr("no more images"), HasSubstr("images go on")));
  const auto source = OpenSource({Folder()});
  Frame frame;
  EXPECT_TRUE(source->Next(&frame));
}

TEST_F(FlightRecorderTest, WritesPacketsToTlog) {
  const std::array<std::uint8_t, 3> packet{0xfd, 0x00, 0x17};
  const std::array<std::uint8_t, 281> too_long{};
  const auto utc_us = [] {
    return std::chrono::duration_cast<std::chrono::microseconds>(
               std::chrono::system_clock::now().time_since_epoch())
        .count();
  };
  const std::int64_t before_us = utc_us();
  {
    const auto recorder = Recorder();
    recorder->AddPacket(Now(), packet);
    recorder->AddPacket(Now(), too_long);
  }
  const std::string bytes = ReadFile(Folder() + "/mavlink.tlog");
  ASSERT_THAT(bytes, SizeIs(11));
  std::int64_t us = 0;
  for (int i = 0; i < 8; ++i) us = us << 8 | static_cast<std::uint8_t>(bytes[i]);
  EXPECT_NEAR(1e-6 * static_cast<double>(us - before_us), 0, 10);
  EXPECT_EQ(bytes.substr(8), std::string("\xfd\x00\x17", 3));
}

TEST_F(FlightRecorderTest, RefusesFolderWithOtherFiles) {
  folder_.Write("flight/notes.txt", "mine");
  EXPECT_THAT(InputErrorOf([&] { Recorder(); }), HasSubstr("is no recording"));
  std::filesystem::remove_all(Folder());
  { Recorder()->AddFrame(FrameAt(0)); }
  EXPECT_THAT(InputErrorOf([&] { Recorder(); }), HasSubstr("exists already"));
  { Recorder({}, true)->AddFrame(FrameAt(1)); }
  EXPECT_EQ(OpenSource({Folder()})->frame_count(), 1u);
  const auto recorder = Recorder({}, true);
  EXPECT_THAT(InputErrorOf([&] { Recorder({}, true); }), HasSubstr("another program"));
}

TEST_F(FlightRecorderTest, RefusesInvalidOptions) {
  EXPECT_THAT(InputErrorOf([&] { Recorder({.compression = "gif"}); }), HasSubstr("'gif'"));
}

}  // namespace
}  // namespace kestrel
