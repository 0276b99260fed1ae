// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/simulation/scene/solids.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>
#include <opencv2/imgproc.hpp>

#include "kestrel/core/geometry/angles.h"

namespace kestrel {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

using Paint = std::shared_ptr<const Texture>;

// Glass between posts in the colour of the car.
Paint WindowPaint(const Color& color, int panes, int channels) {
  cv::Mat codes(32, 32 * panes, CV_8UC3, CodesOf(color));
  for (int i = 0; i < panes; ++i) {
    cv::rectangle(codes, cv::Rect(32 * i + 3, 4, 26, 22), CodesOf({0.05, 0.045, 0.04}), -1);
  }
  return std::make_shared<Texture>(codes, channels);
}

// Front or back: a bumper and lamps.
Paint FrontPaint(const Color& color, const Color& lamps, int channels) {
  cv::Mat codes(32, 64, CV_8UC3, CodesOf(color));
  cv::rectangle(codes, cv::Rect(0, 20, 64, 12), CodesOf(Gray(0.06)), -1);
  cv::rectangle(codes, cv::Rect(3, 8, 10, 8), CodesOf(lamps), -1);
  cv::rectangle(codes, cv::Rect(51, 8, 10, 8), CodesOf(lamps), -1);
  return std::make_shared<Texture>(codes, channels);
}

// A flank: wheels in their arches.
Paint FlankPaint(const Color& color, int channels) {
  cv::Mat codes(64, 256, CV_8UC3, CodesOf(color));
  cv::rectangle(codes, cv::Rect(0, 44, 256, 20), CodesOf(Gray(0.02)), -1);
  for (const int wheel : {48, 208}) {
    cv::circle(codes, {wheel, 48}, 26, CodesOf(Gray(0.02)), -1, cv::LINE_AA);
    cv::circle(codes, {wheel, 48}, 13, CodesOf(Gray(0.25)), -1, cv::LINE_AA);
  }
  return std::make_shared<Texture>(codes, channels);
}

// The lower half of a vehicle: a box with flanks, front and back.
void AddChassis(int body, const Box& box, const Color& color, World* world) {
  const int channels = world->channels;
  const std::size_t first = world->surfaces.size();
  const Paint top = PlainPaint(color, channels);
  AddBox(body, box, top, FlankPaint(color, channels), world);
  for (std::size_t i = first; i < world->surfaces.size(); ++i) {
    Surface& side = world->surfaces[i];
    const double forward = side.right.cross(side.up).normalized().x();
    if (forward > 0.9) side.paint = FrontPaint(color, Gray(0.7), channels);
    if (forward < -0.9) side.paint = FrontPaint(color, {0.05, 0.05, 0.4}, channels);
  }
}

}  // namespace

void AddBox(int body, const Box& box, const Paint& top, const Paint& side, World* world) {
  AddPlate(body, box.center + Vector3d(0, 0, box.half.z()), box.half.x(), box.half.y(), 0, top,
           world);
  const Vector3d up(0, 0, box.half.z());
  for (int i = 0; i < 4; ++i) {
    const Vector3d out = i < 2 ? Vector3d((i == 0 ? 1 : -1) * box.half.x(), 0, 0)
                               : Vector3d(0, (i == 2 ? 1 : -1) * box.half.y(), 0);
    const double half = i < 2 ? box.half.y() : box.half.x();
    const Vector3d right = half * Vector3d::UnitZ().cross(out.normalized());
    world->surfaces.push_back({.body = body,
                               .center = box.center + out,
                               .right = right,
                               .up = up,
                               .paint = side,
                               .mask = nullptr});
  }
}

Surface& AddPlate(int body, const Vector3d& center, double half_length, double half_width,
                  double yaw, const Paint& paint, World* world) {
  const Vector3d along(std::cos(yaw), std::sin(yaw), 0);
  world->surfaces.push_back({.body = body,
                             .center = center,
                             .right = half_length * along,
                             .up = half_width * Vector3d::UnitZ().cross(along),
                             .paint = paint,
                             .mask = nullptr});
  return world->surfaces.back();
}

