// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <memory>
#include <numbers>

#include <Eigen/Geometry>

#include "kestrel/core/camera/camera_model.h"
#include "kestrel/simulation/rendering/lens.h"
#include "kestrel/simulation/scene/landing_drawings.h"
#include "kestrel/simulation/scene/paint.h"
#include "kestrel/simulation/scene/solids.h"
#include "kestrel/simulation/scene/world.h"

namespace kestrel {

// An even gray ground in even light, with nothing on it.
inline World PlainWorld(double reflectance) {
  World world;
  world.ground.map = std::make_shared<Texture>(cv::Mat(1, 1, CV_8UC3, CodesOf(Gray(reflectance))),
                                               1, Texture::Beyond::kMirror);
  world.ground.detail =
      std::make_shared<Texture>(cv::Mat(1, 1, CV_8UC1, cv::Scalar(CodeOfReflectance(kDetailMean))),
                                1, Texture::Beyond::kRepeat);
  world.light.direct = 0;
  return world;
}

// Adds a white plate with 'ink' in its middle, 'height_m' above the origin.
inline void AddInkPlate(const Drawing& ink, double size_m, double height_m, World* world) {
  SquarePaint paint(1024, size_m, Gray(0.8));
  paint.Draw(ink, Gray(0.05));
  AddPlate(0, {0, 0, height_m}, size_m / 2, size_m / 2, 0, paint.ToTexture(1), world).casts_shadow =
      false;
}

// The paper's fisheye camera with fewer pixels.
inline CameraIntrinsics SmallFisheye() {
  return {.width_px = 240,
          .height_px = 160,
          .fx_px = 84,
          .fy_px = 84,
          .cx_px = 119.5,
          .cy_px = 79.5,
          .distortion_model = DistortionModel::kEquidistant,
          .distortion = {-0.0448, 0.0686053, -0.072277, 0.027011955}};
}

// A camera that looks straight down; the top of its image points to world x.
inline RigidTransform LookingDown(const Eigen::Vector3d& place) {
  Eigen::Matrix3d axes;
  axes << 0, -1, 0, -1, 0, 0, 0, 0, -1;
  return {Eigen::Quaterniond(axes), place};
}

}  // namespace kestrel
