// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <string_view>

#include <opencv2/core.hpp>

#include "kestrel/io/bags/bag_writer.h"
#include "kestrel/io/ros_messages/camera_info.h"
#include "kestrel/io/ros_messages/messages.h"
#include "kestrel/io/ros_messages/serialization.h"

namespace kestrel {

inline constexpr std::int64_t kBagStart_ns = 1'600'000'000'000'000'000;
inline constexpr std::int64_t kBagPeriod_ns = 40'000'000;

inline Time BagTime(int image) { return TimeFromNanoseconds(kBagStart_ns + image * kBagPeriod_ns); }

inline CameraIntrinsics BagCamera() {
  return {.width_px = 32,
          .height_px = 24,
          .fx_px = 20,
          .fy_px = 20,
          .cx_px = 15.5,
          .cy_px = 11.5,
          .distortion_model = DistortionModel::kEquidistant,
          .distortion = {0.01, 0, 0, 0}};
}

// All pixels have the image's number.
inline cv::Mat BagImage(int image) { return cv::Mat(24, 32, CV_8UC1, cv::Scalar(image)); }

inline ImageMessage BagImageMessage(const cv::Mat& image, Time stamp,
                                    const std::string& encoding = "mono8") {
  ImageMessage message;
  message.header = {0, stamp, "camera"};
  message.width = static_cast<std::uint32_t>(image.cols);
  message.height = static_cast<std::uint32_t>(image.rows);
  message.step = static_cast<std::uint32_t>(image.step[0]);
  message.encoding = encoding;
  message.data = {reinterpret_cast<const char*>(image.data), image.total() * image.elemSize()};
  return message;
}

// 'bytes': the bytes of an image file, which must outlive the message.
inline CompressedImageMessage BagCompressedMessage(std::string_view bytes, Time stamp,
                                                   const std::string& format) {
  CompressedImageMessage message;
  message.header.stamp = stamp;
  message.header.frame_id = "camera";
  message.format = format;
  message.data = bytes;
  return message;
}

inline TransformStampedMessage BagTransform(const std::string& parent, const std::string& child,
                                            Time stamp, double x) {
  return {{0, stamp, parent}, child, {{x, 0, 0}, {}}};
}

// Writes messages of any type into the bag 'path', and closes it.
class TestBag {
 public:
  explicit TestBag(const std::string& path, Compression compression = Compression::kNone)
      : bag_(NewBag(path, compression, /*replace=*/true)) {}

  template <class Message>
  void Add(const std::string& topic, const Message& message, Time arrival) {
    const auto [known, is_new] = topics_.try_emplace(topic, 0);
    if (is_new) known->second = bag_->AddTopic(topic, Message::kType);
    bag_->Write(known->second, arrival, SerializeMessage(message, bag_->format()));
  }
  template <class Message>
  void Add(const std::string& topic, const Message& message) {
    Add(topic, message, message.header.stamp);
  }
  void AddImage(int image, const std::string& topic = "/camera/image_raw") {
    const cv::Mat pixels = BagImage(image);
    Add(topic, BagImageMessage(pixels, BagTime(image)));
  }
  void AddCameraInfo(const std::string& topic = "/camera/camera_info") {
    CameraInfoMessage info = CameraInfoOf(BagCamera());
    info.header = {0, BagTime(0), "camera"};
    Add(topic, info);
  }
  void AddPose(int image, const std::string& topic = "/pose") {
    Add(topic, PoseStampedMessage{{0, BagTime(image), "map"}, {{1.0 * image, 2, 3}, {}}});
  }
  void Close() { bag_->Close(); }

 private:
  std::unique_ptr<BagWriter> bag_;
  std::map<std::string, std::size_t> topics_;
};

// Writes a flight of 'images' images with everything that a bag should have.
inline void WriteTestFlight(const std::string& path, int images,
                            Compression compression = Compression::kNone) {
  TestBag bag(path, compression);
  bag.Add("/tf_static", TfMessage{{BagTransform("base_link", "camera", BagTime(0), 0.25)}},
          BagTime(0));
  bag.AddCameraInfo();
  for (int i = 0; i < images; ++i) {
    bag.AddPose(i);
    bag.AddImage(i);
  }
  bag.Close();
}

}  // namespace kestrel
