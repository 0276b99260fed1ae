// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/pipeline/camera_watch.h"

#include <algorithm>
#include <chrono>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace kestrel {
namespace {

using ::testing::HasSubstr;

// Two cameras with ten images a second each.
class CameraWatchTest : public ::testing::Test {
 protected:
  static constexpr std::size_t kFirst = 0, kSecond = 1;
  static constexpr double kDistance_m = 10;

  // A frame that differs from the ones before, and where it shows the target.
  void See(std::size_t camera, CameraSighting sighting) {
    watch_.AddFrame(camera, cv::Mat(8, 8, CV_8UC1, cv::Scalar(++frames_ % 256)), time_);
    if (!watch_.IsJudged(camera)) return;
    sighting.time = time_;
    sighting.distance_m = kDistance_m;
    sighting.turn_variance = 1e-5;
    watch_.AddSighting(camera, sighting,
                       [this](std::size_t each, std::size_t) { return each == refuted_; });
  }
  void See(std::size_t camera, SightingPlace place, double offset_m = 0) {
    See(camera, {.place = place, .offset_m = offset_m});
  }
  // A sighting inside, by a camera that is turned against the track.
  void SeeTurned(std::size_t camera, double turned,
                 const Eigen::Vector3d& turn_by_lag = {0, 0, 0}) {
    See(camera, {.place = SightingPlace::kInside,
                 .turn = turned * Eigen::Vector3d::UnitX(),
                 .turn_by_lag = turn_by_lag});
  }
  // The second camera sees the target elsewhere than the first one, until it is left out.
  void Contradict() {
    for (int i = 0; i < 10; ++i, Step()) {
      See(kFirst, SightingPlace::kInside);
      See(kSecond, SightingPlace::kOutside, 1);
    }
  }
  void Step() { time_ += std::chrono::milliseconds(100); }
  CameraHealth HealthOf(std::size_t camera) const { return watch_.state(camera).health; }

