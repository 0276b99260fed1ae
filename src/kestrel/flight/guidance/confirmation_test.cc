// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/guidance/confirmation.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace kestrel {
namespace {

using testing::HasSubstr;
using testing::IsNull;

TEST(ConfirmationTest, OrderFromBeforeDoesNotCount) {
  Confirmation confirmation;
  confirmation.Begin({.number = 3, .mark = 7});
  EXPECT_THAT(confirmation.Update({.number = 3, .mark = 7}, 7, nullptr), IsNull());
  EXPECT_EQ(confirmation.mark(), 0);
}

TEST(ConfirmationTest, NewOrderConfirmsTheMark) {
  Confirmation confirmation;
  confirmation.Begin({});
  EXPECT_THAT(confirmation.Update({.number = 1, .mark = 7}, 7, nullptr), IsNull());
  EXPECT_TRUE(confirmation.is_new());
  EXPECT_EQ(confirmation.mark(), 7);
  EXPECT_THAT(confirmation.Update({.number = 1, .mark = 7}, 7, "not seen"), IsNull());
  EXPECT_FALSE(confirmation.is_new());
  EXPECT_EQ(confirmation.mark(), 7);
}

TEST(ConfirmationTest, OrderThatCannotBeFollowedIsVoid) {
  Confirmation confirmation;
  confirmation.Begin({});
  EXPECT_THAT(confirmation.Update({.number = 1, .mark = 7}, 8, nullptr), HasSubstr("else"));
  EXPECT_THAT(confirmation.Update({.number = 2, .mark = 8}, 8, "not seen"), HasSubstr("not seen"));
  EXPECT_THAT(confirmation.Update({.number = 2, .mark = 8}, 8, nullptr), IsNull());
  EXPECT_EQ(confirmation.mark(), 0);
}

TEST(ConfirmationTest, AnotherMarkEndsIt) {
  Confirmation confirmation;
  confirmation.Begin({});
  confirmation.Update({.number = 1, .mark = 7}, 7, nullptr);
  EXPECT_THAT(confirmation.Update({.number = 1, .mark = 7}, 8, nullptr), HasSubstr("else"));
  EXPECT_THAT(confirmation.Update({.number = 1, .mark = 7}, 7, nullptr), IsNull());
  EXPECT_EQ(confirmation.mark(), 0);
}

TEST(ConfirmationTest, OrderToStopEndsIt) {
  Confirmation confirmation;
  confirmation.Begin({});
  confirmation.Update({.number = 1, .mark = 7}, 7, nullptr);
  EXPECT_THAT(confirmation.Update({.number = 2, .mark = 0}, 7, nullptr), HasSubstr("stopped"));
  EXPECT_EQ(confirmation.mark(), 0);
}

}  // namespace
}  // namespace kestrel
