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

// Paint on the plane, over all that was painted before.
struct PaintLayer {
  Drawing shape;
  double reflectance = 0.5;  // 0 to 1
  double texture = 0;        // relative variation of the reflectance, 0 to 1 (dirt, wear)
};

// Takes light from the plane.
struct Shadow {
  Drawing shape;
  double transmission = 0.4;  // part of the light that is left inside, 0 to 1
  double penumbra_m = 0;      // width of the edge's ramp; 0 is as hard as the pixels allow
};

// Mirror-like reflection of the sun on the plane: light that is added, brightest at its centre and
// Gaussian around it. It washes out what is below and saturates when strong.
struct Glare {
  Eigen::Vector2d center;
  double sigma_m = 0.2;
  double strength = 1;  // at the centre, in units of white
};

// Everything lies on the plane z = 0 of the pattern's frame P, but for a sheet that is not flat,
// and is seen from above (z > 0); what is in front of the lens belongs to the camera.
struct Scene {
  double ground_reflectance = 0.25;  // 0 to 1
  double ground_texture = 0.3;       // relative variation, 0 to 1
  double sky_radiance = 0.9;         // above the horizon, in units of white, >= 0
  std::uint64_t texture_seed = 1;
  std::vector<PaintLayer> layers;
  std::vector<Shadow> shadows;
  std::vector<Glare> glares;
  Relief relief;  // of the sheet around the origin; seen from flatter than its slopes it is wrong

  // Every violation in words; empty when the scene can be rendered.
  std::vector<std::string> Validate() const;
};

// How light becomes gray values.
struct ImagingOptions {
  double black_level = 5;          // gray value without light, 0 to 255
  double white_level = 200;        // gray value of a white surface in full light, 0 to 255
  double blur_sigma_px = 0.5;      // Gaussian blur of the optics, 0 to 20; 0 is none
  Eigen::Vector2d gradient{0, 0};  // relative change of light over the image's width and height
  double haze = 0;                 // part of the light that the haze replaces, 0 to 1
  double haze_radiance = 0.7;      // radiance of the haze, in units of white, >= 0
  double read_noise = 0;           // standard deviation in gray values, >= 0
  double shot_noise = 0;           // standard deviation in gray values at gray 100, >= 0; it grows
                                   // with the root of the light
  std::uint64_t noise_seed = 1;
  double exposure_s = 0.005;  // >= 0; the pose is that of its middle
  double readout_s = 0;  // >= 0; from the first row's exposure to the last's (rolling shutter), the
                         // pose is that of the middle row
  // Motion of the plane in the camera frame during the exposure, about the camera's centre.
  Eigen::Vector3d velocity_in_camera{0, 0, 0};          // m/s, of the pattern's origin
  Eigen::Vector3d angular_velocity_in_camera{0, 0, 0};  // rad/s, of the pattern about its origin

  std::vector<std::string> Validate() const;
};

// The plane's pose in the camera 'time_s' after the middle of the exposure of the middle row.
RigidTransform PoseAt(const RigidTransform& camera_from_pattern, const ImagingOptions& imaging,
                      double time_s);

// When one of so many rows is exposed, s after the middle one; fractions allowed.
double RowTime(const ImagingOptions& imaging, double row, int rows);

// Renders a plane with paint on it as a camera sees it. A pixel with an edge takes 16 rays (48
// where the plane moves) that each average over their cell of it, so that edges lie within about a
// hundredth of a pixel; a pixel without an edge takes one ray. Immutable and thread-safe; the same
// input gives the same bytes.
class SceneRenderer {
 public:
  // Throws InputError when the lens options are not valid.
  explicit SceneRenderer(const CameraModel& camera, const LensOptions& lens = {})
      : lens_(camera, lens) {}

  // CV_8UC1 of the camera's size. 'camera_from_pattern' must see the plane from above. Throws
  // InputError when scene, pose or imaging are not valid.
  cv::Mat Render(const Scene& scene, const RigidTransform& camera_from_pattern,
                 const ImagingOptions& imaging) const;

  const CameraModel& camera() const { return lens_.camera(); }
  const Lens& lens() const { return lens_; }

 private:
  class PlanePainter;

  cv::Mat PaintRadiance(const Scene& scene, const RigidTransform& camera_from_pattern,
                        const ImagingOptions& imaging) const;
  void PassLens(const ImagingOptions& imaging, cv::Mat* radiance) const;

  Lens lens_;
};

}  // namespace kestrel