double AddCar(int body, const Color& color, Random* random, World* world) {
  const double half_width = random->Uniform(0.85, 0.95);
  const double roof = random->Uniform(1.4, 1.7);
  AddChassis(body, {{0, 0, 0.475}, {2.25, half_width, 0.425}}, color, world);
  const Box cabin{{-0.25, 0, 0.5 * (0.9 + roof)}, {1.25, 0.88 * half_width, 0.5 * (roof - 0.9)}};
  AddBox(body, cabin, PlainPaint(color, world->channels), WindowPaint(color, 2, world->channels),
         world);
  return roof;
}

double AddPickup(int body, const Color& color, Random* random, World* world) {
  const double half_width = random->Uniform(0.88, 0.98);
  const double roof = random->Uniform(1.6, 1.85);
  const int channels = world->channels;
  AddChassis(body, {{0, 0, 0.55}, {2.45, half_width, 0.45}}, color, world);
  const Box cabin{{0.55, 0, 0.5 * (1.0 + roof)}, {0.75, 0.9 * half_width, 0.5 * (roof - 1.0)}};
  AddBox(body, cabin, PlainPaint(color, channels), WindowPaint(color, 1, channels), world);
  AddPlate(body, {-1.4, 0, 1.005}, 0.95, 0.85 * half_width, 0, PlainPaint(Gray(0.05), channels),
           world);
  return roof;
}

void AddBanner(const Vector2d& center, double yaw, double length_m, double height_m,
               const Color& color, Random* random, World* world) {
  const int height_px = 96;
  cv::Mat codes(height_px, static_cast<int>(height_px * length_m / height_m), CV_8UC3,
                CodesOf(color));
  const Color letters = color.mean() > 0.35 ? Gray(0.05) : Gray(0.85);
  std::string text;
  for (int i = 0; i < 12; ++i) text += static_cast<char>('A' + random->Integer(0, 25));
  cv::putText(codes, text, {12, 68}, cv::FONT_HERSHEY_TRIPLEX, 1.9, CodesOf(letters), 5,
              cv::LINE_AA);
  cv::circle(codes, {codes.cols - 50, 48}, 32, CodesOf(letters), -1, cv::LINE_AA);
  const auto paint = std::make_shared<Texture>(codes, world->channels);
  for (const double side : {1.0, -1.0}) {
    const Vector3d right = 0.5 * length_m * side * Vector3d(std::cos(yaw), std::sin(yaw), 0);
    world->surfaces.push_back({.center = {center.x(), center.y(), 0.5 * height_m},
                               .right = right,
                               .up = {0, 0, 0.5 * height_m},
                               .paint = paint,
                               .mask = nullptr});
  }
}

void AddUavShadow(int body, double size_m, World* world) {
  constexpr int kSize_px = 256;
  constexpr double kRotorOpacity = 0.35;  // a rotating rotor lets most of the light through
  cv::Mat opacity(kSize_px, kSize_px, CV_8U, cv::Scalar(0));
  const cv::Point middle(kSize_px / 2, kSize_px / 2);
  constexpr int kArms = 6;
  std::vector<cv::Point> rotors;
  for (int i = 0; i < kArms; ++i) {
    const double angle = 2 * kPi * (i + 0.5) / kArms;
    rotors.emplace_back(middle.x + static_cast<int>(88 * std::cos(angle)),
                        middle.y + static_cast<int>(88 * std::sin(angle)));
    cv::circle(opacity, rotors.back(), 38, cv::Scalar(CodeOfReflectance(kRotorOpacity)), -1,
               cv::LINE_AA);
  }
  for (const cv::Point& rotor : rotors) {
    cv::line(opacity, middle, rotor, cv::Scalar(255), 7, cv::LINE_AA);
  }
  cv::circle(opacity, middle, 30, cv::Scalar(255), -1, cv::LINE_AA);
  Surface& shadow = AddPlate(body, {0, 0, 0.05}, 0.75 * size_m, 0.75 * size_m, 0, nullptr, world);
  shadow.mask = std::make_shared<Texture>(opacity, 1);
  shadow.visible = false;
}

Motion Standing(const Vector2d& place, double yaw) {
  RigidTransform pose{Eigen::Quaterniond(Eigen::AngleAxisd(yaw, Vector3d::UnitZ())),
                      {place.x(), place.y(), 0}};
  return [pose](double) { return pose; };
}

}  // namespace kestrel
