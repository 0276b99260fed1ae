// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/helipad/helipad_model.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include <Eigen/LU>

#include "kestrel/vision/tags/board_samples.h"

namespace kestrel {
namespace {

using Eigen::Vector2d;

constexpr double kNeighborhood = 2.6;  // strokes, around a sample
constexpr double kFineStep = 0.33;  // strokes between the points of an edge; every third is coarse

// Adds points along a straight edge whose ink lies on the right.
void AddEdge(const Vector2d& from, const Vector2d& to, double stroke, double width, bool white,
             TagModel* model) {
  const double length = (to - from).norm();
  const Vector2d along = (to - from) / length;
  const Vector2d to_ink(along.y(), -along.x());
  const int count = std::max(1, static_cast<int>(length / (kFineStep * stroke)) - 1);
  for (int i = 0; i < count; ++i) {
    const Vector2d place = from + length * (i + 1) / (count + 1) * along;
    const Vector2d to_white = white ? to_ink : Vector2d(-to_ink);
    model->edges.push_back({place, to_white, width, i % 3 != count / 2 % 3});
  }
}

void AddClosedEdge(std::span<const Vector2d> corners, double stroke, double width, bool white,
                   TagModel* model) {
  for (std::size_t i = 0; i < corners.size(); ++i) {
    AddEdge(corners[i], corners[(i + 1) % corners.size()], stroke, width, white, model);
  }
}

// Adds points of a circle whose ink lies inside of it, or outside.
void AddCircle(double radius, bool ink_inside, double width, bool white, TagModel* model) {
  constexpr int kCount = 48;
  for (int i = 0; i < kCount; ++i) {
    const double angle = 2 * std::numbers::pi * i / kCount;
    const Vector2d outward(std::cos(angle), std::sin(angle));
    const double sign = ink_inside == white ? -1 : 1;
    model->edges.push_back({radius * outward, sign * outward, width, i % 2 != 0});
  }
}

TagModel ModelOfH(const Helipad& helipad) {
  TagModel model;
  model.size_m = helipad.height_m;
  model.printed.cell_m = helipad.stroke_m;
  AddClosedEdge(CornersOf(helipad), helipad.stroke_m, helipad.stroke_m, helipad.white, &model);
  return model;
}

TagModel ModelOfFrame(const Helipad& helipad) {
  TagModel model;
  model.size_m = helipad.frame_size_m;
  model.printed.cell_m = helipad.frame_width_m;
  const double inner = helipad.frame_size_m - 2 * helipad.frame_width_m;
  for (const bool outer : {true, false}) {
    const double size = outer ? helipad.frame_size_m : inner;
    if (helipad.frame == "circle") {
      AddCircle(0.5 * size, outer, helipad.frame_width_m, helipad.white, &model);
      continue;
    }
    // The ink lies outside of the inner line.
    const auto corners = Rectangle({0, 0}, Vector2d::Constant(size)).loops[0];
    AddClosedEdge(corners, 3 * helipad.stroke_m, helipad.frame_width_m, outer == helipad.white,
                  &model);
  }
  return model;
}

bool IsClear(const Helipad& helipad, const Vector2d& place) {
  const double margin = 0.3 * helipad.stroke_m;
  const double square = place.lpNorm<Eigen::Infinity>();
  const double frame = 0.5 * helipad.frame_size_m - helipad.frame_width_m - margin;
  if (helipad.frame == "circle") return place.norm() < frame;
  if (helipad.frame == "square") return square < frame;
  return square < 0.5 * helipad.board_size_m - margin;
}

// Collects the samples: rows of points, some of them mirrored.
class SampleRows {
 public:
  explicit SampleRows(const Helipad& helipad) : helipad_(helipad) {}

  // 'count' points evenly from 'from' to 'to'.
  void Add(HelipadPart part, bool ink, const Vector2d& from, const Vector2d& to, int count) {
    for (int i = 0; i < count; ++i) {
      const Vector2d place = count == 1 ? from : Vector2d(from + (to - from) * i / (count - 1));
      if (ink || IsClear(helipad_, place)) samples_.push_back({place, part, ink, {}});
    }
  }

  std::vector<HelipadSample> Take() {
    const double reach = kNeighborhood * helipad_.stroke_m;
    for (std::size_t i = 0; i < samples_.size(); ++i) {
      for (std::size_t k = 0; k < samples_.size(); ++k) {
        const bool near = (samples_[i].place - samples_[k].place).norm() < reach;
        if (near && i != k) samples_[i].neighbors.push_back(k);
      }
    }
    return std::move(samples_);
  }

