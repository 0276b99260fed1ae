// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/calibration/color_training/color_teaching.h"

#include <algorithm>
#include <optional>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "kestrel/core/base/error.h"
#include "kestrel/core/base/robust_statistics.h"
#include "kestrel/vision/objects/color/color_samples.h"

namespace kestrel {
namespace {

constexpr std::size_t kMinPixels = 10;  // fewest pixels that a colour is fitted to

Hsv HsvOf(const cv::Vec3b& bgr) { return HsvFromBgr(bgr[0], bgr[1], bgr[2]); }

std::vector<Hsv> Colors(std::span<const FrameMarks> marks,
                        std::vector<cv::Vec3b> FrameMarks::*kind) {
  std::vector<Hsv> colors;
  for (const FrameMarks& of_frame : marks) {
    for (const cv::Vec3b& pixel : of_frame.*kind) colors.push_back(HsvOf(pixel));
  }
  return colors;
}

// Share of the pixels within 'distance' of the mixture.
double ReachedShare(const ColorMixture& mixture, std::span<const Hsv> pixels, double distance) {
  const auto count = std::count_if(pixels.begin(), pixels.end(), [&](const Hsv& pixel) {
    return mixture.Mahalanobis(pixel) <= distance;
  });
  return static_cast<double>(count) / static_cast<double>(std::max<std::size_t>(1, pixels.size()));
}

// Factor for the mixture's deviations with the best difference of recall and false share.
float BestScale(const ColorMixture& mixture, std::span<const Hsv> wanted,
                std::span<const Hsv> others, double max_distance) {
  float best_scale = 1;
  double best_gain = -1;
  for (int tenths = 10; tenths >= 5; --tenths) {
    const float scale = 0.1F * static_cast<float>(tenths);
    const double gain = ReachedShare(mixture, wanted, scale * max_distance) -
                        ReachedShare(mixture, others, scale * max_distance);
    if (gain <= best_gain) continue;
    best_gain = gain;
    best_scale = scale;
  }
  return best_scale;
}

struct GridShare {
  std::size_t pixels = 0;
  double share = 0;
};

// Share of all frames' pixels with the label.
GridShare LabelledShare(const ColorGrid& grid, ColorLabel label, std::span<const FrameMarks> marks,
                        std::vector<cv::Vec3b> FrameMarks::*kind) {
  std::size_t count = 0;
  std::size_t labelled = 0;
  for (const FrameMarks& of_frame : marks) {
    for (const cv::Vec3b& pixel : of_frame.*kind) labelled += grid.At(pixel.val) == label;
    count += (of_frame.*kind).size();
  }
  return {count, count == 0 ? 0 : static_cast<double>(labelled) / static_cast<double>(count)};
}

// Returns nothing when the other frames do not have enough pixels.
std::optional<double> LeftOutRecall(ColorModel model, std::size_t color,
                                    std::span<const FrameMarks> marks, std::size_t left_out) {
  std::vector<FrameMarks> rest(marks.begin(), marks.end());
  rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(left_out));
  if (Colors(rest, &FrameMarks::wanted).size() < kMinPixels) return std::nullopt;
  model.colors[color] = TeachColor(model.colors[color].name, rest, model.max_distance);
  const std::vector<Hsv> wanted = Colors(marks.subspan(left_out, 1), &FrameMarks::wanted);
  const auto count = std::count_if(wanted.begin(), wanted.end(), [&](const Hsv& pixel) {
    return model.Classify(pixel) == color;
  });
  return static_cast<double>(count) / static_cast<double>(wanted.size());
}

// Median of the frame's wanted pixels, of which there must be at least one.
float MedianValue(const FrameMarks& marks) {
  std::vector<float> values;
  for (const Hsv& color : Colors({&marks, 1}, &FrameMarks::wanted)) values.push_back(color.value);
  return MedianInPlace(values);
}

}  // namespace

ColorMixture TeachColor(const std::string& color, std::span<const FrameMarks> marks,
                        double max_distance) {
  constexpr int kMaxComponents = 4;
  constexpr std::size_t kMaxPixels = 4000;  // neighbours are much alike
  constexpr float kSaturationSigma = 0.08F;
  constexpr float kValueSigma = 0.15F;
  const std::vector<Hsv> wanted = EvenlyTaken(Colors(marks, &FrameMarks::wanted), kMaxPixels);
  ColorMixture mixture = ChooseColorMixture(color, wanted, kMaxComponents).mixture;
  for (ColorComponent& component : mixture.components) {
    component.sigma.saturation = std::max(component.sigma.saturation, kSaturationSigma);
    component.sigma.value = std::max(component.sigma.value, kValueSigma);
  }
  const std::vector<Hsv> others = Colors(marks, &FrameMarks::others);
  const float scale = BestScale(mixture, wanted, others, max_distance);
  for (ColorComponent& component : mixture.components) {
    component.sigma = {scale * component.sigma.hue_deg, scale * component.sigma.saturation,
                       scale * component.sigma.value};
  }
  return mixture;
}

