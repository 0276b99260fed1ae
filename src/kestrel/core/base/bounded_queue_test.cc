// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/core/base/bounded_queue.h"

#include <memory>
#include <thread>

#include <gtest/gtest.h>

namespace kestrel {
namespace {

using std::chrono::milliseconds;

TEST(BoundedQueue, KeepsOrder) {
  BoundedQueue<int> queue(3);
  for (const int value : {1, 2, 3}) EXPECT_FALSE(queue.Push(value));
  for (const int value : {1, 2, 3}) EXPECT_EQ(queue.TryPop(), value);
  EXPECT_FALSE(queue.TryPop());
  EXPECT_EQ(queue.dropped(), 0u);
}

TEST(BoundedQueue, DropsOldestWhenFull) {
  BoundedQueue<int> newest(1);
  newest.Push(1);
  EXPECT_EQ(newest.Push(2), 1);
  EXPECT_EQ(newest.dropped(), 1u);
  EXPECT_EQ(newest.TryPop(), 2);
}

TEST(BoundedQueue, WaitsUntilTimeout) {
  BoundedQueue<int> queue(1);
  const Time start = Now();
  EXPECT_FALSE(queue.Pop(milliseconds(20)));
  EXPECT_GE(Now() - start, milliseconds(20));
}

TEST(BoundedQueue, ClosedQueueDrainsAndRefusesNewValues) {
  BoundedQueue<int> queue(2);
  queue.Push(1);
  queue.Close();
  EXPECT_EQ(queue.Push(2), 2) << "given back";
  EXPECT_EQ(queue.Pop(std::chrono::hours(1)), 1);
  EXPECT_FALSE(queue.Pop(std::chrono::hours(1)));
}

TEST(BoundedQueue, DestroysDroppedValueWithoutLock) {
  struct Requests {
    explicit Requests(BoundedQueue<std::unique_ptr<Requests>>* requested) : queue(requested) {}
    ~Requests() { queue->size(); }  // would deadlock under the lock
    BoundedQueue<std::unique_ptr<Requests>>* queue;
  };
  BoundedQueue<std::unique_ptr<Requests>> queue(1);
  queue.Push(std::make_unique<Requests>(&queue));
  queue.Push(std::make_unique<Requests>(&queue));
  EXPECT_EQ(queue.dropped(), 1u);
  queue.TryPop().reset();
}

TEST(BoundedQueue, DeliversOrCountsEveryValue) {
  constexpr std::size_t kCount = 20'000;
  BoundedQueue<int> queue(16);
  std::size_t taken = 0;
  std::thread taker([&] {
    while (queue.Pop(std::chrono::hours(1))) ++taken;
  });
  for (std::size_t i = 0; i < kCount; ++i) queue.Push(1);
  queue.Close();
  taker.join();
  EXPECT_EQ(taken + queue.dropped(), kCount);
}

}  // namespace
}  // namespace kestrel
