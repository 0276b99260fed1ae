// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/simulation/scene/ground_painter.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include <fmt/format.h>
#include <opencv2/imgproc.hpp>

#include "kestrel/core/geometry/angles.h"
#include "kestrel/simulation/scene/direction.h"
#include "kestrel/simulation/scene/ground_materials.h"

namespace kestrel {
namespace {

using Eigen::Vector2d;

constexpr int kDetail_px = 1024;
constexpr double kDetailSize_m = 2.5;
constexpr int kMapShift = 4;  // fractional bits of OpenCV's drawing coordinates

Vector2d LeftOf(const Vector2d& direction) { return {-direction.y(), direction.x()}; }

// Returns a piece of road marking: straight, or curved with a radius of 6 to 40 m.
std::vector<Vector2d> RandomCurve(const Vector2d& start, double yaw, double length_m,
                                  Random* random) {
  constexpr double kStep_m = 0.3;
  const double bend = random->Chance(0.4) ? random->Uniform(-1, 1) / 6 : 0;
  std::vector<Vector2d> points{start};
  for (double way = 0; way < length_m; way += kStep_m) {
    points.push_back(points.back() + kStep_m * Direction(yaw + bend * way));
  }
  return points;
}

// Returns the outline of a line 'width_m' wide.
std::vector<Vector2d> Outline(const std::vector<Vector2d>& line, double width_m) {
  std::vector<Vector2d> left;
  std::vector<Vector2d> right;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const Vector2d& before = line[i > 0 ? i - 1 : 0];
    const Vector2d& after = line[std::min(i + 1, line.size() - 1)];
    const Vector2d across = 0.5 * width_m * LeftOf((after - before).normalized());
    left.push_back(line[i] + across);
    right.push_back(line[i] - across);
  }
  left.insert(left.end(), right.rbegin(), right.rend());
  return left;
}

}  // namespace

std::vector<std::string> GroundOptions::Validate() const {
  std::vector<std::string> violations;
  const auto materials = GroundMaterials();
  if (std::ranges::none_of(materials, [&](const auto& m) { return material == m.name; })) {
    violations.push_back(fmt::format(
        "material is '{}', expected asphalt, concrete, sand, grass or water", material));
  }
  if (map_px < 64 || map_px > 8192 || !std::has_single_bit(static_cast<unsigned>(map_px))) {
    violations.push_back(fmt::format("map_px is {}, expected a power of two, 64 to 8192", map_px));
  }
  return violations;
}

GroundPainter::GroundPainter(const GroundOptions& options, Random* random)
    : map_size_m_(options.map_size_m),
      map_px_(options.map_px),
      per_m_(options.map_px / options.map_size_m) {
  const GroundMaterial& ground = FindGroundMaterial(options.material);
  constexpr double kLargest_m = 9;
  const cv::Size map_size(map_px_, map_px_);
  const Color color = random->Uniform(0.75, 1.6) * ground.color;
  map_ = Painted(color, ground.map_variation,
                 FractalNoise(map_size, kLargest_m * per_m_, 7, 2.5, random->Bits()));
  detail_ = DetailOf(ground, kDetail_px, kDetailSize_m, random->Bits());
  paved_ = ground.paved;
  marking_ = Gray(random->Uniform(0.55, 0.85));
}

cv::Point GroundPainter::ToMap(const Vector2d& point) const {
  // OpenCV's (0, 0) is the centre of the first pixel, that of the texture is its corner.
  const Vector2d pixel(0.5 * map_px_ + per_m_ * point.x() - 0.5,
                       0.5 * map_px_ - per_m_ * point.y() - 0.5);
  constexpr double kScale = 1 << kMapShift;
  return {static_cast<int>(std::lround(kScale * pixel.x())),
          static_cast<int>(std::lround(kScale * pixel.y()))};
}

