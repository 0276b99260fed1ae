// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/io/bags/recording_sink.h"

#include <filesystem>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kestrel/core/base/read_file.h"
#include "kestrel/core/codec/image_codec.h"
#include "kestrel/io/bags/bag_source.h"
#include "kestrel/io/bags/test_bags.h"
#include "kestrel/io/recording/euroc/euroc_text.h"
#include "kestrel/io/recording/test_files.h"

namespace kestrel {
namespace {

using ::testing::HasSubstr;

void CopyTo(const std::string& destination, const std::string& source) {
  const auto from = OpenSourceOrBag({source}, PixelFormat::kBgr, {});
  const std::vector<PoseSample> poses = from->poses();
  const auto to = NewRecording(
      destination, {from->calibration(), from->rate_hz(), !poses.empty(), /*has_motion=*/false},
      Compression::kNone, /*replace=*/false);
  for (const PoseSample& pose : poses) to->AddPose(pose);
  for (Frame frame; from->Next(&frame);) to->AddFrame(frame);
  to->Close();
}

// Writes gray and coloured images, a mount and poses.
void WriteEurocFlight(const TestFolder& folder) {
  std::vector<PoseSample> poses;
  std::string images = "#timestamp [ns],filename\n";
  for (int i = 0; i < 5; ++i) {
    const std::string name = std::to_string(ToNanoseconds(BagTime(i))) + ".png";
    WriteTestImage(folder, "flight/mav0/cam0/data/" + name,
                   NoiseImage(32, 24, i % 2 == 0 ? CV_8UC1 : CV_8UC3, i + 1));
    images += std::to_string(ToNanoseconds(BagTime(i))) + "," + name + "\n";
    RigidTransform pose;
    pose.translation = {0.1 * i, -2, 30.123456};
    pose.rotation = RotationBy({0.1, 0.02 * i, 1});
    poses.push_back({BagTime(i), pose});
  }
  CameraCalibration calibration;
  calibration.intrinsics = BagCamera();
  calibration.body_from_camera = RigidTransform{{0, 1, 0, 0}, {0.1, 0, -0.05}};
  folder.Write("flight/mav0/cam0/data.csv", images);
  folder.Write("flight/mav0/cam0/sensor.yaml", EurocCameraText(calibration, 25));
  folder.Write("flight/mav0/nav0/data.csv", EurocPoseText(poses));
}

class ThereAndBack : public ::testing::TestWithParam<const char*> {};

TEST_P(ThereAndBack, RecordingIsUnchanged) {
  const TestFolder folder;
  WriteEurocFlight(folder);
  const std::string bag = folder / GetParam();
  CopyTo(bag, folder / "flight");
  CopyTo(folder / "back", bag);
  for (const char* file : {"mav0/cam0/data.csv", "mav0/cam0/sensor.yaml", "mav0/nav0/data.csv"}) {
    EXPECT_EQ(ReadFile(folder / ("back/" + std::string(file))),
              ReadFile(folder / ("flight/" + std::string(file))));
  }
  const auto images = std::filesystem::path(folder / "flight/mav0/cam0/data");
  for (const auto& entry : std::filesystem::directory_iterator(images)) {
    const std::string back = folder / ("back/mav0/cam0/data/" + entry.path().filename().string());
    const cv::Mat a = ReadImage(entry.path().string());
    const cv::Mat b = ReadImage(back);
    ASSERT_EQ(a.type(), b.type());
    EXPECT_EQ(cv::norm(a, b, cv::NORM_INF), 0);
  }
}

INSTANTIATE_TEST_SUITE_P(Bags, ThereAndBack,
                         ::testing::Values("flight.bag", "flight.mcap", "flight.db3"),
                         [](const auto& name) { return std::string(name.param).substr(7); });

TEST(NewRecording, ReplacesNothingWithoutRequest) {
  const TestFolder folder;
  for (const char* name : {"flight.bag", "flight.mcap", "flight.db3"}) {
    const std::string path = folder.Write(name, "precious");
    EXPECT_THAT(InputErrorOf([&] { NewRecording(path, {}, Compression::kNone, false); }),
                HasSubstr("is there already; --force replaces it"));
    // A recording that is not closed leaves the old file unchanged, and no other file.
    NewRecording(path, {}, Compression::kNone, /*replace=*/true);
    EXPECT_EQ(ReadFile(path), "precious");
    EXPECT_FALSE(std::filesystem::exists(path + ".part"));
  }
}

TEST(NewRecording, ReplacesFolderAsWhole) {
  const TestFolder folder;
  WriteEurocFlight(folder);
  const std::string old_image = folder.Write("old/mav0/cam0/data/1.png", "old");
  const std::string old_truth = folder.Write("old/mav0/landing_pattern0/data.csv", "old");
  const std::string old = folder / "old";
  EXPECT_THAT(InputErrorOf([&] { NewRecording(old, {}, Compression::kNone, false); }),
              HasSubstr("exists already; --force replaces it"));
  NewRecording(old, {}, Compression::kNone, /*replace=*/true);  // not closed
  EXPECT_EQ(ReadFile(old_truth), "old");
  EXPECT_FALSE(std::filesystem::exists(old + ".part"));
  const auto recording = NewRecording(old, {}, Compression::kNone, /*replace=*/true);
  recording->AddFrame({"2.png", BagTime(2), NoiseImage(32, 24, CV_8UC1)});
  recording->Close();
  EXPECT_FALSE(std::filesystem::exists(old_image));
  EXPECT_FALSE(std::filesystem::exists(old_truth));
  EXPECT_TRUE(std::filesystem::exists(old + "/mav0/cam0/data.csv"));
  const std::string precious = folder.Write("other/precious.txt", "precious");
  EXPECT_THAT(InputErrorOf([&] { NewRecording(folder / "other", {}, Compression::kNone, true); }),
              HasSubstr("is no recording, and not empty"));
}

TEST(NewRecording, ReportsSupportedCompressions) {
  const TestFolder folder;
  for (const char* name : {"flight.bag", "flight.db3"}) {
    EXPECT_THAT(InputErrorOf([&] { NewRecording(folder / name, {}, Compression::kZstd, false); }),
                HasSubstr("cannot be written with compression zstd"));
  }
}

}  // namespace
}  // namespace kestrel
