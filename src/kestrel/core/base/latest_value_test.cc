// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/core/base/latest_value.h"

#include <thread>

#include <gtest/gtest.h>

namespace kestrel {
namespace {

struct Pair {
  int value = 0;
  int negative = 0;
};

TEST(LatestValueTest, IsDefaultBeforeFirstValue) {
  LatestValue<Pair> latest;
  EXPECT_EQ(latest.Get().value, 0);
}

TEST(LatestValueTest, ReturnsNewestValue) {
  LatestValue<Pair> latest;
  latest.Set({1, -1});
  latest.Set({2, -2});
  EXPECT_EQ(latest.Get().value, 2);
  EXPECT_EQ(latest.Get().value, 2);
  latest.Set({3, -3});
  EXPECT_EQ(latest.Get().value, 3);
}

TEST(LatestValueTest, IsNeverTornOrOlderThanBefore) {
  constexpr int kLast = 200'000;
  LatestValue<Pair> latest;
  std::thread writer([&latest] {
    for (int i = 1; i <= kLast; ++i) latest.Set({i, -i});
  });
  int before = 0;
  while (before < kLast) {
    const Pair pair = latest.Get();
    ASSERT_EQ(pair.negative, -pair.value);
    ASSERT_GE(pair.value, before);
    before = pair.value;
  }
  writer.join();
}

}  // namespace
}  // namespace kestrel
