// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>

#include <gtest/gtest.h>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>

#include "kestrel/base/test_folder.h"

namespace kestrel {

// Makes the folders that lead to 'name' as well; returns the file's path.
inline std::string WriteTestImage(const TestFolder& folder, const std::string& name,
                                  const cv::Mat& image) {
  const std::string path = folder / name;
  std::filesystem::create_directories(std::filesystem::path(path).parent_path());
  EXPECT_TRUE(cv::imwrite(path, image)) << name;
  return path;
}

// Noise, so that an encoded file has a size worth cutting; the same for the same seed.
inline cv::Mat NoiseImage(int width, int height, int type, int seed = 1) {
  cv::Mat image(height, width, type);
  cv::RNG random(seed);
  random.fill(image, cv::RNG::UNIFORM, 0, 256);
  return image;
}

}  // namespace kestrel
