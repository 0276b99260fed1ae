// SPDX-License-Identifier: BSD-3-Clause
// Errors in a bag are reported in one line that begins with the bag's name.
#include <algorithm>
#include <limits>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kestrel/core/base/bytes.h"
#include "kestrel/core/base/read_file.h"
#include "kestrel/io/bags/bag_source.h"
#include "kestrel/io/bags/ros1_bag.h"
#include "kestrel/io/bags/test_bags.h"
#include "kestrel/io/recording/test_files.h"

namespace kestrel {
namespace {

using namespace std::string_literals;
using ::testing::HasSubstr;
using ::testing::StartsWith;

std::string Flight(const TestFolder& folder, const std::string& name,
                   Compression compression = Compression::kNone) {
  WriteTestFlight(folder / name, 20, compression);
  return folder / name;
}

// Returns the file with 'to' instead of each 'from'; both have the same length.
std::string Patched(const std::string& path, const std::string& from, const std::string& to) {
  std::string bytes = ReadFile(path);
  EXPECT_NE(bytes.find(from), std::string::npos) << path;
  for (std::size_t at = 0; (at = bytes.find(from, at)) != std::string::npos; at += to.size()) {
    bytes.replace(at, from.size(), to);
  }
  std::ofstream(path, std::ios::binary) << bytes;
  return path;
}

// Returns the file without 300 of its bytes, from 'offset' on.
std::string Damaged(const std::string& path, std::size_t offset) {
  constexpr std::size_t kLost = 300;
  std::string bytes = ReadFile(path);
  bytes.replace(offset, kLost, kLost, '\xff');
  std::ofstream(path, std::ios::binary) << bytes;
  return path;
}

// A bag with one message.
template <class Message>
std::string Single(const TestFolder& folder, const Message& message, Time arrival = BagTime(0),
                   const std::string& name = "flight.bag") {
  TestBag bag(folder / name);
  bag.Add("/camera/image_raw", message, arrival);
  bag.Close();
  return folder / name;
}

// Returns a bag with an image that 'change' has made wrong.
template <class Change>
std::string WrongImage(const TestFolder& folder, const Change& change) {
  const cv::Mat pixels = BagImage(1);
  ImageMessage message = BagImageMessage(pixels, BagTime(0));
  change(&message);
  return Single(folder, message);
}

// Returns a bag with images and a camera_info that 'change' has made wrong.
template <class Change>
std::string WrongCamera(const TestFolder& folder, const Change& change) {
  TestBag bag(folder / "flight.mcap");
  CameraInfoMessage info = CameraInfoOf(BagCamera());
  info.header.stamp = BagTime(0);
  change(&info);
  bag.Add("/camera/camera_info", info);
  bag.AddImage(0);
  bag.Close();
  return folder / "flight.mcap";
}

// Returns a bag whose header declares it encrypted, as `rosbag encrypt` does.
std::string EncryptedBag(const TestFolder& folder) {
  std::string header;
  PutText("op=\3", &header);
  PutText("encryptor=rosbag/AesCbcEncryptor", &header);
  std::string bytes(kRos1BagMagic);
  PutText(header, &bytes);
  PutText("", &bytes);
  return folder.Write("flight.bag", bytes);
}

// A folder of rosbag2 with this metadata.yaml.
std::string WithMetadata(const TestFolder& folder, const std::string& text) {
  folder.Write("flight/metadata.yaml", text);
  Flight(folder, "flight/flight_0.mcap");
  return folder / "flight";
}

struct BrokenBag {
  const char* what;
  std::string (*make)(const TestFolder&);
  const char* words;
};

const BrokenBag kBrokenBags[] = {
    {"an empty .bag", [](const TestFolder& f) { return f.Write("flight.bag", ""); },
     "is no ROS 1 bag of version 2.0"},
    {"an empty .mcap", [](const TestFolder& f) { return f.Write("flight.mcap", ""); },
     "is no MCAP file"},
    {"an empty .db3", [](const TestFolder& f) { return f.Write("flight.db3", ""); },
     "no such table: topics"},
    {"garbage as .bag",
     [](const TestFolder& f) { return f.Write("flight.bag", std::string(9999, '\x5a')); },
     "is no ROS 1 bag of version 2.0"},
    {"garbage as .mcap",
     [](const TestFolder& f) { return f.Write("flight.mcap", std::string(9999, '\x5a')); },
     "is no MCAP file"},
    {"garbage as .db3",
     [](const TestFolder& f) { return f.Write("flight.db3", std::string(9999, '\x5a')); },
     "file is not a database"},
    {"an old ROS bag", [](const TestFolder& f) { return f.Write("flight.bag", "#ROSBAG V1.2\n"); },
     "version 2.0"},
    {"a .bag cut in its first record",
     [](const TestFolder& f) {
       return f.Write("flight.bag", ReadFile(Flight(f, "whole.bag")).substr(0, 100));
     },
     "is cut off within its first record"},
    {"a .bag cut before its first chunk",
     [](const TestFolder& f) {
       return f.Write("flight.bag", ReadFile(Flight(f, "whole.bag")).substr(0, 4117));
     },
     "has no images"},
    {"an .mcap cut before its first chunk",
     [](const TestFolder& f) {
       return f.Write("flight.mcap", ReadFile(Flight(f, "whole.mcap")).substr(0, 40));
     },
     "has no images"},
    {"a .db3 cut in its header",
     [](const TestFolder& f) {
       return f.Write("flight.db3", ReadFile(Flight(f, "whole.db3")).substr(0, 30));
     },
     "cannot be read as a bag of rosbag2"},
    {"a .db3 cut in its first page",
     [](const TestFolder& f) {
       return f.Write("flight.db3", ReadFile(Flight(f, "whole.db3")).substr(0, 1000));
     },
     "was cut off, has 1000 of "},
    {"a .db3 that lacks its last byte",
     [](const TestFolder& f) {
       const std::string whole = ReadFile(Flight(f, "whole.db3"));
       return f.Write("flight.db3", whole.substr(0, whole.size() - 1));
     },
     "or save its whole pages"},
    {"a .bag whose first record is too long",
     [](const TestFolder& f) {
       return f.Write("flight.bag", "#ROSBAG V2.0\n\xff\xff\xff\x7f" + std::string(99, 'a'));
     },
     "a record's header claims 2147483647 bytes, expected at most 1048576"},
    {"a .bag without a bag header",
     [](const TestFolder& f) { return Patched(Flight(f, "flight.bag"), "op=\3", "op=\x9"); },
     "is no bag header"},
    {"an encrypted .bag", EncryptedBag, "is encrypted"},
    {"an unknown compression in a .bag",
     [](const TestFolder& f) {
       return Patched(Flight(f, "flight.bag"), "compression=none", "compression=zpaq");
     },
     "has an unknown compression, expected none, bz2, lz4 or zstd"},
    {"an unknown compression in an .mcap",
     [](const TestFolder& f) {
       return Patched(Flight(f, "flight.mcap", Compression::kZstd), "\4\0\0\0zstd"s,
                      "\4\0\0\0zpaq"s);
     },
     "has an unknown compression"},
    {"damaged bz2",
     [](const TestFolder& f) { return Damaged(Flight(f, "flight.bag", Compression::kBz2), 4500); },
     "its compressed bytes are broken"},
    {"damaged lz4",
     [](const TestFolder& f) { return Damaged(Flight(f, "flight.bag", Compression::kLz4), 4500); },
     "its compressed bytes are broken"},
    {"damaged zstd",
     [](const TestFolder& f) { return Damaged(Flight(f, "flight.mcap", Compression::kZstd), 400); },
     "its compressed bytes are broken"},
    {"wrong checksums",
     [](const TestFolder& f) { return Patched(Flight(f, "flight.mcap"), "mono8", "m0no8"); },
     "a chunk is damaged: its checksum is wrong"},
    {"a damaged .db3", [](const TestFolder& f) { return Damaged(Flight(f, "flight.db3"), 16384); },
     "malformed"},
    {"messages of connections that nothing describes",
     [](const TestFolder& f) { return Patched(Flight(f, "flight.bag"), "op=\x7", "op=\x9"); },
     "has no images"},
    {"no topic with images",
     [](const TestFolder& f) {
       return Single(f, PoseStampedMessage{{0, BagTime(0), "map"}, {{}, {}}});
     },
     "has no images, expected a topic of sensor_msgs Image or CompressedImage among "
     "/camera/image_raw (geometry_msgs/PoseStamped)"},
    {"messages that are not of ROS",
     [](const TestFolder& f) {
       return Patched(Flight(f, "flight.mcap"), "\3\0\0\0cdr"s, "\3\0\0\0xml"s);
     },
     "has no images"},
    {"a topic of images without any",
     [](const TestFolder& f) {
       const auto bag = NewBag(f / "flight.mcap", Compression::kNone, /*replace=*/false);
       bag->AddTopic("/camera/image_raw", ImageMessage::kType);
       bag->Close();
       return f / "flight.mcap";
     },
     "/camera/image_raw: has no images, expected some"},
    {"two cameras",
     [](const TestFolder& f) {
       TestBag bag(f / "flight.mcap");
       bag.AddImage(0, "/left/image_raw");
       bag.AddImage(1, "/right/image_raw");
       bag.Close();
       return f / "flight.mcap";
     },
     "has 2 cameras, choose one by --topic: /left/image_raw"},
    {"two topics with poses",
     [](const TestFolder& f) {
       TestBag bag(f / "flight.mcap");
       bag.AddImage(0);
       bag.AddPose(0, "/gps/pose");
       bag.AddPose(0, "/vision/pose");
       bag.Close();
       return f / "flight.mcap";
     },
     "has 2 topics with poses, choose one by --topic: /gps/pose"},
    {"another type than the topic says",
     [](const TestFolder& f) {
       const auto bag = NewBag(f / "flight.bag", Compression::kNone, /*replace=*/false);
       const PoseStampedMessage pose{{0, BagTime(0), "map"}, {{}, {}}};
       bag->Write(bag->AddTopic("/camera/image_raw", ImageMessage::kType), BagTime(0),
                  SerializeMessage(pose, bag->format()));
       bag->Close();
       return f / "flight.bag";
     },
     "has the encoding ''"},
    {"images without stamps",
     [](const TestFolder& f) {
       return WrongImage(f, [](ImageMessage* image) { image->header.stamp = Time(); });
     },
     "/camera/image_raw: an image has no stamp (zero)"},
    {"poses without stamps",
     [](const TestFolder& f) {
       TestBag bag(f / "flight.mcap");
       bag.AddImage(0);
       bag.Add("/pose", PoseStampedMessage{{0, Time(), "map"}, {{}, {}}}, BagTime(0));
       bag.Close();
       return f / "flight.mcap";
     },
     "/pose: the poses have no stamps (zero)"},
    {"an encoding of 16 bits",
     [](const TestFolder& f) {
       return WrongImage(f, [](ImageMessage* image) { image->encoding = "mono16"; });
     },
     "has the encoding 'mono16', expected 8 bits a channel"},
    {"an encoding over two lines",
     [](const TestFolder& f) {
       return WrongImage(f, [](ImageMessage* image) { image->encoding = "mono8\nbgr8"; });
     },
     "has the encoding 'mono8?bgr8'"},
    {"too few pixels",
     [](const TestFolder& f) {
       return WrongImage(f, [](ImageMessage* image) { image->height = 25; });
     },
     "too few for 32x25 pixels of mono8"},
    {"an image without pixels",
     [](const TestFolder& f) {
       return WrongImage(f, [](ImageMessage* image) { image->width = 0; });
     },
     "has 0x24 pixels, expected 1 to 32768 each way"},
    {"a compressed image that is none",
     [](const TestFolder& f) {
       return Single(f, BagCompressedMessage("no image", BagTime(0), "jpeg"));
     },
     "cannot be decoded as an image"},
    {"a camera that is not calibrated",
     [](const TestFolder& f) {
       return WrongCamera(f, [](CameraInfoMessage* info) { info->k.fill(0); });
     },
     "/camera/camera_info"},
    {"a focal length that is no number",
     [](const TestFolder& f) {
       return WrongCamera(f, [](CameraInfoMessage* info) {
         info->k[0] = std::numeric_limits<double>::quiet_NaN();
       });
     },
     "/camera/camera_info"},
    {"a lens that nobody knows",
     [](const TestFolder& f) {
       return WrongCamera(f, [](CameraInfoMessage* info) { info->distortion_model = "kaleido\n"; });
     },
     "kaleido_"},
    {"too few coefficients",
     [](const TestFolder& f) {
       return WrongCamera(f, [](CameraInfoMessage* info) { info->d.resize(2); });
     },
     "/camera/camera_info"},
    {"binning",
     [](const TestFolder& f) {
       return WrongCamera(f, [](CameraInfoMessage* info) { info->binning_x = 2; });
     },
     "tells of binning or a region of interest"},
    {"metadata.yaml that is no YAML", [](const TestFolder& f) { return WithMetadata(f, "{\n"); },
     "metadata.yaml:"},
    {"metadata.yaml without a bag", [](const TestFolder& f) { return WithMetadata(f, "a: 1\n"); },
     "has no key 'rosbag2_bagfile_information'"},
    {"metadata.yaml without files",
     [](const TestFolder& f) {
       return WithMetadata(f, "rosbag2_bagfile_information:\n  version: 5\n");
     },
     "has no list 'relative_file_paths'"},
    {"metadata.yaml with a file that is lost",
     [](const TestFolder& f) {
       return WithMetadata(
           f, "rosbag2_bagfile_information:\n  relative_file_paths: [flight_1.mcap]\n");
     },
     "flight_1.mcap is not there"},
    {"metadata.yaml with a name that is too long",
     [](const TestFolder& f) {
       return WithMetadata(f, "rosbag2_bagfile_information:\n  relative_file_paths: [" +
                                  std::string(5000, 'a') + "]\n");
     },
     "is not there"},
    {"files compressed as a whole",
     [](const TestFolder& f) {
       return WithMetadata(f,
                           "rosbag2_bagfile_information:\n  compression_format: zstd\n"
                           "  compression_mode: FILE\n"
                           "  relative_file_paths: [flight_0.mcap.zstd]\n");
     },
     "compressed as a whole"},
    {"a file compressed as a whole",
     [](const TestFolder& f) { return f.Write("flight_0.mcap.zstd", "\x28\xb5\x2f\xfd"); },
     "is compressed as a whole, expected it decompressed (zstd -d -o flight_0.mcap "},
    {"a folder of files compressed as a whole",
     [](const TestFolder& f) {
       f.Write("flight/flight_0.db3.zstd", "\x28\xb5\x2f\xfd");
       return f / "flight";
     },
     "flight_0.db3.zstd: is compressed as a whole"},
    {"messages compressed by what nobody knows",
     [](const TestFolder& f) {
       return WithMetadata(f,
                           "rosbag2_bagfile_information:\n  compression_format: \"a\\nb\"\n"
                           "  compression_mode: MESSAGE\n"
                           "  relative_file_paths: [flight_0.mcap]\n");
     },
     "'compression_format' is 'a?b', expected zstd"},
};

TEST(BrokenBags, AreReportedInOneLine) {
  for (const BrokenBag& broken : kBrokenBags) {
    const TestFolder folder;
    const std::string path = broken.make(folder);
    const std::string error = InputErrorOf([&] {
      BagSource source(path, {});
      source.calibration();
      for (Frame frame; source.Next(&frame);) continue;
    });
    EXPECT_THAT(error, StartsWith(path)) << broken.what;
    EXPECT_THAT(error, HasSubstr(broken.words)) << broken.what;
    EXPECT_EQ(std::count(error.begin(), error.end(), '\n'), 0) << broken.what;
  }
}

}  // namespace
}  // namespace kestrel
