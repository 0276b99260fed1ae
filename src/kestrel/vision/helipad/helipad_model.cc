// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/helipad/helipad_model.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>

#include "kestrel/core/geometry/angles.h"

namespace kestrel {
namespace {

using Eigen::Vector2d;

// The parts of an H and of its surroundings that are examined one by one.
enum HelipadPart : std::size_t {
  kLeftLeg,
  kRightLeg,
  kBar,
  kUpperGap,
  kLowerGap,
  kLeft,
  kRight,
  kAbove,
  kBelow,
  kBarEnds,
  kFrame
};

constexpr double kBeside = 1.7;     // strokes, between a sample and those that it is held against
constexpr double kFineStep = 0.33;  // strokes between the points of an edge; every third is coarse

// Adds points along a straight edge whose ink lies on the right.
void AddEdge(const Vector2d& from, const Vector2d& to, double stroke, double width, bool white,
             PadPart* part) {
  const double length = (to - from).norm();
  const Vector2d along = (to - from) / length;
  const Vector2d to_ink(along.y(), -along.x());
  const int count = std::max(1, static_cast<int>(length / (kFineStep * stroke)) - 1);
  for (int i = 0; i < count; ++i) {
    const Vector2d place = from + length * (i + 1) / (count + 1) * along;
    const Vector2d to_white = white ? to_ink : Vector2d(-to_ink);
    part->edges.push_back({place, to_white, width, i % 3 != count / 2 % 3});
  }
}

void AddClosedEdge(std::span<const Vector2d> corners, double stroke, double width, bool white,
                   PadPart* part) {
  for (std::size_t i = 0; i < corners.size(); ++i) {
    AddEdge(corners[i], corners[(i + 1) % corners.size()], stroke, width, white, part);
  }
}

// Adds points of a circle whose ink lies inside of it, or outside.
void AddCircle(double radius, bool ink_inside, double width, bool white, PadPart* part) {
  constexpr int kCount = 48;
  for (int i = 0; i < kCount; ++i) {
    const double angle = 2 * std::numbers::pi * i / kCount;
    const Vector2d outward(std::cos(angle), std::sin(angle));
    const double sign = ink_inside == white ? -1 : 1;
    part->edges.push_back({radius * outward, sign * outward, width, i % 2 != 0});
  }
}

PadPart PartOfH(const Helipad& helipad) {
  PadPart part{.stroke_m = helipad.stroke_m};
  AddClosedEdge(CornersOf(helipad), helipad.stroke_m, helipad.stroke_m, helipad.white, &part);
  return part;
}

PadPart PartOfFrame(const Helipad& helipad) {
  PadPart part{.stroke_m = helipad.frame_width_m};
  const double inner = helipad.frame_size_m - 2 * helipad.frame_width_m;
  for (const bool outer : {true, false}) {
    const double size = outer ? helipad.frame_size_m : inner;
    if (helipad.frame == "circle") {
      AddCircle(0.5 * size, outer, helipad.frame_width_m, helipad.white, &part);
      continue;
    }
    // The ink lies outside of the inner line.
    const auto corners = Rectangle({0, 0}, Vector2d::Constant(size)).loops[0];
    AddClosedEdge(corners, 3 * helipad.stroke_m, helipad.frame_width_m, outer == helipad.white,
                  &part);
  }
  return part;
}

// Returns the distance of a place from the middle, along the frame's radius or its sides.
double FrameReach(const Helipad& helipad, const Vector2d& place) {
  return helipad.frame == "circle" ? place.norm() : place.lpNorm<Eigen::Infinity>();
}

// Returns whether a place on the ground is clear of the frame, or of the board's edge.
bool IsClear(const Helipad& helipad, const Vector2d& place) {
  const double margin = 0.3 * helipad.stroke_m;
  if (helipad.frame == "none") {
    return place.lpNorm<Eigen::Infinity>() < 0.5 * helipad.board_size_m - margin;
  }
  const double inner = 0.5 * helipad.frame_size_m - helipad.frame_width_m;
  return FrameReach(helipad, place) < inner - margin;
}

bool IsNearH(const Helipad& helipad, const Vector2d& place) {
  const double margin = 0.4 * helipad.stroke_m;
  return std::abs(place.x()) < 0.5 * helipad.width_m + margin &&
         std::abs(place.y()) < 0.5 * helipad.height_m + margin;
}

void AddSamplesOfH(const Helipad& helipad, InkSamples* samples) {
  const double stroke = helipad.stroke_m;
  const double leg = 0.5 * (helipad.width_m - stroke);  // to the middle of a leg
  const double top = 0.5 * (helipad.height_m - stroke);
  const double beside = 0.5 * helipad.width_m + 0.55 * stroke;
  const double above = 0.5 * helipad.height_m + 0.5 * stroke;
  const int rows = std::clamp(static_cast<int>(1.3 * helipad.height_m / stroke), 6, 16);
  const double gap = leg - 1.1 * stroke;  // the farthest place between the legs
  // 'count' points evenly from 'from' to 'to'; those of the ground only where the frame is not.
  const auto add_row = [&](HelipadPart part, bool ink, const Vector2d& from, const Vector2d& to,
                           int count) {
    for (int i = 0; i < count; ++i) {
      const Vector2d place = from + (to - from) * i / (count - 1);
      if (ink || IsClear(helipad, place)) samples->Add(place, part, ink);
    }
  };
  add_row(kLeftLeg, true, {-leg, top}, {-leg, -top}, rows);
  add_row(kRightLeg, true, {leg, top}, {leg, -top}, rows);
  add_row(kBar, true, {-gap, 0}, {gap, 0}, 5);
  for (const double x : {-gap, 0.0, gap}) {
    add_row(kUpperGap, false, {x, top}, {x, 1.05 * stroke}, 4);
    add_row(kLowerGap, false, {x, -top}, {x, -1.05 * stroke}, 4);
  }
  add_row(kLeft, false, {-beside, top}, {-beside, -top}, rows);
  add_row(kRight, false, {beside, top}, {beside, -top}, rows);
  add_row(kAbove, false, {-leg, above}, {leg, above}, 5);
  add_row(kBelow, false, {-leg, -above}, {leg, -above}, 5);
  for (const double x : {-beside, beside}) {
    add_row(kBarEnds, false, {x, 0.3 * stroke}, {x, -0.3 * stroke}, 3);
  }
  samples->Connect(0, kBeside * stroke);
}

// Adds points on the frame, and on the ground beside it.
void AddSamplesOfFrame(const Helipad& helipad, InkSamples* samples) {
  constexpr int kAround = 32;
  const std::size_t first = samples->count();
  const double width = helipad.frame_width_m;
  const double middle = 0.5 * (helipad.frame_size_m - width);
  for (int i = 0; i < kAround; ++i) {
    const double angle = 2 * std::numbers::pi * (i + 0.5) / kAround;
    const Vector2d way(std::cos(angle), std::sin(angle));
    const Vector2d unit = way / FrameReach(helipad, way);
    samples->Add(middle * unit, kFrame, true);
    for (const double reach : {middle - 1.1 * width, middle + 1.1 * width}) {
      const Vector2d place = reach * unit;
      const bool on_board = 2 * place.lpNorm<Eigen::Infinity>() < helipad.board_size_m;
      if (on_board && !IsNearH(helipad, place)) samples->Add(place, kFrame, false);
    }
  }
  samples->Connect(first, kBeside * width);
}

FigureMoments MomentsOfFrame(const Helipad& helipad) {
  FigureMoments moments;
  if (helipad.frame == "none") return moments;
  const double square = helipad.frame_size_m * helipad.frame_size_m;
  const bool round = helipad.frame == "circle";
  moments.area = round ? kPi / 4 * square : square;
  moments.covariance = square / (round ? 16 : 12) * Eigen::Matrix2d::Identity();
  return moments;
}

}  // namespace

HelipadModel::HelipadModel(const Helipad& helipad)
    : parts{PartOfH(helipad)},
      radius_m(0.5 * std::hypot(helipad.height_m, helipad.width_m)),
      samples(helipad.white),
      letter_moments(MomentsOf(CornersOf(helipad))),
      frame_moments(MomentsOfFrame(helipad)) {
  AddSamplesOfH(helipad, &samples);
  // Half a stroke beside the H on each side belongs to it.
  sample_area = (helipad.height_m / helipad.stroke_m + 1) *
                (helipad.width_m / helipad.stroke_m + 1) / static_cast<double>(samples.count());
  if (helipad.frame == "none") return;
  AddSamplesOfFrame(helipad, &samples);
  parts.push_back(PartOfFrame(helipad));
}

}  // namespace kestrel
