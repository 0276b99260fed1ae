// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "kestrel/io/bags/bag_poses.h"
#include "kestrel/io/bags/bag_reader.h"
#include "kestrel/io/bags/bag_topics.h"
#include "kestrel/io/bags/messages.h"
#include "kestrel/io/recording/frame_source.h"

namespace kestrel {

// How a bag is read.
struct BagChoice {
  std::vector<std::string> topics = {};  // where the types of the topics leave a choice
  bool use_arrival_times = false;        // instead of the stamps in the headers
  // What the user should know: what was cut off or left out, a line each. May be empty.
  std::function<void(const std::string&)> tell = {};
};

// The images of a bag with its camera's calibration (camera_info, and the mount from tf) and its
// poses. A frame's name is its topic with its time below it:
// "camera/image_raw/1403636579763555584".
class BagSource : public FrameSource {
 public:
  // Throws InputError with what is wrong with the bag: broken, no images, several cameras, no
  // stamps.
  BagSource(const std::string& path, BagChoice choice);

  // Frames are put in order where they are by up to 8 images out of it; what is later than that,
  // and what has the stamp of another, is left out, and that is told at the end,
  // as is what was damaged.
  bool Next(Frame* frame) override;
  std::optional<std::size_t> frame_count() const override;
  double rate_hz() const override { return rate_hz_; }
  // Throws InputError when camera_info is no calibration.
  std::optional<CameraCalibration> calibration() const override;
  CameraMount mount() const override { return {body_from_camera_, std::nullopt}; }
  std::vector<PoseSample> poses() const override { return poses_; }

 private:
  std::string NameOf(std::size_t topic) const;
  void Tell(const std::string& text) const;
  void TellWhatIsMissing() const;
  void ReadCameraInfo();
  std::string ReadFirstImages();
  bool ReadFrame(Frame* frame);
  Time TimeOf(const HeaderMessage& header, const BagMessage& message) const;
  template <class Message>
  Frame FrameOf(const BagMessage& message) const;

  std::string path_;
  BagChoice choice_;
  std::unique_ptr<BagReader> bag_;
  BagTopics topics_;
  std::optional<CameraInfoMessage> camera_info_;
  std::optional<RigidTransform> body_from_camera_;
  std::vector<PoseSample> poses_;
  double rate_hz_ = kNominalRateHz;

  std::vector<Frame> waiting_;  // in order of time
  bool has_ended_ = false;
  std::optional<Time> last_time_;
  std::size_t left_out_ = 0;
};

// Opens a bag, or any other source that OpenSource knows. Throws InputError as they do, and when
// 'choice' chooses in something that is no bag.
std::unique_ptr<FrameSource> OpenSourceOrBag(const std::vector<std::string>& arguments,
                                             PixelFormat format, const BagChoice& choice);

}  // namespace kestrel
