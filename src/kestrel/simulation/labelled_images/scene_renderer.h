// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include "kestrel/core/camera/camera_model.h"
#include "kestrel/core/geometry/rigid_transform.h"
#include "kestrel/simulation/labelled_images/relief.h"
#include "kestrel/simulation/rendering/lens.h"
#include "kestrel/simulation/scene/drawing.h"

namespace kestrel {

// Paint on the plane, on top of the earlier layers.
struct PaintLayer {
  Drawing shape;
  double reflectance = 0.5;  // 0 to 1
  double texture = 0;        // relative variation of the reflectance, 0 to 1 (dirt, wear)
};

// Shadow on the plane.
struct Shadow {
  Drawing shape;
  double transmission = 0.4;  // part of the light that remains inside, 0 to 1
  double penumbra_m = 0;      // width of the edge's ramp; 0: as sharp as the pixels allow
};

// Mirror-like reflection of the sun on the plane: added light with a Gaussian profile. It washes
// out the paint and saturates when strong.
struct Glare {
  Eigen::Vector2d center;
  double sigma_m = 0.2;
  double strength = 1;  // at the centre, in units of white
};

// Everything lies on the plane z = 0 of the pattern's frame P, except a sheet that is not flat, and
// is seen from above (z > 0). Things in front of the lens belong to the camera.
struct Scene {
  double ground_reflectance = 0.25;  // 0 to 1
  double ground_texture = 0.3;       // relative variation, 0 to 1
  double sky_radiance = 0.9;         // above the horizon, in units of white, >= 0
  std::uint64_t texture_seed = 1;
  std::vector<PaintLayer> layers;
  std::vector<Shadow> shadows;
  std::vector<Glare> glares;
  Relief relief;  // relief of the sheet around the origin; wrong in views flatter than its slopes

  // Returns every violation in words; empty when the scene can be rendered.
  std::vector<std::string> Validate() const;
};

// Conversion of light to gray values.
struct ImagingOptions {
  double black_level = 5;          // gray value without light, 0 to 255
  double white_level = 200;        // gray value of a white surface in full light, 0 to 255
  double blur_sigma_px = 0.5;      // Gaussian blur of the optics, 0 to 20; 0 is none
  Eigen::Vector2d gradient{0, 0};  // relative change of light over the image's width and height
  double haze = 0;                 // part of the light that the haze replaces, 0 to 1
  double haze_radiance = 0.7;      // radiance of the haze, in units of white, >= 0
  double read_noise = 0;           // standard deviation in gray values, >= 0
  double shot_noise = 0;           // standard deviation in gray values at gray 100, >= 0;
                                   // proportional to the root of the light
  std::uint64_t noise_seed = 1;
  double exposure_s = 0.005;  // >= 0; the pose is that of the middle of the exposure
  double readout_s = 0;  // >= 0; from the exposure of the first row to that of the last (rolling
                         // shutter); the pose is that of the middle row
  // Motion of the plane in the camera frame during the exposure, about the camera's centre.
  Eigen::Vector3d velocity_in_camera{0, 0, 0};          // m/s, of the pattern's origin
  Eigen::Vector3d angular_velocity_in_camera{0, 0, 0};  // rad/s, of the pattern about its origin

  std::vector<std::string> Validate() const;
};

// Returns the plane's pose in the camera 'time_s' after the middle of the exposure of the middle
// row.
RigidTransform PoseAt(const RigidTransform& camera_from_target, const ImagingOptions& imaging,
                      double time_s);

// Returns the time of the exposure of 'row' of 'rows', s after the middle one; fractions allowed.
double RowTime(const ImagingOptions& imaging, double row, int rows);

// Renders a painted plane seen by a camera. A pixel with an edge takes 16 rays (48 if the plane
// moves), each of which averages over its cell, so that edges are placed within about a hundredth
// of a pixel; a pixel without an edge takes one ray. Immutable and thread-safe; the same input
// gives the same bytes.
class SceneRenderer {
 public:
  // Throws InputError when the lens options are not valid.
  explicit SceneRenderer(const CameraModel& camera, const LensOptions& lens = {})
      : lens_(camera, lens) {}

  // Returns CV_8UC1 of the camera's size. 'camera_from_target' must see the plane from above.
  // Throws InputError when scene, pose or imaging are not valid.
  cv::Mat Render(const Scene& scene, const RigidTransform& camera_from_target,
                 const ImagingOptions& imaging) const;

  const CameraModel& camera() const { return lens_.camera(); }
  const Lens& lens() const { return lens_; }

 private:
  class PlanePainter;

  cv::Mat PaintRadiance(const Scene& scene, const RigidTransform& camera_from_target,
                        const ImagingOptions& imaging) const;
  void PassLens(const ImagingOptions& imaging, cv::Mat* radiance) const;

  Lens lens_;
};

}  // namespace kestrel
