// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/landing/alignment/column_products.h"

#include <array>
#include <vector>

#include <gtest/gtest.h>

#include "kestrel/core/base/random.h"
#include "kestrel/core/base/test_targets.h"

namespace kestrel {
namespace {

TEST(SumProducts, MatchesProductsOfAllPairs) {
  ForEveryTarget([&] {
    Random random(1);
    constexpr std::size_t kColumns = 5;
    for (const std::size_t count : {0u, 1u, 7u, 16u, 33u, 203u}) {
      std::array<std::vector<float>, kColumns> columns;
      std::array<const float*, kColumns> pointers;
      for (std::size_t k = 0; k < kColumns; ++k) {
        for (std::size_t i = 0; i < count; ++i) {
          columns[k].push_back(static_cast<float>(random.Uniform(-1, 1)));
        }
        pointers[k] = columns[k].data();
      }
      std::array<double, kColumns * kColumns> products;
      SumProducts(pointers, count, products.data());
      for (std::size_t a = 0; a < kColumns; ++a) {
        for (std::size_t b = 0; b < kColumns; ++b) {
          double sum = 0;
          for (std::size_t i = 0; i < count; ++i) sum += columns[a][i] * columns[b][i];
          EXPECT_NEAR(products[a * kColumns + b], sum, 1e-4) << count;
        }
      }
    }
  });
}

}  // namespace
}  // namespace kestrel