void GroundPainter::FillPolygon(const Points& corners, const Color& color, double opacity) {
  std::vector<cv::Point> points;
  for (const Vector2d& corner : corners) points.push_back(ToMap(corner));
  cv::Rect box = cv::boundingRect(points);
  box = {box.x >> kMapShift, box.y >> kMapShift, (box.width >> kMapShift) + 3,
         (box.height >> kMapShift) + 3};
  box = (box - cv::Point(1, 1)) & cv::Rect({}, map_.size());
  if (box.empty()) return;
  for (cv::Point& point : points) point -= box.tl() * (1 << kMapShift);
  cv::Mat part = map_(box);
  cv::Mat painted = part.clone();
  cv::fillPoly(painted, std::vector<std::vector<cv::Point>>{points}, CodesOf(color), cv::LINE_AA,
               kMapShift);
  cv::addWeighted(painted, opacity, part, 1 - opacity, 0, part);
}

void GroundPainter::Strip(const Points& line, double width_m, const Color& color, double opacity) {
  // In pieces: the box around a whole long line would cover most of the map.
  constexpr std::size_t kPiece = 12;
  for (std::size_t i = 0; i + 1 < line.size(); i += kPiece) {
    const std::size_t end = std::min(i + kPiece + 1, line.size());
    FillPolygon(Outline({line.begin() + i, line.begin() + end}, width_m), color, opacity);
  }
}

void GroundPainter::Dashes(const Points& line, double width_m, double dash_m, double gap_m,
                           const Color& color) {
  double way = 0;
  for (std::size_t i = 0; i + 1 < line.size(); ++i) {
    const double length = (line[i + 1] - line[i]).norm();
    if (std::fmod(way, dash_m + gap_m) < dash_m) {
      FillPolygon(Outline({line[i], line[i + 1]}, width_m), color, 0.9);
    }
    way += length;
  }
}

void GroundPainter::Disc(const Vector2d& center, double radius_m, const Color& color,
                         double opacity) {
  constexpr int kCorners = 40;
  Points corners;
  for (int i = 0; i < kCorners; ++i) {
    corners.push_back(center + radius_m * Direction(2 * kPi * i / kCorners));
  }
  FillPolygon(corners, color, opacity);
}

Vector2d GroundPainter::Place(Random* random) const {
  // Denser in the middle, where the UAV flies.
  const double radius = 0.5 * map_size_m_ * std::pow(random->Uniform(), 0.7);
  return radius * RandomDirection(random);
}

void GroundPainter::Bays(const Vector2d& corner, double yaw, Random* random) {
  const int bays = random->Integer(3, 7);
  const Vector2d along = Direction(yaw);
  for (int i = 0; i <= bays; ++i) {
    const Vector2d start = corner + 2.5 * i * along;
    Strip({start, start + 5 * LeftOf(along)}, 0.12, marking_, 0.85);
  }
  Strip({corner, corner + 2.5 * bays * along}, 0.12, marking_, 0.85);
}

void GroundPainter::Crossing(const Vector2d& corner, double yaw, Random* random) {
  const Vector2d along = Direction(yaw);
  const int stripes = random->Integer(5, 10);
  for (int i = 0; i < stripes; ++i) {
    const Vector2d start = corner + 1.0 * i * along;
    Strip({start, start + 3 * LeftOf(along)}, 0.5, marking_, 0.85);
  }
}

void GroundPainter::Markings(int count, Random* random) {
  for (int i = 0; i < count; ++i) {
    const Vector2d place = Place(random);
    const double yaw = random->Uniform(0, 2 * kPi);
    const double kind = random->Uniform();
    if (kind < 0.12 && paved_) {
      Bays(place, yaw, random);
    } else if (kind < 0.22 && paved_) {
      Crossing(place, yaw, random);
    } else if (kind < 0.45) {
      const Points line = RandomCurve(place, yaw, random->Uniform(6, 30), random);
      Dashes(line, random->Uniform(0.1, 0.15), 1.5, 1.5, marking_);
    } else {
      const Points line = RandomCurve(place, yaw, random->Uniform(4, 40), random);
      Strip(line, random->Uniform(0.08, 0.2), marking_, random->Uniform(0.6, 0.95));
    }
  }
}

