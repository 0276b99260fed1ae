// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/io/bags/bag_source.h"

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <fstream>
#include <string>
#include <unistd.h>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kestrel/core/base/read_file.h"
#include "kestrel/core/codec/png_codec.h"
#include "kestrel/io/bags/test_bags.h"
#include "kestrel/io/recording/test_files.h"

namespace kestrel {
namespace {

using ::testing::AnyOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

// Returns the frames' times, in numbers of images. Checks that their pixels are those of the image.
std::vector<int> ImagesOf(FrameSource* source) {
  std::vector<int> images;
  for (Frame frame; source->Next(&frame);) {
    const auto image = static_cast<int>((ToNanoseconds(frame.time) - kBagStart_ns) / kBagPeriod_ns);
    EXPECT_EQ(cv::norm(frame.image, BagImage(image), cv::NORM_INF), 0) << frame.name;
    images.push_back(image);
  }
  return images;
}

struct BagKind {
  const char* file;
  Compression compression;
};

class EveryBag : public ::testing::TestWithParam<BagKind> {};

TEST_P(EveryBag, HasImagesCalibrationMountAndPoses) {
  const TestFolder folder;
  const std::string path = folder / GetParam().file;
  constexpr int kImages = 2500;  // several chunks
  WriteTestFlight(path, kImages, GetParam().compression);
  std::vector<std::string> reported;
  BagSource source(path, {.notify = [&](const std::string& text) { reported.push_back(text); }});

  const auto calibration = source.calibration();
  ASSERT_TRUE(calibration);
  EXPECT_EQ(calibration->intrinsics.fx_px, 20);
  EXPECT_EQ(calibration->intrinsics.distortion_model, DistortionModel::kEquidistant);
  ASSERT_TRUE(calibration->body_from_camera);
  EXPECT_EQ(calibration->body_from_camera->translation, Eigen::Vector3d(0.25, 0, 0));
  EXPECT_DOUBLE_EQ(source.rate_hz(), 25);

  const std::vector<PoseSample> poses = source.poses();
  ASSERT_EQ(poses.size(), static_cast<std::size_t>(kImages));
  EXPECT_EQ(poses[7].time, BagTime(7));
  EXPECT_EQ(poses[7].world_from_body.translation, Eigen::Vector3d(7, 2, 3));

  Frame first;
  ASSERT_TRUE(source.Next(&first));
  EXPECT_EQ(first.name, "camera/image_raw/1600000000000000000");
  EXPECT_EQ(ImagesOf(&source).size(), kImages - 1u);
  EXPECT_THAT(reported, IsEmpty());
}

TEST_P(EveryBag, IsReadUpToCutOrRefusedWhenTruncated) {
  const TestFolder folder;
  const std::string whole = folder / GetParam().file;
  WriteTestFlight(whole, 300, GetParam().compression);
  const auto size = std::filesystem::file_size(whole);
  const std::string cut = folder / (std::string("cut") + GetParam().file);
  for (int part = 0; part < 40; ++part) {
    std::filesystem::copy_file(whole, cut, std::filesystem::copy_options::overwrite_existing);
    std::filesystem::resize_file(cut, size * part / 40);
    std::vector<std::string> reported;
    std::vector<int> images;
    const std::string error = InputErrorOf([&] {
      BagSource source(cut, {.notify = [&](const std::string& text) { reported.push_back(text); }});
      images = ImagesOf(&source);
    });
    if (error.empty()) {
      EXPECT_THAT(reported, ElementsAre(HasSubstr("was not closed"))) << part;
      for (std::size_t i = 0; i < images.size(); ++i) EXPECT_EQ(images[i], static_cast<int>(i));
    } else {
      EXPECT_THAT(error, HasSubstr(cut)) << part;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Kinds, EveryBag,
                         ::testing::Values(BagKind{"none.bag", Compression::kNone},
                                           BagKind{"bz2.bag", Compression::kBz2},
                                           BagKind{"lz4.bag", Compression::kLz4},
                                           BagKind{"none.mcap", Compression::kNone},
                                           BagKind{"lz4.mcap", Compression::kLz4},
                                           BagKind{"zstd.mcap", Compression::kZstd},
                                           BagKind{"flight.db3", Compression::kNone}),
                         [](const auto& kind) {
                           std::string name = kind.param.file;
                           name[name.find('.')] = '_';
                           return name;
                         });

TEST(BagSource, KeepsColorsAlongWithGray) {
  const TestFolder folder;
  WriteTestFlight(folder / "flight.mcap", 3);
  BagSource source(folder / "flight.mcap", {});
  source.set_keeps_color(true);
  Frame frame;
  ASSERT_TRUE(source.Next(&frame));
  EXPECT_EQ(frame.image.type(), CV_8UC1);
  EXPECT_EQ(frame.color.type(), CV_8UC3);
}

// A cut removes only images that are not complete.
TEST(BagSource, ReadsAllCompleteImagesOfTruncatedBag) {
  const TestFolder folder;
  for (const char* name : {"flight.bag", "flight.mcap"}) {
    const std::string path = folder / name;
    WriteTestFlight(path, 300);
    TestFolder::CutOff(path, 0.5);
    BagSource source(path, {});
    EXPECT_GT(ImagesOf(&source).size(), 120u) << name;
  }
}

TEST(BagSource, RefusesTruncatedSqliteBag) {
  const TestFolder folder;
  const std::string path = folder / "flight.db3";
  WriteTestFlight(path, 24);
  while (std::filesystem::file_size(path) > 5000) {
    std::filesystem::resize_file(path, std::filesystem::file_size(path) - 1009);
    EXPECT_THAT(InputErrorOf([&] { BagSource(path, {}); }),
                AllOf(HasSubstr(path + ": was cut off"), HasSubstr("docs/bags.md")));
  }
}

TEST(BagSource, ReadsBagWithZeroFilledEnd) {
  const TestFolder folder;
  const std::string path = folder / "flight.bag";
  WriteTestFlight(path, 300);
  const auto size = std::filesystem::file_size(path);
  TestFolder::CutOff(path, 0.5);
  std::filesystem::resize_file(path, size);
  BagSource source(path, {});
  EXPECT_GT(ImagesOf(&source).size(), 120u);
}

// The bags have several chunks, all with poses and images.
TEST(BagSource, SkipsDamagedChunks) {
  const TestFolder folder;
  constexpr int kImages = 600;
  const BagKind kinds[] = {{"bz2.bag", Compression::kBz2},
                           {"lz4.mcap", Compression::kLz4},
                           {"none.mcap", Compression::kNone},
                           {"zstd.mcap", Compression::kZstd}};
  for (const auto& [name, compression] : kinds) {
    const std::string path = folder / name;
    TestBag bag(path, compression);
    for (int i = 0; i < kImages; ++i) {
      const cv::Mat pixels = NoiseImage(64, 64, CV_8UC1, i + 1);
      bag.AddPose(i);
      bag.Add("/camera/image_raw", BagImageMessage(pixels, BagTime(i)));
    }
    bag.Close();
    std::string bytes = ReadFile(path);
    bytes.replace(bytes.size() / 3, 100, 100, '\x5a');
    folder.Write(name, bytes);
    std::vector<std::string> reported;
    BagSource source(path, {.notify = [&](const std::string& text) { reported.push_back(text); }});
    int images = 0;
    Time last;
    for (Frame frame; source.Next(&frame); ++images) last = frame.time;
    EXPECT_LT(images, kImages) << name;
    EXPECT_GT(images, kImages / 3) << name;
    EXPECT_EQ(last, BagTime(kImages - 1)) << name;
    EXPECT_THAT(reported, ElementsAre(HasSubstr("; left out: 1 of "))) << name;
  }
}

TEST(BagSource, SortsImagesByStamp) {
  const TestFolder folder;
  const std::string path = folder / "flight.mcap";
  TestBag bag(path);
  for (const int image : {1, 0, 3, 2, 5, 4, 6, 6, 7}) bag.AddImage(image);
  bag.Close();
  std::vector<std::string> reported;
  BagSource source(path, {.notify = [&](const std::string& text) { reported.push_back(text); }});
  EXPECT_THAT(ImagesOf(&source), ElementsAre(0, 1, 2, 3, 4, 5, 6, 7));
  EXPECT_THAT(reported, ElementsAre(HasSubstr("1 images with the stamp of another")));
}

TEST(BagSource, UsesArrivalTimesOnRequestOnly) {
  const TestFolder folder;
  const std::string path = folder / "flight.bag";
  TestBag bag(path);
  for (int i = 0; i < 3; ++i) {
    const cv::Mat image = BagImage(i);
    bag.Add("/camera/image_raw", BagImageMessage(image, Time()), BagTime(i));
  }
  bag.Close();
  EXPECT_THAT(InputErrorOf([&] { BagSource(path, {}); }), HasSubstr("--arrival-times"));
  BagSource source(path, {.use_arrival_times = true});
  EXPECT_THAT(ImagesOf(&source), ElementsAre(0, 1, 2));
}

TEST(BagSource, RequiresChoiceOfSeveralCameras) {
  const TestFolder folder;
  const std::string path = folder / "flight.bag";
  TestBag bag(path);
  bag.AddImage(1, "/left/image_raw");
  bag.AddImage(2, "/right/image_raw");
  bag.AddCameraInfo("/right/camera_info");
  bag.AddCameraInfo("/left/camera_info");
  bag.Close();
  EXPECT_EQ(InputErrorOf([&] { BagSource(path, {}); }),
            path +
                ": has 2 cameras, choose one by --topic: /left/image_raw (sensor_msgs/Image), "
                "/right/image_raw (sensor_msgs/Image)");
  EXPECT_THAT(InputErrorOf([&] { BagSource(path, {.topics = {"/up/image_raw"}}); }),
              HasSubstr("has no topic /up/image_raw"));
  BagSource source(path, {.topics = {"/right/image_raw"}});
  EXPECT_THAT(ImagesOf(&source), ElementsAre(2));
}

TEST(BagSource, PrefersRawImagesOverCompressedOnes) {
  const TestFolder folder;
  const std::string path = folder / "flight.mcap";
  const std::string png = EncodePng(BagImage(4));
  const CompressedImageMessage compressed = BagCompressedMessage(png, BagTime(4), "png");
  TestBag bag(path);
  bag.Add("/camera/image_raw/compressed", compressed);
  bag.AddImage(1);
  bag.Close();
  BagSource raw(path, {});
  EXPECT_THAT(ImagesOf(&raw), ElementsAre(1));
  BagSource chosen(path, {.topics = {"/camera/image_raw/compressed"}});
  EXPECT_THAT(ImagesOf(&chosen), ElementsAre(4));
}

TEST(BagSource, TakesPosesAndMountFromTf) {
  const TestFolder folder;
  const std::string path = folder / "flight.bag";
  TestBag bag(path);
  bag.Add("/tf_static",
          TfMessage{{BagTransform("base_link", "gimbal", BagTime(0), 1),
                     BagTransform("gimbal", "camera", BagTime(0), 0.5)}},
          BagTime(0));
  bag.Add("/tf", TfMessage{{BagTransform("map", "odom", BagTime(0), 100)}}, BagTime(0));
  for (int i = 0; i < 4; ++i) {
    bag.AddImage(i);
    bag.Add("/tf", TfMessage{{BagTransform("odom", "base_link", BagTime(i), i)}}, BagTime(i));
  }
  bag.Close();
  BagSource source(path, {});
  ASSERT_EQ(source.poses().size(), 4u);
  EXPECT_EQ(source.poses()[3].world_from_body.translation, Eigen::Vector3d(103, 0, 0));
  ASSERT_TRUE(source.mount().body_from_camera);
  EXPECT_EQ(source.mount().body_from_camera->translation, Eigen::Vector3d(1.5, 0, 0));
  EXPECT_FALSE(source.calibration());
}

TEST(BagSource, SkipsInvalidPoses) {
  const TestFolder folder;
  const std::string path = folder / "flight.bag";
  TestBag bag(path);
  bag.AddImage(0);
  bag.AddPose(0);
  bag.Add("/pose", PoseStampedMessage{{0, BagTime(1), "map"}, {{}, {0, 0, 0, 0}}});
  bag.Add("/pose", PoseStampedMessage{{0, BagTime(2), "map"}, {{std::nan(""), 0, 0}, {}}});
  bag.AddPose(3);
  bag.Close();
  std::vector<std::string> reported;
  BagSource source(path, {.notify = [&](const std::string& text) { reported.push_back(text); }});
  EXPECT_EQ(source.poses().size(), 2u);
  EXPECT_THAT(reported, ElementsAre(HasSubstr("/pose: poses left out: 2")));
}

TEST(BagSource, ReportsFaultyBags) {
  const TestFolder folder;
  const auto error_of = [&](const std::string& path) {
    return InputErrorOf([&] { BagSource(path, {}); });
  };
  EXPECT_THAT(error_of(folder.Write("empty.bag", "")), HasSubstr("is no ROS 1 bag"));
  EXPECT_THAT(error_of(folder.Write("old.bag", "#ROSBAG V1.2\n")), HasSubstr("version 2.0"));
  EXPECT_THAT(error_of(folder.Write("text.mcap", "hello")), HasSubstr("is no MCAP file"));
  EXPECT_THAT(error_of(folder.Write("text.db3", "hello, this is no database")),
              HasSubstr("cannot be read as a bag of rosbag2"));
  TestBag bag(folder / "poses.mcap");
  bag.AddPose(0);
  bag.Close();
  EXPECT_EQ(error_of(folder / "poses.mcap"),
            folder / "poses.mcap" +
                ": has no images, expected a topic of sensor_msgs Image or CompressedImage among "
                "/pose (geometry_msgs/PoseStamped)");
}

TEST(BagSource, ReadsFolderOfSplitBag) {
  const TestFolder folder;
  std::filesystem::create_directories(folder / "flight");
  for (int part = 0; part < 2; ++part) {
    TestBag bag(folder / ("flight/flight_" + std::to_string(part) + ".mcap"));
    for (int i = 0; i < 3; ++i) bag.AddImage(3 * part + i);
    bag.Close();
  }
  BagSource source(folder / "flight", {});
  EXPECT_EQ(source.frame_count(), 6u);
  EXPECT_THAT(ImagesOf(&source), ElementsAre(0, 1, 2, 3, 4, 5));

  folder.Write("flight/metadata.yaml",
               "rosbag2_bagfile_information:\n  version: 5\n"
               "  relative_file_paths:\n    - flight_1.mcap\n");
  BagSource listed(folder / "flight", {});
  EXPECT_THAT(ImagesOf(&listed), ElementsAre(3, 4, 5));
  folder.Write("flight/metadata.yaml",
               "rosbag2_bagfile_information:\n  relative_file_paths: [lost.mcap]\n");
  EXPECT_THAT(InputErrorOf([&] { BagSource(folder / "flight", {}); }),
              HasSubstr("lost.mcap is not there"));
}

// Returns the resident memory of this process in bytes.
std::size_t ResidentBytes() {
  std::ifstream statm("/proc/self/statm");
  std::size_t pages = 0;
  statm >> pages >> pages;
  return pages * static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
}

TEST(BagSource, UsesMemoryOfFewImagesForLargeBag) {
#if defined(__has_feature)
#if __has_feature(address_sanitizer)
  GTEST_SKIP() << "the sanitizer keeps what was freed";
#endif
#endif
  const TestFolder folder;
  constexpr std::size_t kImageSize = 1 << 20;
  for (const char* name : {"flight.bag", "flight.mcap", "flight.db3"}) {
    const std::string path = folder / name;
    TestBag bag(path);
    const cv::Mat image = NoiseImage(1 << 10, 1 << 10, CV_8UC1);
    for (int i = 0; i < 100; ++i) bag.Add("/camera/image_raw", BagImageMessage(image, BagTime(i)));
    bag.Close();
    const std::size_t before = ResidentBytes();
    std::size_t most = before;
    BagSource source(path, {});
    for (Frame frame; source.Next(&frame);) most = std::max(most, ResidentBytes());
    EXPECT_LT(most - before, 30 * kImageSize) << name;
    std::filesystem::remove(path);
  }
}

TEST(OpenSourceOrBag, DistinguishesSourcesFromBags) {
  const TestFolder folder;
  WriteTestFlight(folder / "flight.bag", 2);
  const std::string image = WriteTestImage(folder, "a.png", BagImage(1));
  EXPECT_EQ(OpenSourceOrBag({folder / "flight.bag"}, PixelFormat::kGray, {})->frame_count(), 2u);
  EXPECT_EQ(OpenSourceOrBag({image}, PixelFormat::kGray, {})->frame_count(), 1u);
  EXPECT_THAT(
      InputErrorOf([&] { OpenSourceOrBag({image}, PixelFormat::kGray, {.topics = {"/camera"}}); }),
      HasSubstr("for bags"));
  EXPECT_THAT(InputErrorOf([&] {
                OpenSourceOrBag({image, folder / "flight.bag"}, PixelFormat::kGray, {});
              }),
              HasSubstr("expected no other source beside it"));
}

// An image without pixels, one with too few bytes, one in an unknown encoding, and one without a
// stamp.
TEST(BagSource, SkipsUnreadableImages) {
  const TestFolder folder;
  for (const char* name : {"flight.bag", "flight.mcap", "flight.db3"}) {
    const std::string path = folder / name;
    TestBag bag(path);
    const cv::Mat pixels = BagImage(0);
    ImageMessage none = BagImageMessage(pixels, BagTime(0));
    none.width = none.height = none.step = 0;
    bag.Add("/camera/image_raw", none);
    bag.AddImage(1);
    ImageMessage brief = BagImageMessage(pixels, BagTime(2));
    brief.data = brief.data.substr(0, 100);
    bag.Add("/camera/image_raw", brief);
    bag.Add("/camera/image_raw", BagImageMessage(pixels, BagTime(3), "yuv999"));
    bag.Add("/camera/image_raw", BagImageMessage(pixels, Time()), BagTime(3));
    bag.AddImage(4);
    bag.Close();
    BagSource source(path, {});
    std::vector<std::string> broken;
    source.set_on_broken([&](const BrokenImage& image) { broken.emplace_back(image.what()); });
    EXPECT_THAT(ImagesOf(&source), ElementsAre(1, 4)) << name;
    EXPECT_THAT(broken, ElementsAre(HasSubstr("0x0 pixels"), HasSubstr("100 bytes"),
                                    HasSubstr("yuv999"), HasSubstr("no stamp")))
        << name;
  }
}

TEST(BagSource, SkipsTruncatedFiles) {
  const TestFolder folder;
  const std::string path = folder / "flight.bag";
  const std::string whole = EncodePng(BagImage(1)), cut = whole.substr(0, whole.size() / 2);
  TestBag bag(path);
  bag.Add("/camera/image/compressed", BagCompressedMessage(cut, BagTime(0), "png"));
  bag.Add("/camera/image/compressed", BagCompressedMessage(whole, BagTime(1), "png"));
  bag.Add("/camera/image/compressed", BagCompressedMessage("", BagTime(2), "png"));
  bag.Close();
  BagSource source(path, {});
  EXPECT_THAT(ImagesOf(&source), ElementsAre(1));
  EXPECT_EQ(source.left_out(), 2u);
}

TEST(BagSource, ReportsEmptyClosedBag) {
  const TestFolder folder;
  for (const char* name : {"empty.bag", "empty.mcap", "empty.db3"}) {
    const std::string path = folder / name;
    TestBag(path).Close();
    std::vector<std::string> reported;
    const std::string error = InputErrorOf([&] {
      BagSource(path, {.notify = [&](const std::string& text) { reported.push_back(text); }});
    });
    EXPECT_THAT(error, HasSubstr(path + ": has no images")) << name;
    EXPECT_THAT(reported, IsEmpty()) << name;
  }
}

}  // namespace
}  // namespace kestrel
