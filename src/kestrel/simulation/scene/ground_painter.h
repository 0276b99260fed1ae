// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include "kestrel/core/base/limits.h"
#include "kestrel/core/base/random.h"
#include "kestrel/simulation/scene/paint.h"
#include "kestrel/simulation/scene/world.h"

namespace kestrel {

// Material of a world's ground, and the paint on it.
struct GroundOptions {
  std::string material = "asphalt";
  int markings = 12;
  int details = 30;
  bool curb = true;
  bool shadows = true;
  double map_size_m = 64;
  int map_px = 4096;

  static void Visit(auto& self, auto&& visit) {
    visit("material", self.material, "asphalt, concrete, sand, grass or water");
    visit("markings", self.markings, Range{0, 1000}, "number of road markings");
    visit("details", self.details, Range{0, 1000},
          "number of manhole covers, drains, cracks, stains and tyre marks");
    visit("curb", self.curb, "a curb around, another material behind it");
    visit("shadows", self.shadows, "shadows of trees and houses");
    visit("map_size_m", self.map_size_m, Range{1, 1000}, "side of the ground's map, which repeats");
    visit("map_px", self.map_px, "side of the ground's map in pixels, a power of two");
  }
  std::vector<std::string> Validate() const;
};

// Paints on the ground's map, in metres from its middle (x right, y up in the map).
class GroundPainter {
 public:
  GroundPainter(const GroundOptions& options, Random* random);

  void Markings(int count, Random* random);
  void Details(int count, Random* random);
  // Paints a curb 'radius_m' around the middle, not quite round, with 'material' behind it.
  void Curb(double radius_m, const std::string& material, Random* random);
  // Paints two white lines, 'half_width_m' to both sides of a closed or open track.
  void TrackLines(const std::vector<Eigen::Vector2d>& track, double half_width_m);

  Ground ToGround(int channels) const;

 private:
  using Points = std::vector<Eigen::Vector2d>;

  cv::Point ToMap(const Eigen::Vector2d& point) const;  // in 1 / 16 px
  void FillPolygon(const Points& corners, const Color& color, double opacity);
  void Strip(const Points& line, double width_m, const Color& color, double opacity);
  void Dashes(const Points& line, double width_m, double dash_m, double gap_m, const Color& color);
  void Disc(const Eigen::Vector2d& center, double radius_m, const Color& color, double opacity);
  void Bays(const Eigen::Vector2d& corner, double yaw, Random* random);
  void Crossing(const Eigen::Vector2d& corner, double yaw, Random* random);
  void Manhole(const Eigen::Vector2d& center, Random* random);
  void Drain(const Eigen::Vector2d& center, double yaw);
  void Crack(const Eigen::Vector2d& start, double yaw, Random* random);
  void TyreMarks(const Eigen::Vector2d& start, double yaw, Random* random);
  void Patch(const Eigen::Vector2d& center, double yaw, Random* random);
  Eigen::Vector2d Place(Random* random) const;

  double map_size_m_;
  int map_px_;
  double per_m_;
  bool paved_;
  Color marking_;
  cv::Mat map_;     // CV_8UC3 codes
  cv::Mat detail_;  // CV_8UC1 codes
};

// Makes the whole ground from its options. 'track': path of the vehicle; may be empty.
Ground MakeGround(const GroundOptions& options, const std::vector<Eigen::Vector2d>& track,
                  int channels, Random* random);

}  // namespace kestrel