void GroundPainter::TrackLines(const Points& track, double half_width_m) {
  for (const double side : {-1.0, 1.0}) {
    Points line;
    for (std::size_t i = 0; i + 1 < track.size(); ++i) {
      const Vector2d along = (track[i + 1] - track[i]).normalized();
      line.push_back(track[i] + side * half_width_m * LeftOf(along));
    }
    Strip(line, 0.15, marking_, 0.9);
  }
}

void GroundPainter::Manhole(const Vector2d& center, Random* random) {
  const double radius = random->Uniform(0.25, 0.4);
  Disc(center, 1.18 * radius, Gray(0.14), 0.8);
  Disc(center, radius, Gray(0.04), 0.95);
  Disc(center, 0.9 * radius, Gray(0.075), 0.95);
  const double yaw = random->Uniform(0, kPi);
  for (int i = -2; i <= 2; ++i) {
    const Vector2d middle = center + 0.3 * i * radius * LeftOf(Direction(yaw));
    const double half = 0.75 * radius * std::sqrt(1 - 0.09 * i * i);
    Strip({middle - half * Direction(yaw), middle + half * Direction(yaw)}, 0.04, Gray(0.03), 0.8);
  }
}

void GroundPainter::Drain(const Vector2d& center, double yaw) {
  const Vector2d along = Direction(yaw);
  Strip({center - 0.3 * along, center + 0.3 * along}, 0.45, Gray(0.05), 0.9);
  for (int i = -3; i <= 3; ++i) {
    const Vector2d middle = center + 0.08 * i * along;
    Strip({middle - 0.18 * LeftOf(along), middle + 0.18 * LeftOf(along)}, 0.03, Gray(0.16), 0.9);
  }
}

void GroundPainter::Crack(const Vector2d& start, double yaw, Random* random) {
  Points line{start};
  for (int i = 0; i < 40; ++i) {
    yaw += random->Uniform(-0.4, 0.4);
    line.push_back(line.back() + random->Uniform(0.05, 0.25) * Direction(yaw));
  }
  Strip(line, random->Uniform(0.02, 0.05), Gray(0.03), 0.7);
}

void GroundPainter::TyreMarks(const Vector2d& start, double yaw, Random* random) {
  const Points line = RandomCurve(start, yaw, random->Uniform(4, 25), random);
  const double opacity = random->Uniform(0.15, 0.5);
  for (const double side : {-0.75, 0.75}) {
    Points wheel;
    for (const Vector2d& point : line) wheel.push_back(point + side * LeftOf(Direction(yaw)));
    Strip(wheel, random->Uniform(0.15, 0.22), Gray(0.03), opacity);
  }
}

void GroundPainter::Patch(const Vector2d& center, double yaw, Random* random) {
  const Vector2d along = random->Uniform(0.4, 3) * Direction(yaw);
  const Vector2d across = random->Uniform(0.4, 2) * LeftOf(Direction(yaw));
  const Points corners{center - along - across, center + along - across, center + along + across,
                       center - along + across};
  FillPolygon(corners, Gray(random->Uniform(0.03, 0.3)), random->Uniform(0.2, 0.6));
}

void GroundPainter::Details(int count, Random* random) {
  for (int i = 0; i < count; ++i) {
    const Vector2d place = Place(random);
    const double yaw = random->Uniform(0, 2 * kPi);
    const double kind = random->Uniform();
    if (kind < 0.15 && paved_) {
      Manhole(place, random);
    } else if (kind < 0.25 && paved_) {
      Drain(place, yaw);
    } else if (kind < 0.4 && paved_) {
      Crack(place, yaw, random);
    } else if (kind < 0.6) {
      TyreMarks(place, yaw, random);
    } else if (kind < 0.8) {
      Patch(place, yaw, random);
    } else {
      Disc(place, random->Uniform(0.1, 0.8), Gray(random->Uniform(0.02, 0.2)),
           random->Uniform(0.2, 0.7));
    }
  }
}

