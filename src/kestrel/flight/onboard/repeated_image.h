// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>

#include <opencv2/core.hpp>

namespace kestrel {

// Of the pixels in every eighth row: the noise of a sensor makes any two images differ there.
std::uint64_t HashOf(const cv::Mat& image);

// Notices images that are the one before once more: a camera or a driver that hangs repeats what it
// has, with new times, and what stands still in the image seems to fly along.
class RepeatedImage {
 public:
  // Whether 'image' has the HashOf of the one before. Does not allocate.
  bool IsRepeated(const cv::Mat& image);

  int in_a_row() const { return in_a_row_; }  // repetitions up to the newest image

 private:
  std::optional<std::uint64_t> hash_;  // of the newest image
  int in_a_row_ = 0;
};

}  // namespace kestrel
