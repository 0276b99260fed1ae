// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/objects/color/color_samples.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

namespace kestrel {
namespace {

constexpr double kBin_deg = 360.0 / HueSaturationHistogram::kHues;

// Log-likelihood over all components, up to a constant that is the same for every mixture.
double LogLikelihood(const ColorMixture& mixture, std::span<const Hsv> samples) {
  double sum = 0;
  for (const Hsv& sample : samples) {
    double density = std::numeric_limits<double>::min();
    for (const ColorComponent& component : mixture.components) {
      density += std::exp(component.LogDensity(sample));
    }
    sum += std::log(density);
  }
  return sum;
}

double Criterion(const ColorMixture& mixture, std::span<const Hsv> samples) {
  // Three means, three deviations and one correlation per component; the weights sum to a constant.
  const double parameters = 8.0 * mixture.components.size() - 1;
  return parameters * std::log(samples.size()) - 2 * LogLikelihood(mixture, samples);
}

template <class Condition>
double Share(std::span<const Hsv> samples, const Condition& condition) {
  return static_cast<double>(std::count_if(samples.begin(), samples.end(), condition)) /
         static_cast<double>(samples.size());
}

}  // namespace

void HueSaturationHistogram::Add(const Hsv& color) {
  const int hue = std::clamp(static_cast<int>(color.hue_deg / kBin_deg), 0, kHues - 1);
  const int saturation =
      std::clamp(static_cast<int>(color.saturation * kSaturations), 0, kSaturations - 1);
  ++counts_[saturation * kHues + hue];
}

double HueSaturationHistogram::CutHue_deg() const {
  // The middle of the longest run of hues without a sample, around the circle.
  std::array<bool, kHues> is_empty;
  for (int hue = 0; hue < kHues; ++hue) {
    is_empty[hue] = true;
    for (int saturation = 0; saturation < kSaturations; ++saturation) {
      is_empty[hue] = is_empty[hue] && At(hue, saturation) == 0;
    }
  }
  int run = 0;
  int longest = 0;
  int end = 0;
  for (int i = 0; i < 2 * kHues; ++i) {
    run = is_empty[i % kHues] ? run + 1 : 0;
    if (run <= longest) continue;
    longest = run;
    end = i + 1;
  }
  if (longest == 0 || longest >= kHues) return 0;
  return kBin_deg * ((end - longest / 2) % kHues);
}

std::vector<std::string> SampleWarnings(std::span<const Hsv> samples) {
  constexpr std::size_t kFew = 200;
  constexpr double kManyGray = 0.1;
  constexpr double kManyClipped = 0.05;
  std::vector<std::string> warnings;
  if (samples.size() < kFew) {
    warnings.push_back(fmt::format("only {} pixels: mark at least {}", samples.size(), kFew));
  }
  if (samples.empty()) return warnings;
  const double gray = Share(samples, [](const Hsv& color) { return color.saturation < 0.15F; });
  if (gray > kManyGray) {
    warnings.push_back(fmt::format(
        "{:.0f} % of the pixels are nearly gray (saturation below 0.15): their hue is mostly noise",
        100 * gray));
  }
  const double bright = Share(samples, [](const Hsv& color) { return color.value > 0.99F; });
  if (bright > kManyClipped) {
    warnings.push_back(
        fmt::format("{:.0f} % of the pixels are as bright as the camera can tell: expose shorter",
                    100 * bright));
  }
  const double dark = Share(samples, [](const Hsv& color) { return color.value < 0.06F; });
  if (dark > kManyClipped) {
    warnings.push_back(
        fmt::format("{:.0f} % of the pixels are nearly black: expose longer", 100 * dark));
  }
  return warnings;
}

std::vector<Hsv> EvenlyTaken(std::span<const Hsv> samples, std::size_t count) {
  if (samples.size() <= count) return {samples.begin(), samples.end()};
  std::vector<Hsv> taken(count);
  for (std::size_t i = 0; i < count; ++i) taken[i] = samples[i * samples.size() / count];
  return taken;
}

MixtureChoice ChooseColorMixture(const std::string& name, std::span<const Hsv> samples,
                                 int max_components) {
  constexpr std::size_t kMaxSamples = 2000;
  const std::vector<Hsv> taken = EvenlyTaken(samples, kMaxSamples);
  MixtureChoice choice;
  int best = 0;
  for (int count = 1; count <= max_components; ++count) {
    choice.criteria.push_back(Criterion(FitColorMixture(name, taken, count), taken));
    if (choice.criteria.back() < choice.criteria[best]) best = count - 1;
  }
  choice.mixture = FitColorMixture(name, samples, best + 1);
  return choice;
}

}  // namespace kestrel