std::vector<std::string> ReplaceColors(const std::map<std::string, std::vector<Hsv>>& samples,
                                       int components, ObjectModel* model) {
  std::vector<std::string> report;
  std::vector<ColorMixture>& colors = model->colors.colors;
  for (const auto& [name, pixels] : samples) {
    const auto found =
        std::find_if(colors.begin(), colors.end(),
                     [&name = name](const auto& color) { return color.name == name; });
    if (found == colors.end()) {
      throw InputError(fmt::format("'{}' is none of the model's colors", name));
    }
    *found = ChooseColorMixture(name, pixels, components).mixture;
    report.push_back(fmt::format("{}: {} Gaussians fitted to {} pixels", name,
                                 found->components.size(), pixels.size()));
    for (const std::string& warning : SampleWarnings(pixels)) {
      report.push_back(fmt::format("{}: {}", name, warning));
    }
  }
  const std::vector<std::string> violations = model->Validate();
  if (!violations.empty()) throw InputError(fmt::format("{}", fmt::join(violations, "; ")));
  for (std::size_t i = 0; i < colors.size(); ++i) {
    if (samples.contains(colors[i].name)) RequireDistinct(model->colors, i);
  }
  return report;
}

std::vector<ColorOverlap> ColorOverlaps(const ColorModel& model, std::size_t color) {
  std::vector<std::size_t> counts(model.colors.size());
  for (std::size_t cell = 0; cell < ColorGrid::kCells; ++cell) {
    const Hsv hsv = ColorGrid::CellColor(cell);
    if (model.colors[color].Mahalanobis(hsv) > model.max_distance) continue;
    for (std::size_t i = 0; i < counts.size(); ++i) {
      counts[i] += i == color || model.colors[i].Mahalanobis(hsv) <= model.max_distance;
    }
  }
  std::vector<ColorOverlap> overlaps;
  for (std::size_t i = 0; i < counts.size(); ++i) {
    if (i == color || counts[i] == 0) continue;
    overlaps.push_back({model.colors[i].name,
                        static_cast<double>(counts[i]) / static_cast<double>(counts[color])});
  }
  return overlaps;
}

void RequireDistinct(const ColorModel& model, std::size_t color) {
  constexpr double kMost = 0.5;
  for (const ColorOverlap& overlap : ColorOverlaps(model, color)) {
    if (overlap.share <= kMost) continue;
    throw InputError(
        fmt::format("{0} cannot be told from {1}: {2:.0f} % of what is {0} is {1} too, expected at "
                    "most {3:.0f} %; mark other pixels, or teach {1} first",
                    model.colors[color].name, overlap.color, 100 * overlap.share, 100 * kMost));
  }
}

ColorScores ScoreColor(const ColorModel& model, const ColorGrid& grid, std::size_t color,
                       std::span<const FrameMarks> marks) {
  const auto label = static_cast<ColorLabel>(color + 1);
  ColorScores scores;
  const GridShare wanted = LabelledShare(grid, label, marks, &FrameMarks::wanted);
  const GridShare others = LabelledShare(grid, label, marks, &FrameMarks::others);
  scores.wanted = wanted.pixels;
  scores.recall = wanted.share;
  scores.others = others.pixels;
  scores.false_share = others.share;
  scores.overlaps = ColorOverlaps(model, color);
  for (std::size_t i = 0; i < marks.size(); ++i) {
    if (marks[i].wanted.empty()) continue;
    if (const auto recall = LeftOutRecall(model, color, marks, i)) {
      scores.left_outs.push_back({marks[i].frame, *recall});
    }
  }
  return scores;
}

std::vector<std::string> TeachingWarnings(std::span<const FrameMarks> marks) {
  constexpr std::size_t kFewFrames = 3;
  constexpr float kOneLight = 1.25F;
  std::vector<std::string> warnings = SampleWarnings(Colors(marks, &FrameMarks::wanted));
  std::vector<float> values;
  for (const FrameMarks& of_frame : marks) {
    if (!of_frame.wanted.empty()) values.push_back(MedianValue(of_frame));
  }
  if (values.empty()) return warnings;
  const auto [darkest, brightest] = std::minmax_element(values.begin(), values.end());
  if (values.size() < kFewFrames) {
    warnings.push_back(
        fmt::format("marked on {} of the frames: mark it on at least {}, in sun and in shade",
                    values.size(), kFewFrames));
  } else if (*brightest < kOneLight * *darkest) {
    warnings.emplace_back("all marked frames are of one lighting: add frames in sun and in shade");
  }
  if (Colors(marks, &FrameMarks::others).empty()) {
    warnings.emplace_back("nothing is marked that it is not: mark what is taken for it");
  }
  return warnings;
}

}  // namespace kestrel
