// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/core/image/gray_sampling.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kestrel/core/image/gray_sampling.cc"
#include <hwy/foreach_target.h>
// After foreach_target.h, which includes this file once for every instruction set.
#include <hwy/highway.h>

#include "kestrel/core/image/gray_sampling-inl.h"

HWY_BEFORE_NAMESPACE();
namespace kestrel {
namespace HWY_NAMESPACE {

void SampleGrays(const cv::Mat& image, const float* x, const float* y, std::size_t count,
                 float* gray) {
  const hn::CappedTag<float, 16> d;
  const auto sample = [&](std::size_t i) HWY_ATTR {
    hn::StoreU(SampleVector(d, image, hn::LoadU(d, x + i), hn::LoadU(d, y + i)), d, gray + i);
  };
  const std::size_t lanes = hn::Lanes(d);
  if (count < lanes) {
    for (std::size_t i = 0; i < count; ++i) gray[i] = SampleGray(image, x[i], y[i]);
    return;
  }
  for (std::size_t i = 0; i + lanes <= count; i += lanes) sample(i);
  // The last vector overlaps the one before: some places are sampled twice.
  sample(count - lanes);
}

}  // namespace HWY_NAMESPACE
}  // namespace kestrel
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace kestrel {

HWY_EXPORT(SampleGrays);

void SampleGrays(const cv::Mat& image, const float* x, const float* y, std::size_t count,
                 float* gray) {
  HWY_DYNAMIC_DISPATCH(SampleGrays)(image, x, y, count, gray);
}

}  // namespace kestrel
#endif  // HWY_ONCE
