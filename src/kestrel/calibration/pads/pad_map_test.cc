// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/calibration/pads/pad_map.h"

#include <cmath>

#include <gtest/gtest.h>

#include "kestrel/core/base/error.h"
#include "kestrel/core/base/random.h"
#include "kestrel/core/geometry/angles.h"

namespace kestrel {
namespace {

using Eigen::Vector3d;

struct TruePad {
  double x, y, yaw_deg;
};
// Four pads along a corridor: no image shows the first beside the last.
constexpr TruePad kPads[] = {{0, 0, 0}, {1.5, 0.2, 30}, {3, -0.3, -100}, {4.6, 0.1, 170}};
constexpr double kSize_m = 0.3, kFocalPx = 400, kReach_m = 1.5;

RigidTransform MapFromPad(const TruePad& pad) {
  return {Eigen::Quaterniond(Eigen::AngleAxisd(Radians(pad.yaw_deg), Vector3d::UnitZ())),
          {pad.x, pad.y, 0}};
}

// A flight along them, whose images show the pads within reach, with errors of pose as of a pad of
// that size.
std::vector<std::vector<PadSighting>> Flight(Random* random, int images) {
  std::vector<std::vector<PadSighting>> all;
  for (int i = 0; i < images; ++i) {
    const Vector3d place(random->Uniform(-0.5, 5), random->Uniform(-0.6, 0.6),
                         random->Uniform(1.5, 2.5));
    const Vector3d lean = Radians(6) * Vector3d(random->Normal(), random->Normal(), 0);
    const Eigen::Quaterniond down(Eigen::AngleAxisd(M_PI, Vector3d::UnitX()));
    const RigidTransform map_from_camera{
        Eigen::AngleAxisd(random->Uniform(-3, 3), Vector3d::UnitZ()) * RotationBy(lean) * down,
        place};
    std::vector<PadSighting>& image = all.emplace_back();
    for (std::size_t pad = 0; pad < std::size(kPads); ++pad) {
      if ((Eigen::Vector2d(kPads[pad].x, kPads[pad].y) - place.head<2>()).norm() > kReach_m) {
        continue;
      }
      const RigidTransform exact = map_from_camera.Inverse() * MapFromPad(kPads[pad]);
      const double across_m = 0.1 / kFocalPx * exact.translation.norm();
      const Vector3d move =
          across_m * Vector3d(random->Normal(), random->Normal(), 5 * random->Normal());
      const Vector3d turn = Radians(1) * Vector3d(random->Normal(), random->Normal(), 0);
      image.push_back({pad, Moved(exact, move, turn)});
    }
  }
  return all;
}

PadMap MapOf(const std::vector<std::vector<PadSighting>>& images) {
  const std::vector<double> sizes(std::size(kPads), kSize_m);
  return EstimatePadMap(images, sizes, kFocalPx);
}

TEST(PadMapTest, ChainOfPadsHasItsPlaces) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    Random random(seed);
    const PadMap map = MapOf(Flight(&random, 300));
    for (std::size_t pad = 0; pad < std::size(kPads); ++pad) {
      ASSERT_TRUE(map.places[pad]);
      const PadPlace& place = *map.places[pad];
      const Eigen::Vector2d truth(kPads[pad].x, kPads[pad].y);
      EXPECT_LT((place.position - truth).norm(), 0.02) << pad;
      EXPECT_NEAR(Degrees(std::remainder(place.yaw - Radians(kPads[pad].yaw_deg), 2 * M_PI)), 0,
                  0.5)
          << pad;
    }
  }
}

TEST(PadMapTest, PoseOfAnotherPadCountsLittle) {
  Random random(3);
  std::vector<std::vector<PadSighting>> images = Flight(&random, 300);
  for (std::size_t i = 0; i < images.size(); i += 20) {
    if (!images[i].empty()) images[i][0].camera_from_pad.translation.x() += 0.5;
  }
  const PadMap map = MapOf(images);
  EXPECT_LT((map.places[3]->position - Eigen::Vector2d(4.6, 0.1)).norm(), 0.03);
}

TEST(PadMapTest, PadThatIsSeenAloneHasNoPlace) {
  Random random(3);
  std::vector<std::vector<PadSighting>> images = Flight(&random, 100);
  for (std::vector<PadSighting>& image : images) {
    std::erase_if(image, [](const PadSighting& seen) { return seen.pad == 2; });
  }
  images.push_back({{2, {Eigen::Quaterniond::Identity(), {0, 0, 2}}}});
  const PadMap map = MapOf(images);
  EXPECT_TRUE(map.places[1]);
  EXPECT_FALSE(map.places[2]);
  EXPECT_FALSE(map.places[3]);
}

TEST(PadMapTest, FirstPadMustBeSeenBesideAnother) {
  const std::vector<std::vector<PadSighting>> images = {
      {{0, {Eigen::Quaterniond::Identity(), {0, 0, 2}}}}};
  EXPECT_THROW(MapOf(images), InputError);
}

}  // namespace
}  // namespace kestrel
