// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/onboard/send_schedule.h"

#include <chrono>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace kestrel {
namespace {

using std::chrono::milliseconds;
using ::testing::ElementsAre;

constexpr double kRate_hz = 50;

// Times of messages within 'until_ms' when there are news every 'news_ms', asked every millisecond.
std::vector<int> Sent(int until_ms, int news_ms) {
  SendSchedule schedule(kRate_hz);
  bool is_news = false;
  std::vector<int> sent;
  for (int ms = 0; ms < until_ms; ++ms) {
    is_news = is_news || (news_ms > 0 && ms % news_ms == 0);
    if (!schedule.IsDue(TimeFromNanoseconds(1'000'000'000) + milliseconds(ms), is_news)) continue;
    is_news = false;
    sent.push_back(ms);
  }
  return sent;
}

TEST(SendScheduleTest, SendsNewsAtOnceAndRepeatsInBetween) {
  EXPECT_THAT(Sent(100, 0), ElementsAre(0, 20, 40, 60, 80));
  EXPECT_THAT(Sent(100, 33), ElementsAre(0, 20, 33, 53, 66, 86, 99));
}

TEST(SendScheduleTest, LimitsRateOfFastNews) {
  EXPECT_THAT(Sent(50, 2), ElementsAre(0, 10, 20, 30, 40));
}

}  // namespace
}  // namespace kestrel
