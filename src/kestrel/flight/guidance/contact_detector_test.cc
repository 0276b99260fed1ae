// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/guidance/contact_detector.h"

#include <gtest/gtest.h>

namespace kestrel {
namespace {

using Eigen::Vector3d;

const Vector3d kDeckVelocity(4, 0, 0);

struct Contacts {
  // Updates every 20 ms for 'seconds' with the feet at 'from_deck' and this sink rate.
  bool Update(double seconds, const Vector3d& from_deck, double sink_mps, bool knows_deck = true) {
    bool has_contact = false;
    for (int i = 0; i < seconds / 0.02; ++i) {
      time_s += 0.02;
      const Vector3d deck = Vector3d(0, 0, 1.8) + time_s * kDeckVelocity;
      has_contact = detector.Update(
          TimeFromNanoseconds(0) + DurationFromSeconds(time_s), deck + from_deck,
          kDeckVelocity - Vector3d(0, 0, sink_mps),
          knows_deck ? std::optional(ContactDetector::Deck{deck, kDeckVelocity}) : std::nullopt);
    }
    return has_contact;
  }
  ContactDetector detector{ContactOptions()};
  double time_s = 0;
};

TEST(ContactDetectorTest, BriefRestOnDeckIsContact) {
  Contacts contacts;
  EXPECT_FALSE(contacts.Update(2, {0.1, 0, 0.05}, 0.7)) << "sinks";
  EXPECT_FALSE(contacts.Update(2, {0.1, 0, 0.4}, 0)) << "hovers above it";
  EXPECT_FALSE(contacts.Update(2, {1, 0, 0.05}, 0)) << "beside it";
  EXPECT_FALSE(contacts.Update(0.4, {0.1, 0, 0.05}, 0)) << "too short";
  EXPECT_TRUE(contacts.Update(0.2, {0.1, 0, 0.05}, 0));
}

// The shock of touch-down leaves the estimate wrong: by 0.12 m/s, up or down, was seen.
TEST(ContactDetectorTest, ContactLastsDespiteWrongEstimateAfterTouchDown) {
  for (const double sink_mps : {0.12, -0.12}) {
    Contacts contacts;
    EXPECT_TRUE(contacts.Update(0.6, {0.1, 0, 0.05}, sink_mps));
    for (int i = 0; i < 60; ++i) {
      ASSERT_TRUE(contacts.Update(1, {0.1, 0, 0.05 - i * sink_mps}, sink_mps)) << i << " s";
    }
  }
  Contacts slow;
  EXPECT_FALSE(slow.Update(2, {0.1, 0, 0.05}, 0.3)) << "still sinks";
}

TEST(ContactDetectorTest, ContactLastsWithoutDeckEstimateUntilUavRises) {
  Contacts contacts;
  ASSERT_TRUE(contacts.Update(1, {0.1, 0, 0.05}, 0));
  EXPECT_TRUE(contacts.Update(5, {0.3, 0, 0.1}, 0.2, false));
  EXPECT_FALSE(contacts.Update(0.1, {0, 0, 0.8}, -1, false));
  EXPECT_FALSE(contacts.Update(1, {0, 0, 0.05}, 0, false)) << "the deck is not known";
}

}  // namespace
}  // namespace kestrel
