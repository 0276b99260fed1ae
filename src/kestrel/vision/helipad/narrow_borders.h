// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "kestrel/core/image/black_top_hat.h"
#include "kestrel/vision/tags/plane_borders.h"

namespace kestrel {

// Memory of one thread's narrow borders.
struct NarrowBorderBuffers {
  BlackTopHat top_hat;
  std::vector<std::uint8_t> inverted;  // a level, dark where there is white ink

  void Reserve(const cv::Mat& image, BorderBuffers* borders);
};

// Traces borders around strokes of ink that are narrow at a level of an image's pyramid, in any
// light: the edge of a shadow that crosses a stroke is no border of it, as light is a term of the
// logarithms in the pyramid, which the top-hat removes. 'level': from 0; 'borders->pyramid' must
// have it. A border goes around the ink. Does not allocate after Reserve.
std::span<const Border> TraceNarrow(int level, bool white_ink, const BorderLimits& limits,
                                    BorderBuffers* borders, NarrowBorderBuffers* buffers);

}  // namespace kestrel
