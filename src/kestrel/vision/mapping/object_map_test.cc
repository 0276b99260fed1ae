// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/mapping/object_map.h"

#include <cmath>
#include <cstdint>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kestrel/core/base/error.h"
#include "kestrel/core/base/options.h"
#include "kestrel/vision/mapping/test_map.h"

namespace kestrel {
namespace {

using ::testing::IsEmpty;
using ::testing::SizeIs;

TEST(ObjectMap, ConfirmsObjectAndFusesPosition) {
  ObjectMap map(DefaultObjectModel(), {});
  Random random(1);
  const Eigen::Vector3d truth(3, -2, 0.01);
  for (int i = 0; i < 100; ++i) {
    if (i == 2) {
      EXPECT_THAT(map.Confirmed(), IsEmpty());
    }
    map.Update(At(0.1 * i), std::vector{MeasureNoisily(truth, kRed, 0.2, &random)}, SeesAll());
  }
  const auto objects = map.Confirmed();
  ASSERT_THAT(objects, SizeIs(1));
  EXPECT_LT((objects[0].position() - truth).norm(), 0.08);
  EXPECT_LT(objects[0].sigma_m(), 0.04);
  EXPECT_EQ(objects[0].detections, 100);
  EXPECT_EQ(objects[0].velocity().norm(), 0);
}

TEST(ObjectMap, DistinguishesNeighboursJointly) {
  ObjectMap map(DefaultObjectModel(), {});
  Random random(2);
  // Nearer to each other than detections scatter: assignment to the nearest object would confuse
  // them.
  for (int i = 0; i < 60; ++i) {
    map.Update(At(0.1 * i),
               std::vector{MeasureNoisily({0, 0, 0}, kRed, 0.1, &random),
                           MeasureNoisily({0.4, 0, 0}, kRed, 0.1, &random)},
               SeesAll());
  }
  const auto objects = map.Confirmed();
  ASSERT_THAT(objects, SizeIs(2));
  EXPECT_NEAR(std::abs(objects[0].position().x() - objects[1].position().x()), 0.4, 0.08);
}

TEST(ObjectMap, OtherColoursAreOtherObjects) {
  ObjectMap map(DefaultObjectModel(), {});
  for (int i = 0; i < 5; ++i) {
    map.Update(At(i), std::vector{MeasureDisc({0, 0, 0}, kRed), MeasureDisc({0.05, 0, 0}, kYellow)},
               SeesAll());
  }
  EXPECT_THAT(map.Confirmed(), SizeIs(2));
}

TEST(ObjectMap, EstimatesVelocityOfMovingObject) {
  ObjectMap map(DefaultObjectModel(), {});
  Random random(3);
  const Eigen::Vector3d velocity(0.5, -0.3, 0);
  for (int i = 0; i < 100; ++i) {
    const double t = 0.1 * i;
    map.Update(At(t), std::vector{MeasureNoisily(t * velocity, kYellow, 0.05, &random)}, SeesAll());
  }
  const auto objects = map.Confirmed();
  ASSERT_THAT(objects, SizeIs(1));
  EXPECT_LT((objects[0].velocity() - velocity).norm(), 0.15);
}

TEST(ObjectMap, AccountsForRowTimesOfRollingShutter) {
  ObjectMap map(DefaultObjectModel(), {});
  Random random(7);
  const Eigen::Vector3d velocity(1, 0.5, 0);
  // The disc passes through the image from the first row to the last, so that the delay grows.
  constexpr double kReadout_s = 0.1;
  for (int i = 0; i <= 20; ++i) {
    const double t = 0.1 * i;
    const double delay_s = kReadout_s * (t / 2 - 0.5);
    ObjectMeasurement measurement =
        MeasureNoisily((t + delay_s) * velocity, kYellow, 0.002, &random);
    measurement.delay_s = delay_s;
    map.Update(At(t), std::vector{measurement}, SeesAll());
  }
  const auto objects = map.Confirmed();
  ASSERT_THAT(objects, SizeIs(1));
  EXPECT_LT((objects[0].position() - 2 * velocity).norm(), 0.01) << "else 0.05 on";
  EXPECT_LT((objects[0].velocity() - velocity).norm(), 0.02) << "else 0.03 faster";
}

TEST(ObjectMap, VelocityFollowsCurves) {
  constexpr int kSeeds = 20;
  double squares = 0;
  for (int seed = 0; seed < kSeeds; ++seed) {
    ObjectMap map(DefaultObjectModel(), {});
    Random random(static_cast<std::uint64_t>(seed));
    // To and fro at up to 0.7 m/s, with accelerations of up to 0.4 m/s^2.
    const double rate = random.Uniform(0.4, 0.6);
    const double phase = random.Uniform(0, 6);
    const auto along = [&](double t) { return 0.7 / rate * std::sin(rate * t + phase); };
    constexpr double kEnd_s = 3;
    for (int i = 0; i <= 30; ++i) {
      const Eigen::Vector3d position(along(0.1 * i), 0.5 * along(0.1 * i + 2), 0);
      map.Update(At(0.1 * i), std::vector{MeasureNoisily(position, kYellow, 0.02, &random)},
                 SeesAll());
    }
    const auto speed = [&](double t) { return 0.7 * std::cos(rate * t + phase); };
    const Eigen::Vector3d truth(speed(kEnd_s), 0.5 * speed(kEnd_s + 2), 0);
    ASSERT_THAT(map.Confirmed(), SizeIs(1));
    squares += (map.Confirmed()[0].velocity() - truth).squaredNorm();
  }
  EXPECT_LT(std::sqrt(squares / kSeeds), 0.1);
}

TEST(ObjectMap, StateStaysFiniteForAnHour) {
  ObjectMap map(DefaultObjectModel(), {});
  map.Update(At(0), std::vector{MeasureDisc({0, 0, 0}, kYellow)}, SeesNothing());
  MappedObject object = map.objects()[0];
  PredictObject(At(3600), ObjectMapOptions{}.motion(), &object);
  EXPECT_TRUE(object.covariance.allFinite());
  EXPECT_LT(object.sigma_m(), 1000) << "far less than at the speed that it may have";
}

TEST(ObjectMap, RemovedObjectFadesAndObjectOutOfViewStays) {
  ObjectMap map(DefaultObjectModel(), {});
  for (int i = 0; i < 20; ++i) {
    map.Update(At(0.1 * i), std::vector{MeasureDisc({0, 0, 0}, kRed)}, SeesAll());
  }
  for (int i = 20; i < 100; ++i) map.Update(At(0.1 * i), {}, SeesNothing());
  EXPECT_THAT(map.Confirmed(), SizeIs(1));
  for (int i = 100; i < 103; ++i) map.Update(At(0.1 * i), {}, SeesAll());
  EXPECT_THAT(map.Confirmed(), SizeIs(1)) << "missed for a moment";
  for (int i = 103; i < 130; ++i) map.Update(At(0.1 * i), {}, SeesAll());
  EXPECT_THAT(map.objects(), IsEmpty());
}

TEST(ObjectMap, LimitsMemory) {
  ObjectMapOptions options;
  options.capacity = 20;
  ObjectMap map(DefaultObjectModel(), options);
  for (int i = 0; i < 100; ++i) {
    map.Update(At(i), std::vector{MeasureDisc({5.0 * i, 0, 0}, kRed)}, SeesNothing());
  }
  EXPECT_THAT(map.objects(), SizeIs(20));
}

TEST(ObjectMap, IgnoresInvalidAndOldMeasurements) {
  ObjectMap map(DefaultObjectModel(), {});
  ObjectMeasurement nonsense = MeasureDisc({0, 0, 0}, kRed);
  nonsense.position.x() = std::numeric_limits<double>::quiet_NaN();
  ObjectMeasurement no_covariance = MeasureDisc({0, 0, 0}, kRed);
  no_covariance.covariance.setZero();
  map.Update(At(2), std::vector{nonsense, no_covariance}, SeesAll());
  EXPECT_THAT(map.objects(), IsEmpty());
  map.Update(At(1), std::vector{MeasureDisc({0, 0, 0}, kRed)}, SeesAll());
  EXPECT_THAT(map.objects(), IsEmpty());
}

TEST(ObjectMap, DigitIsMostLikelyOfAllDetections) {
  ObjectMap map(DefaultObjectModel(), {});
  for (int i = 0; i < 5; ++i) {
    ObjectMeasurement measurement = MeasureDisc({0, 0, 0}, kRed);
    measurement.shape = ObjectShape::kCuboid;
    measurement.digits.emplace();
    measurement.digits->fill(0.05);
    (*measurement.digits)[i == 2 ? 3 : 7] = 0.55;
    map.Update(At(i), std::vector{measurement}, SeesAll());
  }
  ASSERT_THAT(map.Confirmed(), SizeIs(1));
  EXPECT_EQ(ScoreOf(map.Confirmed()[0], DefaultObjectModel()), 7);
}

TEST(ObjectMapOptions, ReportsViolations) {
  ObjectMapOptions options;
  options.capacity = 0;
  options.moving_probability = 0.4;
  EXPECT_THAT(ViolationsOf(options), SizeIs(2));
  EXPECT_THROW(ObjectMap(DefaultObjectModel(), options), InputError);
}

}  // namespace
}  // namespace kestrel
