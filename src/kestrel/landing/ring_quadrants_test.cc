// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/landing/ring_quadrants.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/LU>
#include <gtest/gtest.h>

#include "kestrel/landing/test_prints.h"

namespace kestrel {
namespace {

class FindQuadrantRingsTest : public ::testing::Test {
 protected:
  FindQuadrantRingsTest() {
    image_from_plane_ << 34, 10, -4, 15;
    workspace_.Reserve();
  }
  // Looks at a print, dark in a plane (metres), in the affine view.
  void Find(const Print& is_dark) {
    const Eigen::Matrix2d plane_from_image = image_from_plane_.inverse();
    const auto in_image = [&](double u, double v) {
      const Eigen::Vector2d place = plane_from_image * (Eigen::Vector2d(u, v) - center_);
      return is_dark(place.x(), place.y());
    };
    FindQuadrantRings(TraceFigure(in_image, 100, 100), pattern_, &workspace_);
  }
  // How far, px, the nearest ring that was found is from the true one, over its outer edge.
  double NearestRing() const {
    double nearest = 1e9;
    for (const Ellipse& ring : workspace_.rings) {
      double worst = 0;
      for (int i = 0; i < 36; ++i) {
        const Eigen::Vector2d at = ring.At(i * std::numbers::pi / 18);
        const Eigen::Vector2d place = image_from_plane_.inverse() * (at - center_);
        const Eigen::Vector2d on_ring = pattern_.outer_radius_m() * place.normalized();
        worst = std::max(worst, (image_from_plane_ * (place - on_ring)).norm());
      }
      nearest = std::min(nearest, worst);
    }
    return nearest;
  }
  // The print with arms that touch the ring, on ground as dark as itself.
  bool OnDarkGround(double x, double y) const {
    return IsSpoke(x, y, 4, 0.5 * pattern_.arm_width_m, 1) ||
           std::hypot(x, y) > pattern_.inner_radius_m();
  }

  const LandingPattern pattern_;
  const Eigen::Vector2d center_{47.3, 52.1};
  Eigen::Matrix2d image_from_plane_;
  RingQuadrantsWorkspace workspace_;
};

TEST_F(FindQuadrantRingsTest, FindsARingThatHasGrownTogetherWithTheGround) {
  Find([&](double x, double y) { return OnDarkGround(x, y); });
  EXPECT_LT(NearestRing(), 1);
}

TEST_F(FindQuadrantRingsTest, ThreeQuadrantsAreEnoughTwoAreNot) {
  Find([&](double x, double y) { return OnDarkGround(x, y) || (x > 0 && y > 0); });
  EXPECT_LT(NearestRing(), 1);
  Find([&](double x, double y) { return OnDarkGround(x, y) || x > 0; });
  EXPECT_TRUE(workspace_.rings.empty());
}

TEST_F(FindQuadrantRingsTest, WhiteAreasOfOtherSizesAreNoQuadrants) {
  // As far apart as quadrants, but a third as wide.
  Find([&](double x, double y) { return std::hypot(std::abs(x) - 0.2, std::abs(y) - 0.2) > 0.06; });
  EXPECT_TRUE(workspace_.rings.empty());
}

TEST_F(FindQuadrantRingsTest, AFullImageKeepsToTheRoomThereIs) {
  const std::size_t room = workspace_.rings.capacity();
  // A grid: any four cells around a corner look like quadrants.
  Find([&](double x, double y) {
    const auto line = [](double value) { return std::abs(std::remainder(value, 0.35)) < 0.05; };
    return line(x) || line(y);
  });
  EXPECT_GT(workspace_.rings.size(), 10u);
  EXPECT_EQ(workspace_.rings.capacity(), room);
}

}  // namespace
}  // namespace kestrel