  CameraWatch watch_{2};
  Time time_ = TimeFromNanoseconds(1'000'000'000);
  int frames_ = 0;
  std::size_t refuted_ = 2;  // camera that its own views refute; none
};

TEST_F(CameraWatchTest, SilentCameraIsLeftOutUntilItSendsAgain) {
  for (int i = 0; i < 12; ++i, Step()) See(kFirst, SightingPlace::kInside);
  EXPECT_EQ(HealthOf(kSecond), CameraHealth::kSilent);
  EXPECT_EQ(InWords(watch_.state(kSecond)), "sends no images: left out until it does");
  EXPECT_FALSE(watch_.IsUsed(kSecond));
  See(kSecond, SightingPlace::kInside);
  EXPECT_TRUE(watch_.IsUsed(kSecond));
  EXPECT_EQ(InWords(watch_.state(kSecond)), "is used again");
  EXPECT_TRUE(watch_.IsUsed(kFirst));
}

TEST_F(CameraWatchTest, FrozenCameraIsLeftOutFromItsFirstRepetition) {
  const cv::Mat image(8, 8, CV_8UC1, cv::Scalar(200));
  for (int i = 0; i < 6; ++i, Step()) {
    watch_.AddFrame(kSecond, image, time_);
    EXPECT_EQ(watch_.IsUsed(kSecond), i == 0) << i;
    See(kFirst, SightingPlace::kInside);
  }
  EXPECT_EQ(HealthOf(kSecond), CameraHealth::kFrozen);
  See(kSecond, SightingPlace::kInside);
  EXPECT_EQ(HealthOf(kSecond), CameraHealth::kGood);
}

TEST_F(CameraWatchTest, CameraThatContradictsIsLeftOut) {
  for (int i = 0; i < 10; ++i, Step()) {
    EXPECT_EQ(HealthOf(kSecond), CameraHealth::kGood) << i;
    See(kFirst, SightingPlace::kInside);
    See(kSecond, SightingPlace::kOutside, 0.5 + 0.01 * i);
  }
  EXPECT_EQ(HealthOf(kSecond), CameraHealth::kContradicts);
  EXPECT_NEAR(watch_.state(kSecond).offset_m, 0.55, 0.02);
  EXPECT_THAT(InWords(watch_.state(kSecond)), HasSubstr("m from where the others see it"));
}

TEST_F(CameraWatchTest, CameraIsUsedAgainOnceItHasAgreedForLonger) {
  int used_after = 0;
  for (int round = 0; round < 2; ++round) {
    Contradict();
    ASSERT_EQ(HealthOf(kSecond), CameraHealth::kContradicts);
    int agreements = 0;
    for (; !watch_.IsUsed(kSecond) && agreements < 100; ++agreements, Step()) {
      See(kFirst, SightingPlace::kInside);
      See(kSecond, SightingPlace::kInside);
    }
    EXPECT_GT(agreements, std::max(2 * used_after - 3, 15));
    EXPECT_LT(agreements, 100);
    used_after = agreements;
    EXPECT_EQ(InWords(watch_.state(kSecond)), "is used again");
  }
}

TEST_F(CameraWatchTest, AgreementNobodyConfirmsDoesNotCount) {
  Contradict();
  See(kFirst, SightingPlace::kInside);
  for (int i = 0; i < 25; ++i, Step()) {
    See(kSecond, SightingPlace::kInside);
    watch_.AddFrame(kFirst, cv::Mat(8, 8, CV_8UC1, cv::Scalar(++frames_ % 256)), time_);
  }
  EXPECT_EQ(HealthOf(kSecond), CameraHealth::kContradicts);
}

TEST_F(CameraWatchTest, CameraThatContradictsIsUsedWhileItIsAlone) {
  Contradict();
  for (int i = 0; i < 15; ++i, Step()) See(kSecond, SightingPlace::kOutside, 1);
  EXPECT_EQ(HealthOf(kFirst), CameraHealth::kSilent);
  EXPECT_EQ(HealthOf(kSecond), CameraHealth::kAlone);
  EXPECT_TRUE(watch_.IsUsed(kSecond));
  EXPECT_THAT(InWords(watch_.state(kSecond)), HasSubstr("no other camera sees it"));
  See(kFirst, SightingPlace::kOutside, 1);
  EXPECT_TRUE(watch_.IsUsed(kFirst));
  See(kSecond, SightingPlace::kInside);
  EXPECT_EQ(HealthOf(kSecond), CameraHealth::kContradicts);
}

TEST_F(CameraWatchTest, CameraThatContradictsIsUsedWhereNoOtherSeesTheTarget) {
  Contradict();
  for (int i = 0; i < 35; ++i, Step()) {
    See(kSecond, SightingPlace::kOutside, 1);
    watch_.AddFrame(kFirst, cv::Mat(8, 8, CV_8UC1, cv::Scalar(++frames_ % 256)), time_);
    EXPECT_EQ(watch_.IsUsed(kSecond), i > 29) << i;
  }
  EXPECT_EQ(HealthOf(kFirst), CameraHealth::kGood);
}

// The target has moved while nobody saw it: both cameras agree on where it is.
TEST_F(CameraWatchTest, CamerasThatLoseTheTrackTogetherAreBothUsed) {
  for (int i = 0; i < 40; ++i, Step()) {
    const bool has_moved = i >= 10 && i < 13;
    const auto place = i == 13     ? SightingPlace::kStart
                       : has_moved ? SightingPlace::kOutside
                                   : SightingPlace::kInside;
    See(kFirst, place, 1);
    See(kSecond, has_moved ? place : SightingPlace::kInside, 1);
  }
  EXPECT_TRUE(watch_.IsUsed(kFirst));
  EXPECT_TRUE(watch_.IsUsed(kSecond));
}

// While the first camera does not see the target, the second one draws the track to where it sees
// it. When the first one is back, its sightings are the ones that are far from the track.
TEST_F(CameraWatchTest, CameraThatHasMovedTheTrackIsTheOneThatIsLeftOut) {
  See(kFirst, SightingPlace::kStart);
  for (int i = 0; i < 10; ++i, Step()) See(kFirst, SightingPlace::kInside);
  for (int i = 0; i < 4; ++i, Step()) See(kSecond, SightingPlace::kOutside, 2);
  See(kSecond, SightingPlace::kStart);
  for (int i = 0; i < 10; ++i, Step()) {
    See(kFirst, SightingPlace::kOutside, 2);
    See(kSecond, SightingPlace::kInside);
  }
  EXPECT_EQ(HealthOf(kFirst), CameraHealth::kGood);
  EXPECT_EQ(HealthOf(kSecond), CameraHealth::kContradicts);
}

TEST_F(CameraWatchTest, CameraThatItsOwnViewsRefuteIsTheOneThatIsLeftOut) {
  refuted_ = kSecond;
  See(kSecond, SightingPlace::kStart);
  for (int i = 0; i < 10; ++i, Step()) {
    See(kSecond, SightingPlace::kInside);
    See(kFirst, SightingPlace::kOutside, 2);
  }
  EXPECT_EQ(HealthOf(kFirst), CameraHealth::kGood);
  EXPECT_EQ(HealthOf(kSecond), CameraHealth::kContradicts);
}

// What shows the fault comes later than the decision: the UAV has not turned before.
TEST_F(CameraWatchTest, CameraThatItsOwnViewsRefuteLaterIsExchanged) {
  Contradict();
  ASSERT_EQ(HealthOf(kSecond), CameraHealth::kContradicts);
  refuted_ = kFirst;
  Contradict();
  EXPECT_EQ(HealthOf(kFirst), CameraHealth::kContradicts);
  EXPECT_EQ(HealthOf(kSecond), CameraHealth::kGood);
}

// The camera that has come in draws the track to where it sees the target; when the other one
// agrees for a while and contradicts again, nobody has moved the track against it.
TEST_F(CameraWatchTest, CameraThatWasExchangedHasNotMovedTheTrack) {
  Contradict();
  refuted_ = kFirst;
  Contradict();
  refuted_ = 2;
  for (int i = 0; i < 4; ++i, Step()) See(kSecond, SightingPlace::kOutside, 1);
  See(kSecond, SightingPlace::kStart);
  for (int i = 0; i < 30; ++i, Step()) {
    See(kSecond, SightingPlace::kInside);
    See(kFirst, SightingPlace::kInside);
  }
  ASSERT_EQ(HealthOf(kFirst), CameraHealth::kGood);
  for (int i = 0; i < 10; ++i, Step()) {
    See(kSecond, SightingPlace::kInside);
    See(kFirst, SightingPlace::kOutside, 1);
  }
  EXPECT_EQ(HealthOf(kFirst), CameraHealth::kContradicts);
  EXPECT_EQ(HealthOf(kSecond), CameraHealth::kGood);
}

// The track is between the two.
TEST_F(CameraWatchTest, CameraThatIsTurnedAgainstTheOtherIsLeftOut) {
  for (int i = 0; i < 12; ++i, Step()) {
    SeeTurned(kFirst, -0.02);
    SeeTurned(kSecond, 0.03);
  }
  EXPECT_EQ(HealthOf(kFirst), CameraHealth::kGood);
  EXPECT_EQ(HealthOf(kSecond), CameraHealth::kContradicts);
  EXPECT_NEAR(watch_.state(kSecond).offset_m, 0.05 * kDistance_m, 1e-6);
}

TEST_F(CameraWatchTest, TrackThatIsBesideBothCamerasIsNoFaultOfEither) {
  for (int i = 0; i < 30; ++i, Step()) {
    SeeTurned(kFirst, 0.06);
    SeeTurned(kSecond, 0.05);
  }
  EXPECT_TRUE(watch_.IsUsed(kFirst));
  EXPECT_TRUE(watch_.IsUsed(kSecond));
}

TEST_F(CameraWatchTest, TurnThatLagExplainsIsNoFault) {
  for (int i = 0; i < 30; ++i, Step()) {
    SeeTurned(kFirst, 0, {0.05, 0, 0});
    SeeTurned(kSecond, 0.06, {0.05, 0, 0});
  }
  EXPECT_TRUE(watch_.IsUsed(kSecond));
}

TEST_F(CameraWatchTest, TurnedCameraStaysLeftOutWhereSingleSightingsAreInside) {
  for (int i = 0; i < 60; ++i, Step()) {
    SeeTurned(kFirst, 0);
    SeeTurned(kSecond, 0.05);
  }
  EXPECT_EQ(HealthOf(kSecond), CameraHealth::kContradicts);
  EXPECT_LT(watch_.state(kSecond).since, TimeFromNanoseconds(2'500'000'000));
}

}  // namespace
}  // namespace kestrel
