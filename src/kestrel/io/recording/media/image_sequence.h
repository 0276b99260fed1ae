// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "kestrel/io/recording/frame_source.h"

namespace kestrel {

// A source of image files.
class ImageSequence : public FrameSource {
 public:
  struct Item {
    std::string name;  // as in Frame
    std::string path;
    Time time;
    std::size_t page = 0;  // page in a TIFF
  };

  // 'items' are in order of time, at least one. The others are as FrameSource returns them.
  explicit ImageSequence(std::vector<Item> items, std::string calibration_file = "",
                         std::vector<PoseSample> poses = {}, std::vector<GimbalSample> gimbal = {},
                         std::vector<ZoomSample> zoom = {});

  bool Read(std::size_t index, Frame* frame) const override;
  std::optional<std::size_t> frame_count() const override { return items_.size(); }
  double rate_hz() const override;
  std::optional<CameraCalibration> calibration() const override;
  // Empty when there is none.
  const std::string& calibration_file() const { return calibration_file_; }
  std::vector<PoseSample> poses() const override { return poses_; }
  std::vector<GimbalSample> gimbal() const override { return gimbal_; }
  std::vector<ZoomSample> zoom() const override { return zoom_; }

 private:
  bool ReadNext(Frame* frame) override;

  std::vector<Item> items_;
  std::string calibration_file_;
  std::vector<PoseSample> poses_;
  std::vector<GimbalSample> gimbal_;
  std::vector<ZoomSample> zoom_;
  std::size_t next_ = 0;
};

// Returns the time of the image 'index' where it has none: kNominalRateHz, from zero.
Time NominalTime(std::size_t index);

// Opens images in the given order, at nominal times. Each page of a TIFF that has several is an
// image: "scan.tif/000001".
ImageSequence OpenImageFiles(const std::vector<std::string>& paths);

// Opens all images in and below 'folder', at nominal times, in natural order of their paths
// ("frame9" before "frame10"). Throws InputError when there is none.
ImageSequence OpenImageFolder(const std::string& folder);

}  // namespace kestrel
