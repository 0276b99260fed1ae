// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/targets/make_target_detector.h"

#include <algorithm>
#include <iterator>
#include <string_view>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "kestrel/core/base/edit_distance.h"
#include "kestrel/core/base/limits.h"
#include "kestrel/core/base/options.h"
#include "kestrel/vision/tags/plain_tags.h"
#include "kestrel/vision/tags/tag_print.h"
#include "kestrel/vision/targets/ring_with_tags_detector.h"

namespace kestrel {
namespace {

// The options of all kinds.
struct KindOptions {
  const TargetOptions& target;
  const LandingPatternDetectorOptions& ring;
};

struct TargetKind {
  std::string_view name;
  int heading_symmetry;  // headings under which it looks the same
  std::unique_ptr<const TargetDetector> (*make)(const CameraModel&, const KindOptions&);
  TargetShape (*shape)(const KindOptions&);
  TargetPrint (*print)(const TargetOptions&, const LandingPattern&);
  // Violations of the kind's group of TargetOptions.
  std::vector<std::string> (*validate)(const TargetOptions&);
  std::vector<std::string> (*warn)(const TargetOptions&);
  // The tags of a kind that has some; null where there are none.
  TagTargetOptions (*tags)(const TargetOptions&);
};

std::vector<std::string> NoWarnings(const TargetOptions& /*target*/) { return {}; }

bool HasSize(const TargetOptions& target) { return target.size_m != TargetOptions::kOwnSize; }

LandingPattern PatternOf(const TargetOptions& target, const LandingPattern& ring) {
  return HasSize(target) ? Scaled(ring, target.size_m / ring.outer_diameter_m) : ring;
}

std::unique_ptr<const TargetDetector> MakeRingCross(const CameraModel& camera,
                                                    const KindOptions& options) {
  return std::make_unique<LandingPatternDetector>(camera,
                                                  RingOfTarget(options.target, options.ring));
}
TargetShape ShapeOfRingCross(const KindOptions& options) {
  return ShapeOf(PatternOf(options.target, options.ring.pattern));
}

std::vector<std::string> ValidateNoId(const TargetOptions& target) {
  if (target.id == TargetOptions::kOwnId) return {};
  return {fmt::format("id is {}, but a {} has no id", target.id, target.kind)};
}

TagTargetOptions WithId(TagTargetOptions tag, int id) {
  if (id != TargetOptions::kOwnId) tag.id = id;
  return tag;
}

// The kinds that are boards of tags differ in their group of options.
TagTargetOptions Apriltag(const TargetOptions& target) {
  return WithId(target.apriltag, target.id);
}
TagTargetOptions Aruco(const TargetOptions& target) { return WithId(target.aruco, target.id); }
TagTargetOptions Nested(const TargetOptions& target) {
  return {.size_m = target.nested.size_m, .board = target.nested.board};
}

using TagsOf = TagTargetOptions (*)(const TargetOptions&);

const char* GroupOf(TagsOf tags) {
  return tags == Nested ? "nested" : tags == Aruco ? "aruco" : "apriltag";
}

template <TagsOf kTagsOf>
TagBoard BoardOf(const TargetOptions& target) {
  const TagBoard board = kTagsOf(target).Board();
  return HasSize(target) ? board.Scaled(target.size_m / board.LargestSize()) : board;
}

template <TagsOf kTagsOf>
std::unique_ptr<const TargetDetector> MakeTags(const CameraModel& camera,
                                               const KindOptions& options) {
  return std::make_unique<TagBoardDetector>(camera, BoardOf<kTagsOf>(options.target),
                                            options.target.tags);
}
template <TagsOf kTagsOf>
TargetShape ShapeOfTags(const KindOptions& options) {
  return ShapeOf(BoardOf<kTagsOf>(options.target));
}
template <TagsOf kTagsOf>
std::vector<std::string> ValidateTags(const TargetOptions& target) {
  const TagTargetOptions tags = kTagsOf(target);
  std::vector<std::string> violations;
  if (tags.board.empty()) {
    violations = tags.ValidateBoard();
  } else {
    AddViolations(GroupOf(kTagsOf), tags.ValidateBoard(), &violations);
  }
  if (target.id != TargetOptions::kOwnId && !tags.board.empty()) {
    violations.push_back(fmt::format(
        "id is {}, but the ids of the tags are those of the board '{}'", target.id, tags.board));
  }
  return violations;
}
template <TagsOf kTagsOf>
std::vector<std::string> WarningsOfTags(const TargetOptions& target) {
  return WarningsOfPlainTags(kTagsOf(target).Board());
}
std::vector<std::string> ValidateNested(const TargetOptions& target) {
  if (target.nested.board.empty()) return {"nested.board is empty, expected the file of a board"};
  return ValidateTags<Nested>(target);
}

TargetPrint PrintOfRingCross(const TargetOptions& target, const LandingPattern& ring) {
  return PrintOf(PatternOf(target, ring));
}
template <TagsOf kTagsOf>
TargetPrint PrintOfTags(const TargetOptions& target, const LandingPattern& /*ring*/) {
  return PrintOf(BoardOf<kTagsOf>(target));
}
// The tags have their places in the ring's frame, and are scaled with it.
TagBoard BoardWithRing(const TargetOptions& target, const LandingPattern& ring) {
  const TagBoard board = Nested(target).Board();
  return HasSize(target) ? board.Scaled(target.size_m / ring.outer_diameter_m) : board;
}
std::unique_ptr<const TargetDetector> MakeRingWithTags(const CameraModel& camera,
                                                       const KindOptions& options) {
  return std::make_unique<RingWithTagsDetector>(camera, RingOfTarget(options.target, options.ring),
                                                BoardWithRing(options.target, options.ring.pattern),
                                                options.target.tags);
}
TargetShape ShapeOfRingWithTags(const KindOptions& options) {
  return ShapeOf(PatternOf(options.target, options.ring.pattern),
                 BoardWithRing(options.target, options.ring.pattern));
}
TargetPrint PrintOfRingWithTags(const TargetOptions& target, const LandingPattern& ring) {
  TargetPrint print = PrintOf(PatternOf(target, ring));
  PrintOver(PrintOf(BoardWithRing(target, ring)), &print);
  print.can_be_checked = false;
  return print;
}

HelipadDetectorOptions HelipadOf(const TargetOptions& target) {
  HelipadDetectorOptions options = target.helipad;
  if (!HasSize(target)) return options;
  const double size_m = options.frame == "none" ? options.height_m : options.frame_size_m;
  static_cast<Helipad&>(options) = Scaled(options, target.size_m / size_m);
  return options;
}

std::unique_ptr<const TargetDetector> MakeHelipad(const CameraModel& camera,
                                                  const KindOptions& options) {
  return std::make_unique<HelipadDetector>(camera, HelipadOf(options.target));
}
TargetShape ShapeOfHelipad(const KindOptions& options) {
  return ShapeOf(HelipadOf(options.target));
}
TargetPrint PrintOfHelipad(const TargetOptions& target, const LandingPattern& /*ring*/) {
  return PrintOf(HelipadOf(target));
}

// All kinds of pads, a line each.
constexpr TargetKind kTargetKinds[] = {
    {"ring-cross", 4, MakeRingCross, ShapeOfRingCross, PrintOfRingCross, ValidateNoId, NoWarnings,
     nullptr},
    {"ring-with-tags", 1, MakeRingWithTags, ShapeOfRingWithTags, PrintOfRingWithTags,
     ValidateNested, WarningsOfTags<Nested>, Nested},
    {"apriltag", 1, MakeTags<Apriltag>, ShapeOfTags<Apriltag>, PrintOfTags<Apriltag>,
     ValidateTags<Apriltag>, WarningsOfTags<Apriltag>, Apriltag},
    {"aruco", 1, MakeTags<Aruco>, ShapeOfTags<Aruco>, PrintOfTags<Aruco>, ValidateTags<Aruco>,
     WarningsOfTags<Aruco>, Aruco},
    {"nested", 1, MakeTags<Nested>, ShapeOfTags<Nested>, PrintOfTags<Nested>, ValidateNested,
     WarningsOfTags<Nested>, Nested},
    {"helipad", 2, MakeHelipad, ShapeOfHelipad, PrintOfHelipad, ValidateNoId, NoWarnings, nullptr},
};

const TargetKind* FindKind(std::string_view name) {
  const auto* const found = std::find_if(std::begin(kTargetKinds), std::end(kTargetKinds),
                                         [&](const TargetKind& kind) { return kind.name == name; });
  return found == std::end(kTargetKinds) ? nullptr : found;
}

}  // namespace

std::vector<std::string> TargetKinds() {
  std::vector<std::string> names;
  for (const TargetKind& kind : kTargetKinds) names.emplace_back(kind.name);
  return names;
}

std::optional<int> HeadingSymmetryOf(std::string_view kind) {
  const TargetKind* known = FindKind(kind);
  return known != nullptr ? std::optional(known->heading_symmetry) : std::nullopt;
}

std::vector<std::string> TargetOptions::Validate() const {
  if (const TargetKind* known = FindKind(kind)) {
    std::vector<std::string> violations = known->validate(*this);
    if (HasSize(*this)) Require(size_m, Metres(), "size_m", &violations);
    return violations;
  }
  const std::vector<std::string> names = TargetKinds();
  const std::string& nearest = NearestName(kind, names);
  return {
      fmt::format("kind is '{}', expected one of {}{}", kind, fmt::join(names, ", "),
                  IsNearName(kind, nearest) ? fmt::format("; did you mean '{}'?", nearest) : "")};
}

std::vector<std::string> TargetOptions::Warnings() const { return FindKind(kind)->warn(*this); }

LandingPatternDetectorOptions RingOfTarget(const TargetOptions& target,
                                           const LandingPatternDetectorOptions& ring) {
  LandingPatternDetectorOptions sized = ring;
  sized.pattern = PatternOf(target, ring.pattern);
  return sized;
}

std::unique_ptr<const TargetDetector> MakeTargetDetector(
    const CameraModel& camera, const TargetOptions& target,
    const LandingPatternDetectorOptions& ring) {
  RequireValid(target);
  return FindKind(target.kind)->make(camera, {target, ring});
}

std::optional<OtherTagFinder> MakeOtherTagFinder(const CameraModel& camera,
                                                 const TargetOptions& target) {
  RequireValid(target);
  const TagsOf tags = FindKind(target.kind)->tags;
  if (tags == nullptr) return std::nullopt;
  return OtherTagFinder(camera, tags(target).Board());
}

TargetShape ShapeOfTarget(const TargetOptions& target, const LandingPatternDetectorOptions& ring) {
  RequireValid(target);
  return FindKind(target.kind)->shape({target, ring});
}

TargetPrint PrintOfTarget(const TargetOptions& target, const LandingPattern& ring) {
  RequireValid(target);
  RequireValid(ring);
  return FindKind(target.kind)->print(target, ring);
}

}  // namespace kestrel
