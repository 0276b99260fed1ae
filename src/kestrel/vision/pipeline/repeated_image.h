// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>

#include <opencv2/core.hpp>

namespace kestrel {

// Hash of the pixels in every eighth row: a sensor's noise makes any two images differ there.
std::uint64_t HashOf(const cv::Mat& image);

// Detects images that repeat the one before: a camera or driver that hangs repeats its last image
// with new times, and everything in it seems to move along with the UAV.
class RepeatedImage {
 public:
  // True when 'image' has the same HashOf as the one before. Does not allocate.
  bool IsRepeated(const cv::Mat& image);

  int in_a_row() const { return in_a_row_; }  // number of repetitions up to the newest image

 private:
  std::optional<std::uint64_t> hash_;  // what the newest image hashes to
  int in_a_row_ = 0;
};

}  // namespace kestrel
