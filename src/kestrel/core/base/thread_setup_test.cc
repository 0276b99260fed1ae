// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/core/base/thread_setup.h"

#include <array>
#include <pthread.h>
#include <sched.h>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kestrel/core/base/options.h"

namespace kestrel {
namespace {

using ::testing::AnyOf;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

TEST(ThreadSetup, NamesAndPinsCallingThreadOnly) {
  cpu_set_t allowed;
  ASSERT_EQ(pthread_getaffinity_np(pthread_self(), sizeof(allowed), &allowed), 0);
  int cpu = 0;
  while (!CPU_ISSET(cpu, &allowed)) ++cpu;
  std::thread([cpu] {
    EXPECT_EQ(SetUpThisThread("kestrel-vision-and-more", {.cpu = cpu}), "");
    std::array<char, 32> name{};
    pthread_getname_np(pthread_self(), name.data(), name.size());
    EXPECT_STREQ(name.data(), "kestrel-vision-");
    EXPECT_EQ(sched_getcpu(), cpu);
  }).join();
  cpu_set_t after;
  pthread_getaffinity_np(pthread_self(), sizeof(after), &after);
  EXPECT_TRUE(CPU_EQUAL(&allowed, &after));
}

TEST(ThreadSetup, SetsPriorityOrReportsRefusal) {
  std::thread([] {
    const std::string refused = SetUpThisThread("vision", {.priority = 10});
    EXPECT_THAT(refused, AnyOf(IsEmpty(), HasSubstr("thread vision: priority 10 is not permitted"),
                               HasSubstr("thread vision: no priority 10")));
    int policy = 0;
    sched_param parameter{};
    pthread_getschedparam(pthread_self(), &policy, &parameter);
    EXPECT_EQ(policy, refused.empty() ? SCHED_FIFO : SCHED_OTHER);
  }).join();
}

TEST(ThreadSetup, ReportsInvalidOptions) {
  EXPECT_THAT(ViolationsOf(ThreadOptions()), IsEmpty());
  EXPECT_THAT(ViolationsOf(ThreadOptions{.cpu = 100'000}), SizeIs(1));
  EXPECT_THAT(ViolationsOf(ThreadOptions{.cpu = -2, .priority = 100}), SizeIs(2));
}

}  // namespace
}  // namespace kestrel
