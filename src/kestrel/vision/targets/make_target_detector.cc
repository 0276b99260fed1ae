// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/targets/make_target_detector.h"

#include <algorithm>
#include <iterator>
#include <string_view>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "kestrel/core/base/edit_distance.h"
#include "kestrel/core/base/options.h"

namespace kestrel {
namespace {

// The options of all kinds.
struct KindOptions {
  const TargetOptions& target;
  const LandingPatternDetectorOptions& ring;
};

struct TargetKind {
  std::string_view name;
  std::unique_ptr<const TargetDetector> (*make)(const CameraModel&, const KindOptions&);
  TargetShape (*shape)(const KindOptions&);
};

std::unique_ptr<const TargetDetector> MakeRingCross(const CameraModel& camera,
                                                    const KindOptions& options) {
  return std::make_unique<LandingPatternDetector>(camera, options.ring);
}
TargetShape ShapeOfRingCross(const KindOptions& options) { return ShapeOf(options.ring.pattern); }

// All kinds of pads, a line each.
constexpr TargetKind kTargetKinds[] = {
    {"ring-cross", MakeRingCross, ShapeOfRingCross},
};

const TargetKind* FindKind(std::string_view name) {
  const auto* const found = std::find_if(std::begin(kTargetKinds), std::end(kTargetKinds),
                                         [&](const TargetKind& kind) { return kind.name == name; });
  return found == std::end(kTargetKinds) ? nullptr : found;
}

}  // namespace

std::vector<std::string> TargetOptions::Validate() const {
  if (FindKind(kind) != nullptr) return {};
  std::vector<std::string_view> names;
  for (const TargetKind& known : kTargetKinds) names.push_back(known.name);
  const auto nearest =
      std::min_element(names.begin(), names.end(), [&](std::string_view a, std::string_view b) {
        return EditDistance(kind, a) < EditDistance(kind, b);
      });
  return {fmt::format("kind is '{}', expected one of {}; did you mean '{}'?", kind,
                      fmt::join(names, ", "), *nearest)};
}

std::unique_ptr<const TargetDetector> MakeTargetDetector(
    const CameraModel& camera, const TargetOptions& target,
    const LandingPatternDetectorOptions& ring) {
  RequireValid(target);
  return FindKind(target.kind)->make(camera, {target, ring});
}

TargetShape ShapeOfTarget(const TargetOptions& target, const LandingPatternDetectorOptions& ring) {
  RequireValid(target);
  return FindKind(target.kind)->shape({target, ring});
}

}  // namespace kestrel
