// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/landing/column_products.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kestrel/landing/column_products.cc"
#include <hwy/foreach_target.h>
// After foreach_target.h, which includes this file once for every instruction set.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace kestrel {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

// Of a column and those of two others.
HWY_INLINE void SumTwo(const float* column, const float* first, const float* second,
                       std::size_t count, double* sums) {
  const hn::CappedTag<double, 8> d;
  const hn::Rebind<float, decltype(d)> df;
  const std::size_t lanes = hn::Lanes(d);
  auto sum0 = hn::Zero(d), sum1 = hn::Zero(d);
  std::size_t i = 0;
  for (; i + lanes <= count; i += lanes) {
    const auto values = hn::PromoteTo(d, hn::LoadU(df, column + i));
    sum0 = hn::MulAdd(values, hn::PromoteTo(d, hn::LoadU(df, first + i)), sum0);
    sum1 = hn::MulAdd(values, hn::PromoteTo(d, hn::LoadU(df, second + i)), sum1);
  }
  sums[0] = hn::GetLane(hn::SumOfLanes(d, sum0));
  sums[1] = hn::GetLane(hn::SumOfLanes(d, sum1));
  for (; i < count; ++i) {
    sums[0] += static_cast<double>(column[i]) * first[i];
    sums[1] += static_cast<double>(column[i]) * second[i];
  }
}

void SumProducts(std::span<const float* const> columns, std::size_t count, double* products) {
  const std::size_t size = columns.size();
  for (std::size_t a = 0; a < size; ++a) {
    for (std::size_t b = 0; b <= a; b += 2) {
      const std::size_t next = b < a ? b + 1 : b;
      double sums[2];
      SumTwo(columns[a], columns[b], columns[next], count, sums);
      products[a * size + b] = products[b * size + a] = sums[0];
      products[a * size + next] = products[next * size + a] = sums[next - b];
    }
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace kestrel
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace kestrel {

HWY_EXPORT(SumProducts);

void SumProducts(std::span<const float* const> columns, std::size_t count, double* products) {
  HWY_DYNAMIC_DISPATCH(SumProducts)(columns, count, products);
}

}  // namespace kestrel
#endif  // HWY_ONCE
