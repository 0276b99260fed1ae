// SPDX-License-Identifier: BSD-3-Clause

// SampleGray for a vector of places. Included once for every instruction set, by sources that
// include hwy/foreach_target.h.
#if defined(KESTREL_IMAGE_GRAY_SAMPLING_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef KESTREL_IMAGE_GRAY_SAMPLING_INL_H_
#undef KESTREL_IMAGE_GRAY_SAMPLING_INL_H_
#else
#define KESTREL_IMAGE_GRAY_SAMPLING_INL_H_
#endif

#include <cstdint>

#include <hwy/highway.h>
#include <opencv2/core.hpp>

HWY_BEFORE_NAMESPACE();
namespace kestrel {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

// The bytes at each offset and at the next one, as floats.
template <class D>
struct BytePairs {
  hn::Vec<D> first;
  hn::Vec<D> second;
};

// Instruction sets with a gather instruction.
#if HWY_TARGET == HWY_AVX2 || HWY_TARGET == HWY_AVX3 || HWY_TARGET == HWY_AVX3_DL
template <class D>
HWY_INLINE BytePairs<D> ReadPairs(D d, const cv::Mat& image,
                                  hn::Vec<hn::RebindToSigned<D>> offset) {
  const hn::RebindToSigned<D> di;
  const hn::RebindToUnsigned<D> du;
  // Reads four bytes at once. At the end of the image it reads earlier bytes and shifts them.
  const std::size_t size = image.step[0] * (image.rows - 1) + image.cols;
  const auto start = hn::Min(offset, hn::Set(di, static_cast<std::int32_t>(size) - 4));
  const auto word = hn::GatherOffset(di, reinterpret_cast<const std::int32_t*>(image.data), start);
  const auto bytes =
      hn::Shr(hn::BitCast(du, word), hn::BitCast(du, hn::ShiftLeft<3>(hn::Sub(offset, start))));
  const auto low = hn::Set(du, 255);
  return {hn::ConvertTo(d, hn::BitCast(di, hn::And(bytes, low))),
          hn::ConvertTo(d, hn::BitCast(di, hn::And(hn::ShiftRight<8>(bytes), low)))};
}
#else
template <class D>
HWY_INLINE BytePairs<D> ReadPairs(D d, const cv::Mat& image,
                                  hn::Vec<hn::RebindToSigned<D>> offset) {
  HWY_ALIGN std::int32_t offsets[hn::MaxLanes(d)];
  HWY_ALIGN float first[hn::MaxLanes(d)], second[hn::MaxLanes(d)];
  hn::Store(offset, hn::RebindToSigned<D>(), offsets);
  for (std::size_t i = 0; i < hn::Lanes(d); ++i) {
    first[i] = static_cast<float>(image.data[offsets[i]]);
    second[i] = static_cast<float>(image.data[offsets[i] + 1]);
  }
  return {hn::Load(d, first), hn::Load(d, second)};
}
#endif

// Vector version of SampleGray: negative outside of the image and for NaN. The image has at least 2
// x 2 pixels and less than 2 GB.
template <class D>
HWY_INLINE hn::Vec<D> SampleVector(D d, const cv::Mat& image, hn::Vec<D> x_px, hn::Vec<D> y_px) {
  const hn::RebindToSigned<D> di;
  const auto zero = hn::Zero(d);
  const auto inside =
      hn::And(hn::And(hn::Ge(x_px, zero), hn::Ge(y_px, zero)),
              hn::And(hn::Le(x_px, hn::Set(d, static_cast<float>(image.cols - 1))),
                      hn::Le(y_px, hn::Set(d, static_cast<float>(image.rows - 1)))));
  const auto x = hn::IfThenElseZero(inside, x_px);
  const auto y = hn::IfThenElseZero(inside, y_px);
  const auto x0 = hn::Min(hn::ConvertTo(di, x), hn::Set(di, image.cols - 2));
  const auto y0 = hn::Min(hn::ConvertTo(di, y), hn::Set(di, image.rows - 2));
  const auto fx = hn::Sub(x, hn::ConvertTo(d, x0));
  const auto fy = hn::Sub(y, hn::ConvertTo(d, y0));
  const auto stride = hn::Set(di, static_cast<std::int32_t>(image.step[0]));
  const auto offset = hn::Add(hn::Mul(y0, stride), x0);
  const auto upper = ReadPairs(d, image, offset);
  const auto lower = ReadPairs(d, image, hn::Add(offset, stride));
  const auto top = hn::MulAdd(fx, hn::Sub(upper.second, upper.first), upper.first);
  const auto bottom = hn::MulAdd(fx, hn::Sub(lower.second, lower.first), lower.first);
  return hn::IfThenElse(inside, hn::MulAdd(fy, hn::Sub(bottom, top), top), hn::Set(d, -1.0f));
}

}  // namespace HWY_NAMESPACE
}  // namespace kestrel
HWY_AFTER_NAMESPACE();

#endif  // KESTREL_IMAGE_GRAY_SAMPLING_INL_H_
