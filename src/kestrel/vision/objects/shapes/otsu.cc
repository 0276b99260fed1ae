// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/objects/shapes/otsu.h"

namespace kestrel {

OtsuSplit SplitByOtsu(const Histogram& histogram) {
  double count = 0;
  double sum = 0;
  for (int value = 0; value < 256; ++value) {
    count += histogram[value];
    sum += static_cast<double>(value) * histogram[value];
  }
  OtsuSplit split;
  double best_variance = 0;
  double lower_count = 0;
  double lower_sum = 0;
  for (int value = 0; value < 255; ++value) {
    lower_count += histogram[value];
    lower_sum += static_cast<double>(value) * histogram[value];
    const double upper_count = count - lower_count;
    if (lower_count == 0 || upper_count == 0) continue;
    const double lower_mean = lower_sum / lower_count;
    const double upper_mean = (sum - lower_sum) / upper_count;
    const double difference = upper_mean - lower_mean;
    const double variance = lower_count * upper_count * difference * difference;
    if (variance <= best_variance) continue;
    best_variance = variance;
    split = {value, lower_mean, upper_mean};
  }
  return split;
}

}  // namespace kestrel
