// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "kestrel/calibration/lens/lens_calibration.h"
#include "kestrel/io/recording/frame.h"

namespace kestrel {

// Evenly spaced images of a stream of any length: at most 400.
class EvenSample {
 public:
  void Add(const Frame& frame);
  std::vector<LensImage> Take() { return std::move(images_); }

 private:
  std::vector<LensImage> images_;
  std::size_t count_ = 0;
  std::size_t stride_ = 1;
};

}  // namespace kestrel
