// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/helipad/helipad_model.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include <Eigen/LU>

#include "kestrel/core/base/robust_statistics.h"
#include "kestrel/core/geometry/angles.h"

namespace kestrel {
namespace {

using Eigen::Vector2d;

constexpr double kBeside = 1.7;     // strokes, between a sample and those that it is held against
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

// Returns the distance of a place from the middle, along the frame's radius or its sides.
double FrameReach(const Helipad& helipad, const Vector2d& place) {
  return helipad.frame == "circle" ? place.norm() : place.lpNorm<Eigen::Infinity>();
}

// Collects the samples.
class Samples {
 public:
  explicit Samples(const Helipad& helipad) : helipad_(helipad) {}

  // 'count' points evenly from 'from' to 'to'; those of the ground only where the frame is not.
  void AddRow(HelipadPart part, bool ink, const Vector2d& from, const Vector2d& to, int count) {
    for (int i = 0; i < count; ++i) {
      const Vector2d place = count == 1 ? from : Vector2d(from + (to - from) * i / (count - 1));
      if (ink || IsClear(place)) samples_.push_back({place, part, ink, {}});
    }
    Connect(kBeside * helipad_.stroke_m);
  }

  // Points on the frame, and on the ground beside it.
  void AddFrame() {
    constexpr int kAround = 32;
    const double width = helipad_.frame_width_m;
    const double middle = 0.5 * (helipad_.frame_size_m - width);
    for (int i = 0; i < kAround; ++i) {
      const double angle = 2 * std::numbers::pi * (i + 0.5) / kAround;
      const Vector2d way(std::cos(angle), std::sin(angle));
      const Vector2d unit = way / FrameReach(helipad_, way);
      samples_.push_back({middle * unit, HelipadPart::kFrame, true, {}});
      for (const double reach : {middle - 1.1 * width, middle + 1.1 * width}) {
        const Vector2d place = reach * unit;
        const bool on_board = 2 * place.lpNorm<Eigen::Infinity>() < helipad_.board_size_m;
        if (on_board && !IsNearH(place)) {
          samples_.push_back({place, HelipadPart::kFrame, false, {}});
        }
      }
    }
    Connect(1.7 * width);
  }

  std::vector<HelipadSample> Take() { return std::move(samples_); }

 private:
  bool IsClear(const Vector2d& place) const {
    const double margin = 0.3 * helipad_.stroke_m;
    if (helipad_.frame == "none") {
      return place.lpNorm<Eigen::Infinity>() < 0.5 * helipad_.board_size_m - margin;
    }
    const double inner = 0.5 * helipad_.frame_size_m - helipad_.frame_width_m;
    return FrameReach(helipad_, place) < inner - margin;
  }

  bool IsNearH(const Vector2d& place) const {
    const double margin = 0.4 * helipad_.stroke_m;
    return std::abs(place.x()) < 0.5 * helipad_.width_m + margin &&
           std::abs(place.y()) < 0.5 * helipad_.height_m + margin;
  }

  // Holds the samples that were added last against each other.
  void Connect(double reach) {
    for (std::size_t i = connected_; i < samples_.size(); ++i) {
      for (std::size_t k = 0; k < i; ++k) {
        HelipadSample& a = samples_[i];
        HelipadSample& b = samples_[k];
        if (a.ink == b.ink || (a.place - b.place).norm() > reach) continue;
        if ((a.part == HelipadPart::kFrame) != (b.part == HelipadPart::kFrame)) continue;
        a.opposite.push_back(k);
        b.opposite.push_back(i);
      }
    }
    connected_ = samples_.size();
  }

