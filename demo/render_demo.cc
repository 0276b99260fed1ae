// SPDX-License-Identifier: BSD-3-Clause
// Renders the demo's recording: a vehicle with the landing pattern on its roof drives along a road
// into the shade, and a UAV with the paper's fisheye camera follows it down from 9 m to 1 m.
#include <cmath>
#include <cstdlib>
#include <exception>
#include <numbers>
#include <string>
#include <vector>

#include <Eigen/Geometry>
#include <fmt/format.h>
#include <fmt/ostream.h>
#include <opencv2/imgcodecs.hpp>

#include "kestrel/base/error.h"
#include "kestrel/base/time.h"
#include "kestrel/recording/output_folder.h"
#include "kestrel/simulation/landing_drawings.h"
#include "kestrel/simulation/landing_stills.h"
#include "kestrel/simulation/scene_renderer.h"

namespace kestrel {
namespace {

using Eigen::AngleAxisd;
using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr int kFrames = 50;
constexpr int kRate_hz = 10;
constexpr double kEnd_s = static_cast<double>(kFrames - 1) / kRate_hz;
constexpr double kVehicleYaw = 0.3;

Vector2d Along(double angle) { return {std::cos(angle), std::sin(angle)}; }

// The plane of the pattern is z = 0 of the world.
Vector2d VehicleAt(double t_s) { return 2.0 * t_s * Along(kVehicleYaw); }

RigidTransform WorldFromBody(double t_s) {
  const double to_go = 1 - t_s / kEnd_s;
  const Vector2d beside = -4 * to_go * Along(kVehicleYaw) + 0.3 * Along(1.3 * t_s);
  const Vector2d place = VehicleAt(t_s) + beside;
  const Eigen::Quaterniond attitude = AngleAxisd(0.2 + 0.1 * t_s, Vector3d::UnitZ()) *
                                      AngleAxisd(0.12 * std::sin(2 * t_s), Vector3d::UnitY()) *
                                      AngleAxisd(0.08 * std::cos(3 * t_s), Vector3d::UnitX());
  return {attitude, {place.x(), place.y(), 1 + 8 * to_go}};
}

// The camera looks down; the upper side of its image is forward.
RigidTransform BodyFromCamera() {
  Eigen::Matrix3d axes;
  axes.col(0) = -Vector3d::UnitY();
  axes.col(1) = -Vector3d::UnitX();
  axes.col(2) = -Vector3d::UnitZ();
  return {Eigen::Quaterniond(axes), {0.1, 0, -0.05}};
}

Drawing Rectangle(const Vector2d& center, double length, double width) {
  return Drawing().Add(Drawing::Bar{center, Along(kVehicleYaw), length / 2, width / 2});
}

Scene SceneAt(double t_s) {
  const LandingPattern pattern;
  const Vector2d vehicle = VehicleAt(t_s);
  const Vector2d left = Along(kVehicleYaw + std::numbers::pi / 2);
  Scene scene;
  scene.ground_reflectance = 0.32;
  scene.layers.push_back({Rectangle(2.5 * left, 100, 0.15), 0.8, 0.1});
  scene.layers.push_back({Rectangle(-2.5 * left, 100, 0.15), 0.8, 0.1});
  scene.layers.push_back({Rectangle(vehicle, 4.2, 1.8), 0.45, 0.05});
  scene.layers.push_back({SquareBoard(vehicle, pattern.board_size_m, kVehicleYaw), 0.85, 0.05});
  scene.layers.push_back({LandingPatternInk(pattern, vehicle, kVehicleYaw), 0.06, 0.1});
  scene.shadows.push_back({Rectangle(VehicleAt(kEnd_s), 5, 100), 0.5});
  return scene;
}

std::string Nanoseconds(double t_s) {
  return fmt::format("{}", DurationFromSeconds(100 + t_s).count());
}

void WriteImages(const SceneRenderer& renderer, const OutputFolder& folder) {
  std::ofstream rows = folder.OpenText("mav0/cam0/data.csv");
  rows << "#timestamp [ns],filename\n";
  for (int i = 0; i < kFrames; ++i) {
    const double t_s = static_cast<double>(i) / kRate_hz;
    const RigidTransform camera_from_world = (WorldFromBody(t_s) * BodyFromCamera()).Inverse();
    ImagingOptions imaging;
    imaging.white_level = 240;
    imaging.read_noise = 2;
    imaging.noise_seed = i;
    const std::string name = Nanoseconds(t_s) + ".png";
    const std::string file = folder.NewFile("mav0/cam0/data/" + name);
    if (!cv::imwrite(file, renderer.Render(SceneAt(t_s), camera_from_world, imaging))) {
      throw InputError(file + ": cannot be written");
    }
    fmt::print(rows, "{},{}\n", Nanoseconds(t_s), name);
  }
}

void WritePoses(const OutputFolder& folder) {
  constexpr int kPosesPerFrame = 5;
  std::ofstream rows = folder.OpenText("mav0/nav0/data.csv");
  rows << "#timestamp [ns],p_WB_W_x [m],p_WB_W_y [m],p_WB_W_z [m],q_WB_w [],q_WB_x [],q_WB_y [],"
          "q_WB_z []\n";
  for (int i = 0; i < kPosesPerFrame * kFrames; ++i) {
    const double t_s = static_cast<double>(i) / (kPosesPerFrame * kRate_hz);
    const RigidTransform pose = WorldFromBody(t_s);
    const Vector3d& p = pose.translation;
    const Eigen::Quaterniond& q = pose.rotation;
    fmt::print(rows, "{},{:.6f},{:.6f},{:.6f},{:.9f},{:.9f},{:.9f},{:.9f}\n", Nanoseconds(t_s),
               p.x(), p.y(), p.z(), q.w(), q.x(), q.y(), q.z());
  }
}

void WriteCalibration(const CameraIntrinsics& camera, const OutputFolder& folder) {
  const Eigen::Affine3d mount =
      Eigen::Translation3d(BodyFromCamera().translation) * BodyFromCamera().rotation;
  const Eigen::Matrix4d rows_of_mount = mount.matrix().transpose();  // Eigen stores columns
  std::ofstream file = folder.OpenText("mav0/cam0/sensor.yaml");
  fmt::print(file, "sensor_type: camera\nrate_hz: {}\nresolution: [{}, {}]\n", kRate_hz,
             camera.width_px, camera.height_px);
  fmt::print(file, "camera_model: pinhole\nintrinsics: [{}, {}, {}, {}]\n", camera.fx_px,
             camera.fy_px, camera.cx_px, camera.cy_px);
  fmt::print(file, "distortion_model: equidistant\ndistortion_coefficients: [{}]\n",
             fmt::join(camera.distortion, ", "));
  fmt::print(file, "T_BS:\n  cols: 4\n  rows: 4\n  data: [{}]\n",
             fmt::join(rows_of_mount.reshaped(), ", "));
}

void RenderDemo(const std::string& path) {
  const OutputFolder folder(path, /*replace_files=*/true);
  const CameraIntrinsics camera = PaperCamera();
  LensOptions lens;
  lens.half_angle_deg = 85;
  WriteCalibration(camera, folder);
  WritePoses(folder);
  WriteImages(SceneRenderer(CameraModel(camera), lens), folder);
}

}  // namespace
}  // namespace kestrel

int main(int argc, char** argv) {
  if (argc != 2) {
    fmt::print(stderr, "usage: render_demo FOLDER\n");
    return EXIT_FAILURE;
  }
  try {
    kestrel::RenderDemo(argv[1]);
  } catch (const std::exception& error) {
    fmt::print(stderr, "render_demo: {}\n", error.what());
    return EXIT_FAILURE;
  }
}