void GroundPainter::Curb(double radius_m, const std::string& material, Random* random) {
  const GroundMaterial& beyond = FindGroundMaterial(material);
  constexpr int kCorners = 360;
  Points curb;
  const double phase = random->Uniform(0, 2 * kPi);
  for (int i = 0; i <= kCorners; ++i) {
    const double angle = 2 * kPi * i / kCorners;
    const double radius = radius_m * (1 + 0.06 * std::sin(2 * angle + phase));
    curb.push_back(radius * Direction(angle));
  }
  cv::Mat outside(map_.size(), CV_8U, cv::Scalar(255));
  std::vector<cv::Point> corners;
  for (const Vector2d& point : curb) corners.push_back(ToMap(point));
  cv::fillPoly(outside, std::vector<std::vector<cv::Point>>{corners}, cv::Scalar(0), cv::LINE_8,
               kMapShift);
  const cv::Mat noise = FractalNoise(map_.size(), 5 * per_m_, 6, 2.6, random->Bits());
  Painted(beyond.color, beyond.map_variation, noise).copyTo(map_, outside);
  Strip(curb, 0.3, Gray(0.35), 1);
  Dashes(curb, 0.3, 1.0, 1.0, Gray(0.5));
}

Ground GroundPainter::ToGround(int channels) const {
  Ground ground;
  ground.map = std::make_shared<Texture>(map_, channels, Texture::Beyond::kMirror);
  ground.map_size_m = map_size_m_;
  ground.detail = std::make_shared<Texture>(detail_, 1, Texture::Beyond::kRepeat);
  ground.detail_size_m = kDetailSize_m;
  return ground;
}

namespace {

// Returns sunlight through trees and past houses: soft-edged shade over about a third of the
// ground.
std::shared_ptr<const Texture> MakeSunlit(Random* random) {
  constexpr int kSize_px = 1024;
  cv::Mat lit(kSize_px, kSize_px, CV_8U, cv::Scalar(255));
  const double cells_px = random->Uniform(120, 260);
  const cv::Mat crowns = FractalNoise(lit.size(), cells_px, 4, 2.4, random->Bits());
  lit.setTo(CodeOfReflectance(random->Uniform(0, 0.15)), crowns > random->Uniform(0.4, 0.7));
  const int houses = random->Integer(1, 3);
  for (int i = 0; i < houses; ++i) {
    const cv::Point2f center(static_cast<float>(kSize_px * random->Uniform()),
                             static_cast<float>(kSize_px * random->Uniform()));
    const cv::RotatedRect house(center,
                                cv::Size2f(static_cast<float>(random->Uniform(80, 500)),
                                           static_cast<float>(random->Uniform(60, 200))),
                                static_cast<float>(random->Uniform(0, 180)));
    cv::Point2f corners[4];
    house.points(corners);
    std::vector<cv::Point> polygon(corners, corners + 4);
    cv::fillPoly(lit, std::vector<std::vector<cv::Point>>{polygon}, cv::Scalar(0));
  }
  cv::GaussianBlur(lit, lit, {}, random->Uniform(0.6, 2));
  return std::make_shared<Texture>(lit, 1, Texture::Beyond::kMirror);
}

}  // namespace

Ground MakeGround(const GroundOptions& options, const std::vector<Vector2d>& track, int channels,
                  Random* random) {
  GroundPainter painter(options, random);
  painter.Details(options.details / 2, random);
  painter.Markings(options.markings, random);
  if (!track.empty()) painter.TrackLines(track, 2.2);
  painter.Details(options.details - options.details / 2, random);
  if (options.curb) {
    const auto materials = GroundMaterials();
    const int other = random->Integer(0, static_cast<int>(materials.size()) - 2);  // land
    painter.Curb(options.map_size_m * random->Uniform(0.3, 0.42), materials[other].name, random);
  }
  Ground ground = painter.ToGround(channels);
  if (options.shadows) ground.sunlit = MakeSunlit(random);
  return ground;
}

}  // namespace kestrel
