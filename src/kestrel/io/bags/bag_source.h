// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "kestrel/io/bags/bag_choice.h"
#include "kestrel/io/bags/bag_poses.h"
#include "kestrel/io/bags/bag_reader.h"
#include "kestrel/io/recording/frame_source.h"
#include "kestrel/io/ros_messages/messages.h"
#include "kestrel/io/ros_messages/topic_choice.h"

namespace kestrel {

// The images of a bag, with the calibration of their camera (from camera_info, the mount from tf)
// and the poses. A frame's name is its topic with its time below it:
// "camera/image_raw/1403636579763555584".
class BagSource : public FrameSource {
 public:
  // Throws InputError with the fault of the bag: broken, no images, several cameras, no
  // stamps.
  BagSource(const std::string& path, BagChoice choice);

  // Frames are sorted where up to 8 images are out of order. Images that are later than that, or
  // have the stamp of another, are left out; this and what was damaged is reported at the end.
  std::optional<std::size_t> frame_count() const override;
  double rate_hz() const override { return rate_hz_; }
  // Throws InputError when camera_info does not hold a valid calibration.
  std::optional<CameraCalibration> calibration() const override;
  CameraMount mount() const override { return {body_from_camera_, std::nullopt}; }
  std::vector<PoseSample> poses() const override { return poses_; }

 private:
  std::string NameOf(std::size_t topic) const;
  void Notify(const std::string& text) const;
  void ReportMissing() const;
  void ReadCameraInfo();
  std::string ReadFirstImages();
  // An image of the bag; one that cannot be read has a fault in its place.
  struct ReadFrame {
    Frame frame;
    std::string fault;
  };

  bool ReadNext(Frame* frame) override;
  bool ReadMessage(ReadFrame* read);
  Time TimeOf(const HeaderMessage& header, const BagMessage& message) const;
  std::string FrameName(const BagMessage& message, Time time) const;
  template <class Message>
  void Decode(const BagMessage& message, Frame* frame) const;

  std::string path_;
  BagChoice choice_;
  std::unique_ptr<BagReader> bag_;
  TopicChoice topics_;
  std::optional<CameraInfoMessage> camera_info_;
  std::optional<RigidTransform> body_from_camera_;
  std::vector<PoseSample> poses_;
  double rate_hz_ = kNominalRateHz;

  std::vector<ReadFrame> waiting_;  // in order of time
  bool has_ended_ = false;
  Time newest_;  // newest time that has been read
  std::optional<Time> last_time_;
  std::size_t repeated_ = 0;  // or too late
};

// Opens a bag, or any source that OpenSource supports. Throws InputError as they do, and when
// 'choice' has topics for a source that is not a bag.
std::unique_ptr<FrameSource> OpenSourceOrBag(const std::vector<std::string>& arguments,
                                             PixelFormat format, const BagChoice& choice);

}  // namespace kestrel