 private:
  const Helipad& helipad_;
  std::vector<HelipadSample> samples_;
};

std::vector<HelipadSample> MakeSamples(const Helipad& helipad) {
  const double stroke = helipad.stroke_m;
  const double leg = 0.5 * (helipad.width_m - stroke);  // to the middle of a leg
  const double top = 0.5 * (helipad.height_m - stroke);
  const double beside = 0.5 * helipad.width_m + 0.55 * stroke;
  const double above = 0.5 * helipad.height_m + 0.5 * stroke;
  const int rows = std::clamp(static_cast<int>(1.3 * helipad.height_m / stroke), 6, 16);
  const double gap = leg - 1.1 * stroke;  // the farthest place between the legs
  SampleRows all(helipad);
  all.Add(HelipadPart::kLeftLeg, true, {-leg, top}, {-leg, -top}, rows);
  all.Add(HelipadPart::kRightLeg, true, {leg, top}, {leg, -top}, rows);
  all.Add(HelipadPart::kBar, true, {-gap, 0}, {gap, 0}, 5);
  for (const double x : {-gap, 0.0, gap}) {
    all.Add(HelipadPart::kUpperGap, false, {x, top}, {x, 1.05 * stroke}, 4);
    all.Add(HelipadPart::kLowerGap, false, {x, -top}, {x, -1.05 * stroke}, 4);
  }
  all.Add(HelipadPart::kOutside, false, {-beside, top}, {-beside, -top}, rows);
  all.Add(HelipadPart::kOutside, false, {beside, top}, {beside, -top}, rows);
  all.Add(HelipadPart::kOutside, false, {-leg, above}, {leg, above}, 5);
  all.Add(HelipadPart::kOutside, false, {-leg, -above}, {leg, -above}, 5);
  return all.Take();
}

}  // namespace

double FigureMoments::Compactness() const {
  const double determinant = covariance.determinant();
  if (!(determinant > 0)) return 0;
  return std::abs(area) / (4 * std::numbers::pi * std::sqrt(determinant));
}

FigureMoments MomentsOf(std::span<const Vector2d> corners) {
  FigureMoments moments;
  Vector2d first = Vector2d::Zero();
  Eigen::Matrix2d second = Eigen::Matrix2d::Zero();
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vector2d& a = corners[i];
    const Vector2d& b = corners[(i + 1) % corners.size()];
    const double cross = a.x() * b.y() - b.x() * a.y();
    const Vector2d sum = a + b;
    moments.area += cross / 2;
    first += cross / 6 * sum;
    second += cross / 24 * (sum * sum.transpose() + a * a.transpose() + b * b.transpose());
  }
  if (moments.area == 0) return moments;
  moments.centroid = first / moments.area;
  moments.covariance = second / moments.area - moments.centroid * moments.centroid.transpose();
  return moments;
}

HelipadModel::HelipadModel(const Helipad& helipad)
    : white(helipad.white), samples(MakeSamples(helipad)), moments(MomentsOf(CornersOf(helipad))) {
  for (const HelipadSample& sample : samples) places.push_back(sample.place);
  edges.tags.push_back(ModelOfH(helipad));
  if (helipad.frame != "none") edges.tags.push_back(ModelOfFrame(helipad));
  for (const TagModel& part : edges.tags) edges.most_edges += part.edges.size();
  edges.radius_m = 0.5 * std::hypot(helipad.height_m, helipad.width_m);
}

HelipadAgreement HelipadModel::Compare(std::span<const float> gray) const {
  constexpr double kLeastContrast = 5;  // gray values
  constexpr double kClear = 0.5;
  constexpr double kMatch = 0.5, kMismatch = 3;  // neighbouring samples are not independent
  HelipadAgreement agreement;
  std::array<int, kHelipadParts> seen{}, right{};
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (gray[i] < 0) continue;
    double sum[2] = {0, 0};
    int count[2] = {0, 0};
    for (const std::size_t k : samples[i].neighbors) {
      if (gray[k] < 0) continue;
      sum[samples[k].ink == white] += gray[k];
      ++count[samples[k].ink == white];
    }
    if (count[0] == 0 || count[1] == 0) continue;
    const double dark = sum[0] / count[0];
    const double bright = sum[1] / count[1];
    const double place = (gray[i] - 0.5 * (bright + dark)) / (0.5 * (bright - dark));
    const double here =
        bright - dark < kLeastContrast ? -1 : (samples[i].ink == white ? place : -place);
    const double clearness = std::min(1.0, std::abs(here) / kClear);
    agreement.evidence += (here > 0 ? kMatch : -kMismatch) * clearness;
    const auto part = static_cast<std::size_t>(samples[i].part);
    ++seen[part];
    right[part] += here > 0;
  }
  for (std::size_t part = 0; part < kHelipadParts; ++part) {
    constexpr int kFewest = 3;
    if (seen[part] < kFewest) continue;
    ++agreement.parts;
    agreement.worst_share =
        std::min(agreement.worst_share, static_cast<double>(right[part]) / seen[part]);
  }
  return agreement;
}

double HelipadModel::LikenessOf(std::span<const float> gray) const {
  return Likeness(gray,
                  [this](std::size_t i) { return static_cast<int>(samples[i].ink == white); });
}

}  // namespace kestrel
