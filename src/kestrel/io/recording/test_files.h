// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>

#include <gtest/gtest.h>
#include <opencv2/core.hpp>

#include "kestrel/core/base/test_folder.h"
#include "kestrel/core/codec/image_codec.h"
#include "kestrel/io/recording/media/video_file.h"

namespace kestrel {

// Also creates the folders of 'name'. Returns the file's path.
inline std::string WriteTestImage(const TestFolder& folder, const std::string& name,
                                  const cv::Mat& image) {
  const std::string path = folder / name;
  std::filesystem::create_directories(std::filesystem::path(path).parent_path());
  WriteImage(path, image);
  return path;
}

// Noise, so that an encoded file is large enough to be cut; the same for the same seed.
inline cv::Mat NoiseImage(int width, int height, int type, int seed = 1) {
  cv::Mat image(height, width, type);
  cv::RNG random(seed);
  random.fill(image, cv::RNG::UNIFORM, 0, 256);
  return image;
}

// Writes a video of noise. Returns the file's path.
inline std::string WriteTestVideo(const std::string& stem, VideoFormat format, int frames,
                                  const cv::Size& size, double rate_hz = 20) {
  VideoFile video(stem, rate_hz, format);
  for (int i = 0; i < frames; ++i) {
    video.Write(NoiseImage(size.width, size.height, CV_8UC3, i + 1));
  }
  video.Close();
  return video.path();
}

}  // namespace kestrel
