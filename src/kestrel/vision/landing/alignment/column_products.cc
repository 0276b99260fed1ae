// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/landing/alignment/column_products.h"

#include <algorithm>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kestrel/vision/landing/alignment/column_products.cc"
#include <hwy/foreach_target.h>
// After foreach_target.h, which includes this file once for every instruction set.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace kestrel {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

// Rows that are summed at once: whole vectors of at most kMostLanes lanes, padded with zeros.
constexpr std::size_t kMostLanes = 8;
constexpr std::size_t kBlockRows = 10 * kMostLanes;
using Block = double[kMostColumns][kBlockRows];

// Adds the sums of a block to the products on and below the diagonal.
HWY_INLINE void AddBlock(const Block& block, std::size_t size, std::size_t rows, double* products) {
  const hn::CappedTag<double, 8> d;
  for (std::size_t a = 0; a < size; ++a) {
    for (std::size_t b = 0; b <= a; b += 2) {
      const std::size_t next = std::min(b + 1, a);
      auto sum = hn::Zero(d), next_sum = hn::Zero(d);
      for (std::size_t i = 0; i < rows; i += hn::Lanes(d)) {
        const auto values = hn::Load(d, &block[a][i]);
        sum = hn::MulAdd(values, hn::Load(d, &block[b][i]), sum);
        next_sum = hn::MulAdd(values, hn::Load(d, &block[next][i]), next_sum);
      }
      products[a * size + b] += hn::GetLane(hn::SumOfLanes(d, sum));
      if (next > b) products[a * size + next] += hn::GetLane(hn::SumOfLanes(d, next_sum));
    }
  }
}

void SumProducts(std::span<const float* const> columns, std::size_t count, double* products) {
  const std::size_t size = columns.size();
  std::fill(products, products + size * size, 0.0);
  HWY_ALIGN Block block;
  for (std::size_t first = 0; first < count; first += kBlockRows) {
    const std::size_t rows = std::min(kBlockRows, count - first);
    const std::size_t whole = rows + (kBlockRows - rows) % kMostLanes;
    for (std::size_t k = 0; k < size; ++k) {
      for (std::size_t i = 0; i < rows; ++i) block[k][i] = columns[k][first + i];
      for (std::size_t i = rows; i < whole; ++i) block[k][i] = 0;
    }
    AddBlock(block, size, rows, products);
  }
  for (std::size_t a = 0; a < size; ++a) {
    for (std::size_t b = 0; b < a; ++b) products[b * size + a] = products[a * size + b];
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
