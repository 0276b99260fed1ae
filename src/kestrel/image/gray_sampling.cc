// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/image/gray_sampling.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kestrel/image/gray_sampling.cc"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace kestrel {
namespace HWY_NAMESPACE {

// Instruction sets that read many places of memory at once; without them one after the other is as
// fast.
#if HWY_TARGET == HWY_AVX2 || HWY_TARGET == HWY_AVX3 || HWY_TARGET == HWY_AVX3_DL
namespace hn = hwy::HWY_NAMESPACE;
using Floats = hn::CappedTag<float, 8>;
using Integers = hn::RebindToSigned<Floats>;
using FloatVector = hn::Vec<Floats>;
using IntegerVector = hn::Vec<Integers>;

// The two bytes at and behind each offset, as floats.
struct BytePair {
  FloatVector first;
  FloatVector second;
};
HWY_INLINE BytePair ReadPairs(const cv::Mat& image, IntegerVector offset) {
  const Floats d;
  const Integers di;
  const hn::RebindToUnsigned<Floats> du;
  // Four bytes are read at once: at the end of the image those before it, and shifted.
  const std::size_t size = image.step[0] * (image.rows - 1) + image.cols;
  const IntegerVector start = hn::Min(offset, hn::Set(di, static_cast<std::int32_t>(size) - 4));
  const auto word = hn::GatherOffset(di, reinterpret_cast<const std::int32_t*>(image.data), start);
  const auto bytes =
      hn::Shr(hn::BitCast(du, word), hn::BitCast(du, hn::ShiftLeft<3>(hn::Sub(offset, start))));
  const auto low = hn::Set(du, 255);
  return {hn::ConvertTo(d, hn::BitCast(di, hn::And(bytes, low))),
          hn::ConvertTo(d, hn::BitCast(di, hn::And(hn::ShiftRight<8>(bytes), low)))};
}

HWY_INLINE void SampleVector(const cv::Mat& image, const float* x_px, const float* y_px,
                             float* gray) {
  const Floats d;
  const Integers di;
  const FloatVector all_x = hn::LoadU(d, x_px);
  const FloatVector all_y = hn::LoadU(d, y_px);
  const FloatVector zero = hn::Zero(d);
  const auto inside =
      hn::And(hn::And(hn::Ge(all_x, zero), hn::Ge(all_y, zero)),
              hn::And(hn::Le(all_x, hn::Set(d, static_cast<float>(image.cols - 1))),
                      hn::Le(all_y, hn::Set(d, static_cast<float>(image.rows - 1)))));
  const FloatVector x = hn::IfThenElseZero(inside, all_x);
  const FloatVector y = hn::IfThenElseZero(inside, all_y);
  const IntegerVector x0 = hn::Min(hn::ConvertTo(di, x), hn::Set(di, image.cols - 2));
  const IntegerVector y0 = hn::Min(hn::ConvertTo(di, y), hn::Set(di, image.rows - 2));
  const FloatVector fx = hn::Sub(x, hn::ConvertTo(d, x0));
  const FloatVector fy = hn::Sub(y, hn::ConvertTo(d, y0));
  const IntegerVector stride = hn::Set(di, static_cast<std::int32_t>(image.step[0]));
  const IntegerVector offset = hn::Add(hn::Mul(y0, stride), x0);
  const BytePair upper = ReadPairs(image, offset);
  const BytePair lower = ReadPairs(image, hn::Add(offset, stride));
  const FloatVector top = hn::MulAdd(fx, hn::Sub(upper.second, upper.first), upper.first);
  const FloatVector bottom = hn::MulAdd(fx, hn::Sub(lower.second, lower.first), lower.first);
  const FloatVector value = hn::MulAdd(fy, hn::Sub(bottom, top), top);
  hn::StoreU(hn::IfThenElse(inside, value, hn::Set(d, -1.0f)), d, gray);
}

void SampleGrays(const cv::Mat& image, const float* x, const float* y, std::size_t count,
                 float* gray) {
  const std::size_t lanes = hn::Lanes(Floats());
  if (count < lanes) {
    for (std::size_t i = 0; i < count; ++i) gray[i] = SampleGray(image, x[i], y[i]);
    return;
  }
  for (std::size_t i = 0; i + lanes <= count; i += lanes) {
    SampleVector(image, x + i, y + i, gray + i);
  }
  // The last vector overlaps the one before it: some places are looked at twice.
  const std::size_t last = count - lanes;
  SampleVector(image, x + last, y + last, gray + last);
}
#else
void SampleGrays(const cv::Mat& image, const float* x, const float* y, std::size_t count,
                 float* gray) {
  for (std::size_t i = 0; i < count; ++i) gray[i] = SampleGray(image, x[i], y[i]);
}
#endif

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