  const Helipad& helipad_;
  std::vector<HelipadSample> samples_;
  std::size_t connected_ = 0;
};

std::vector<HelipadSample> MakeSamples(const Helipad& helipad) {
  const double stroke = helipad.stroke_m;
  const double leg = 0.5 * (helipad.width_m - stroke);  // to the middle of a leg
  const double top = 0.5 * (helipad.height_m - stroke);
  const double beside = 0.5 * helipad.width_m + 0.55 * stroke;
  const double above = 0.5 * helipad.height_m + 0.5 * stroke;
  const int rows = std::clamp(static_cast<int>(1.3 * helipad.height_m / stroke), 6, 16);
  const double gap = leg - 1.1 * stroke;  // the farthest place between the legs
  Samples all(helipad);
  all.AddRow(HelipadPart::kLeftLeg, true, {-leg, top}, {-leg, -top}, rows);
  all.AddRow(HelipadPart::kRightLeg, true, {leg, top}, {leg, -top}, rows);
  all.AddRow(HelipadPart::kBar, true, {-gap, 0}, {gap, 0}, 5);
  for (const double x : {-gap, 0.0, gap}) {
    all.AddRow(HelipadPart::kUpperGap, false, {x, top}, {x, 1.05 * stroke}, 4);
    all.AddRow(HelipadPart::kLowerGap, false, {x, -top}, {x, -1.05 * stroke}, 4);
  }
  all.AddRow(HelipadPart::kLeft, false, {-beside, top}, {-beside, -top}, rows);
  all.AddRow(HelipadPart::kRight, false, {beside, top}, {beside, -top}, rows);
  all.AddRow(HelipadPart::kAbove, false, {-leg, above}, {leg, above}, 5);
  all.AddRow(HelipadPart::kBelow, false, {-leg, -above}, {leg, -above}, 5);
  for (const double x : {-beside, beside}) {
    all.AddRow(HelipadPart::kBarEnds, false, {x, 0.3 * stroke}, {x, -0.3 * stroke}, 3);
  }
  if (helipad.frame != "none") all.AddFrame();
  return all.Take();
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
    : white(helipad.white),
      samples(MakeSamples(helipad)),
      letter_moments(MomentsOf(CornersOf(helipad))),
      frame_moments(MomentsOfFrame(helipad)) {
  for (const HelipadSample& sample : samples) places.push_back(sample.place);
  const auto of_letter = std::count_if(samples.begin(), samples.end(), [](const HelipadSample& s) {
    return s.part != HelipadPart::kFrame;
  });
  // Half a stroke beside the H on each side belongs to it.
  sample_area = (helipad.height_m / helipad.stroke_m + 1) *
                (helipad.width_m / helipad.stroke_m + 1) / static_cast<double>(of_letter);
  edges.tags.push_back(ModelOfH(helipad));
  if (helipad.frame != "none") edges.tags.push_back(ModelOfFrame(helipad));
  for (const TagModel& part : edges.tags) edges.most_edges += part.edges.size();
  edges.radius_m = 0.5 * std::hypot(helipad.height_m, helipad.width_m);
}

HelipadModel::Contrast HelipadModel::ContrastAt(std::span<const float> gray, std::size_t i) const {
  if (gray[i] < 0) return {NAN, NAN};
  const float sign = samples[i].ink == white ? 1.0F : -1.0F;
  const float here = log_(gray[i]);
  float sum = 0, largest = -1;
  int count = 0;
  for (const std::size_t k : samples[i].opposite) {
    if (gray[k] < 0) continue;
    const float contrast = sign * (here - log_(gray[k]));
    sum += contrast;
    largest = std::max(largest, contrast);
    ++count;
  }
  if (count == 0) return {NAN, NAN};
  return {sum / static_cast<float>(count), largest};
}

HelipadAgreement HelipadModel::Compare(std::span<const float> gray, double stroke_px,
                                       DimSample dim) const {
  constexpr double kLeastContrast = 0.02;
  constexpr float kLeastDimContrast = 0.1F;  // of ink in a shadow
  constexpr double kLeast = 0.45;            // of the usual contrast, of a sample that agrees
  HelipadAgreement agreement;
  std::array<float, kMostHelipadSamples> means, largest;
  std::size_t count = 0;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const Contrast contrast = ContrastAt(gray, i);
    largest[i] = contrast.largest;
    if (!std::isnan(contrast.mean)) means[count++] = contrast.mean;
  }
  if (count == 0) return agreement;
  const double usual = MedianInPlace(std::span(means.data(), count));
  if (usual < kLeastContrast) return agreement;
  agreement.evidence = EvidenceOf(gray, stroke_px);
  std::array<int, kHelipadParts> seen{}, right{};
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (std::isnan(largest[i])) continue;
    // In one light with it: where the edge of a shadow runs, the others say little.
    const bool agrees = largest[i] / usual > kLeast;
    if (!agrees && dim == DimSample::kUnknown && largest[i] > kLeastDimContrast) continue;
    const auto part = static_cast<std::size_t>(samples[i].part);
    ++seen[part];
    right[part] += agrees;
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

double HelipadModel::EvidenceOf(std::span<const float> gray, double stroke_px) const {
  constexpr double kBlurArea_px2 = 7.2;       // 4 pi sigma^2 of a usual lens with its pixels
  constexpr double kLeastUnexplained = 1e-4;  // gray values are whole numbers
  constexpr double kPoseParameters = 6;
  const double likeness = LikenessOf(gray);
  if (likeness <= 0) return 0;
  const auto seen = std::count_if(gray.begin(), gray.end(), [](float g) { return g >= 0; });
  const double share = std::min(1.0, sample_area * stroke_px * stroke_px / kBlurArea_px2);
  const double independent = std::max(1.0, share * static_cast<double>(seen));
  const double unexplained = std::max(kLeastUnexplained, 1 - likeness * likeness);
  return -0.5 * (independent * std::log(unexplained) + kPoseParameters * std::log(independent));
}

double HelipadModel::LikenessOf(std::span<const float> gray) const {
  constexpr double kLeastSpread = 0.01;
  double sum = 0, squares = 0;
  int count = 0;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const float contrast = ContrastAt(gray, i).mean;
    if (std::isnan(contrast)) continue;
    sum += contrast;
    squares += contrast * contrast;
    ++count;
  }
  constexpr int kFewest = 8;
  if (count < kFewest) return -1;
  return sum / count / std::max(kLeastSpread, std::sqrt(squares / count));
}

}  // namespace kestrel
