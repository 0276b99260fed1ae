// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/onboard/pad_motion_watch.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <functional>
#include <optional>

#include <gtest/gtest.h>

#include "kestrel/core/base/random.h"

namespace kestrel {
namespace {

using Eigen::Vector3d;

// A UAV that sways by 1 m over a pad, with 50 noisy accelerations and 20 noisy places a second.
class PadMotionWatchTest : public testing::Test {
 protected:
  // 'pad_m': the pad's place along x, of the time. Returns when the motion was noticed, s.
  std::optional<double> Fly(double seconds, const std::function<double(double)>& pad_m,
                            const Vector3d& bias = {0.3, -0.2, 0}) {
    constexpr double kSway = 0.8;  // rad/s
    PadMotionWatch watch;
    const Time begin = TimeFromNanoseconds(1'000'000'000);
    for (int i = 0; i < 100 * seconds; ++i) {
      const double t = 0.01 * i;
      const Time time = begin + DurationFromSeconds(t);
      const Vector3d place(std::sin(kSway * t), std::cos(1.1 * t), 3);
      const Vector3d acceleration(-kSway * kSway * place.x(), -1.21 * place.y(), 0);
      if (i % 2 == 0) {
        watch.AddAcceleration(time, acceleration + bias + Noise(0.7));
      }
      if (i % 5 != 0) continue;
      if (watch.Update(time, place - Vector3d(pad_m(t), 0, 0) + Noise(0.02))) return t;
    }
    return std::nullopt;
  }

 private:
  Vector3d Noise(double sigma) {
    return sigma * Vector3d(random_.Normal(), random_.Normal(), random_.Normal());
  }

  Random random_{5};
};

TEST_F(PadMotionWatchTest, PadThatStandsIsTaken) {
  EXPECT_EQ(Fly(600, [](double) { return 0.0; }), std::nullopt);
}

TEST_F(PadMotionWatchTest, NoticesPadThatBeginsToMove) {
  constexpr double kBegin_s = 20;
  for (const double speed_mps : {1.0, 2.0}) {
    // It takes a second to its speed.
    const auto noticed = Fly(40, [&](double t) {
      const double since = std::max(t - kBegin_s, 0.0);
      return since < 1 ? 0.5 * speed_mps * since * since : speed_mps * (since - 0.5);
    });
    ASSERT_TRUE(noticed) << speed_mps;
    EXPECT_GT(*noticed, kBegin_s);
    EXPECT_LT(*noticed, kBegin_s + 2) << speed_mps;
  }
}

TEST_F(PadMotionWatchTest, ErrorOfTiltIsLearnt) {
  EXPECT_EQ(Fly(120, [](double) { return 0.0; }, {0.45, 0, 0}), std::nullopt);
}

}  // namespace
}  // namespace kestrel
