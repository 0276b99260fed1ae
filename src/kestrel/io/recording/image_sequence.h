// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "kestrel/io/recording/frame_source.h"

namespace kestrel {

// Images that lie in files.
class ImageSequence : public FrameSource {
 public:
  struct Item {
    std::string name;  // as in Frame
    std::string path;
    Time time;
  };

  // 'items' in order of time, at least one; the other two as FrameSource gives them out.
  explicit ImageSequence(std::vector<Item> items, std::string calibration_file = "",
                         std::vector<PoseSample> poses = {});

  bool Next(Frame* frame) override;
  bool Read(std::size_t index, Frame* frame) const override;
  std::optional<std::size_t> frame_count() const override { return items_.size(); }
  double rate_hz() const override;
  std::optional<CameraCalibration> calibration() const override;
  // Empty if there is none.
  const std::string& calibration_file() const { return calibration_file_; }
  std::vector<PoseSample> poses() const override { return poses_; }

 private:
  std::vector<Item> items_;
  std::string calibration_file_;
  std::vector<PoseSample> poses_;
  std::size_t next_ = 0;
};

// The time of the image 'index' where nothing says it: kNominalRateHz, from zero.
Time NominalTime(std::size_t index);

// Images in the order in which they are given, at nominal times.
ImageSequence OpenImageFiles(const std::vector<std::string>& paths);

// All images in and below 'folder', at nominal times, in natural order of their paths ("frame9"
// before "frame10"). Throws InputError when there is none.
ImageSequence OpenImageFolder(const std::string& folder);

}  // namespace kestrel
