// SPDX-License-Identifier: BSD-3-Clause
// Tests ExposureController with a simulated camera.
#include <deque>
#include <vector>

#include <gtest/gtest.h>
#include <opencv2/core.hpp>

#include "kestrel/core/camera/exposure_controller.h"
#include "kestrel/simulation/rendering/flight_camera.h"
#include "kestrel/simulation/rendering/test_worlds.h"

namespace kestrel {
namespace {

constexpr double kExposure_s = 0.001;  // exposure at which white in full light has gray 235

// A camera 2 m above a pattern that applies a new exposure two images late.
class Loop {
 public:
  Loop(double gamma, double exposure_s)
      : world_(PatternWorld()),
        camera_(CameraModel(SmallFisheye()), {.airframe = {}}, {.rays_per_pixel = 2},
                {.gamma = gamma}, world_,
                [](double) {
                  return LookingDown({0, 0, 2});
                }),
        controller_({.gamma = gamma}, exposure_s),
        exposures_s_(3, exposure_s) {}

  // Returns for each image the gray value that a fiftieth of the board's white exceeds.
  std::vector<int> Run(double light, int images) {
    std::vector<int> grays;
    for (int i = 0; i < images; ++i, ++taken_) {
      const double gain = light * exposures_s_.front() / kExposure_s;
      exposures_s_.pop_front();
      const cv::Mat image = camera_.Capture(taken_, gain, taken_);
      exposures_s_.push_back(controller_.Update(image, kArea));
      cv::Mat sorted;
      cv::sort(image(kArea).clone().reshape(1, 1), sorted, cv::SORT_DESCENDING);
      grays.push_back(sorted.at<std::uint8_t>(static_cast<int>(sorted.total()) / 10));
    }
    return grays;
  }

 private:
  static World PatternWorld() {
    World world = PlainWorld(0.3);
    AddInkPlate(LandingPatternInk({}), 1.5, 0, &world);
    return world;
  }

  inline static const cv::Rect kArea{98, 58, 44, 44};  // around the ring
  World world_;
  FlightCamera camera_;
  ExposureController controller_;
  std::deque<double> exposures_s_;
  int taken_ = 0;
};

// From image 'settled' on, all gray values are as wanted.
void ExpectSettles(const std::vector<int>& grays, std::size_t settled, double light) {
  for (std::size_t i = settled; i < grays.size(); ++i) {
    EXPECT_GE(grays[i], 198) << "image " << i << ", light " << light;
    EXPECT_LE(grays[i], 242) << "image " << i << ", light " << light;
  }
}

TEST(ExposureLoopTest, KeepsWhiteOfPatternThroughLightSteps) {
  for (const double gamma : {1.0, 0.45}) {
    Loop loop(gamma, kExposure_s);
    for (const double light : {1.0, 50.0, 1.0, 0.3}) {
      ExpectSettles(loop.Run(light, 30), 16, light);
    }
  }
}

TEST(ExposureLoopTest, RecoversFromSaturatedAndBlackImages) {
  Loop dazzled(1, 0.01);
  const std::vector<int> bright = dazzled.Run(1, 25);
  EXPECT_EQ(bright.front(), 255);
  ExpectSettles(bright, 13, 1);
  Loop blind(1, 2e-5);
  const std::vector<int> dark = blind.Run(1, 25);
  EXPECT_LT(dark.front(), 12);
  ExpectSettles(dark, 13, 1);
}

}  // namespace
}  // namespace kestrel
