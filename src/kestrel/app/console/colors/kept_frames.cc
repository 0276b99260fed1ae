// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/console/colors/kept_frames.h"

#include <system_error>

#include <fmt/format.h>

#include "kestrel/core/base/error.h"
#include "kestrel/core/codec/image_codec.h"
#include "kestrel/io/recording/media/image_file.h"

namespace kestrel {

std::string KeptFrames::Keep(const cv::Mat& image, Time captured) {
  if (files_.size() == kMost) {
    throw InputError(fmt::format("{} frames are kept, there is no room for more", kMost));
  }
  if (image.empty()) throw InputError("no frame is kept: there is no image yet");
  if (image.type() != CV_8UC3) throw InputError("no frame is kept: the image has no colour");
  std::error_code error;
  std::filesystem::create_directories(folder_, error);
  if (error) throw InputError(folder_.string() + ": cannot be made: " + error.message());
  // The file names sort in the order of the numbers when they are read as a folder.
  const std::string file =
      (folder_ / fmt::format("{:02}_{}.png", files_.size() + 1, ToNanoseconds(captured))).string();
  WriteImage(file, image);
  files_.push_back(file);
  return fmt::format("frame {} is kept as {}", files_.size(), file);
}

cv::Mat KeptFrames::Read(std::size_t frame) const {
  return ReadImage(files_.at(frame), PixelFormat::kBgr);
}

}  // namespace kestrel
