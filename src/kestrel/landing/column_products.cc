// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/landing/column_products.h"

#include <algorithm>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kestrel/landing/column_products.cc"
#include <hwy/foreach_target.h>
// After foreach_target.h, which includes this file once for every instruction set.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace kestrel {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using Doubles = hn::CappedTag<double, 8>;
using Floats = hn::Rebind<float, Doubles>;
constexpr std::size_t kMostLanes = 8;

HWY_INLINE hn::Vec<Doubles> At(const float* values) {
  return hn::PromoteTo(Doubles(), hn::LoadU(Floats(), values));
}

void SumProducts(std::span<const float* const> columns, std::size_t count, double* products) {
  const Doubles d;
  const std::size_t lanes = hn::Lanes(d);
  const std::size_t size = columns.size();
  const std::size_t whole = count - count % lanes;
  // The rows that fill no vector, and zeros.
  float rest[kMostColumns][kMostLanes] = {};
  for (std::size_t k = 0; k < size; ++k) {
    std::copy(columns[k] + whole, columns[k] + count, rest[k]);
  }
  for (std::size_t a = 0; a < size; ++a) {
    for (std::size_t b = 0; b <= a; b += 2) {
      const std::size_t next = std::min(b + 1, a);
      const auto last = At(rest[a]);
      auto sum = hn::Mul(last, At(rest[b]));
      auto next_sum = hn::Mul(last, At(rest[next]));
      for (std::size_t i = 0; i < whole; i += lanes) {
        const auto values = At(columns[a] + i);
        sum = hn::MulAdd(values, At(columns[b] + i), sum);
        next_sum = hn::MulAdd(values, At(columns[next] + i), next_sum);
      }
      const auto put = [&](std::size_t other, auto lane_sums) HWY_ATTR {
        products[a * size + other] = products[other * size + a] =
            hn::GetLane(hn::SumOfLanes(d, lane_sums));
      };
      put(b, sum);
      put(next, next_sum);
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
