// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "kestrel/core/camera/camera_model.h"
#include "kestrel/vision/helipad/helipad_detector.h"
#include "kestrel/vision/landing/landing_pattern_detector.h"
#include "kestrel/vision/tags/tag_board.h"
#include "kestrel/vision/tags/tag_board_detector.h"
#include "kestrel/vision/target/target_detector.h"
#include "kestrel/vision/target/target_print.h"
#include "kestrel/vision/targets/other_tag_finder.h"

namespace kestrel {

// A board of tags of any families, as a target.
struct NestedTargetOptions {
  std::string board;
  double size_m = 0.5;

  static void Visit(auto& self, auto&& visit) {
    visit("board", self.board,
          "YAML file of a board of tags of any families and sizes, inside each other or beside "
          "each other, or ArUco's file of a fractal marker");
    visit("size_m", self.size_m,
          "side of a fractal marker's largest square, unless its file has metres");
  }
};

// The target. The options of the ring with a cross are LandingPatternDetectorOptions.
struct TargetOptions {
  static constexpr int kOwnId = -1;
  static constexpr double kOwnSize = 0;

  std::string kind = "ring-cross";
  int id = kOwnId;
  double size_m = kOwnSize;
  TagTargetOptions apriltag;
  TagTargetOptions aruco{.family = "aruco_4x4_50", .board = ""};
  NestedTargetOptions nested;
  TagBoardDetectorOptions tags;
  HelipadDetectorOptions helipad;

  static void Visit(auto& self, auto&& visit) {
    visit("kind", self.kind,
          "what the target is: ring-cross, ring-with-tags (of nested.board, in the ring's frame), "
          "apriltag, aruco, nested, helipad");
    visit("id", self.id,
          "id of the pad where it is one tag (apriltag, aruco); -1: as the kind's options say");
    visit("size_m", self.size_m,
          "size to which all dimensions of the pad are scaled: outer diameter of the ring, side "
          "of the (largest) tag, size of the helipad's frame, or of its H without one; 0: the "
          "dimensions are those of the kind's options");
    visit.Group("apriltag", self.apriltag);
    visit.Group("aruco", self.aruco);
    visit.Group("nested", self.nested);
    visit.Group("tags", self.tags);
    visit.Group("helipad", self.helipad);
  }
  std::vector<std::string> Validate() const;
  // Returns what is allowed but not advisable, a line each (WarningsOfPlainTags). The options must
  // be valid.
  std::vector<std::string> Warnings() const;
};

// Returns the names of all kinds.
std::vector<std::string> TargetKinds();

// Returns under how many headings a pad of this kind looks the same: 1 where it has one heading.
// Nothing for an unknown kind.
std::optional<int> HeadingSymmetryOf(std::string_view kind);

// Returns the ring's options, its pattern scaled to the target's size where it has one.
LandingPatternDetectorOptions RingOfTarget(const TargetOptions& target,
                                           const LandingPatternDetectorOptions& ring);

// Returns the detector of the target. 'ring': options of the kind "ring-cross". Throws InputError
// when the options or the camera are not valid.
std::unique_ptr<const TargetDetector> MakeTargetDetector(
    const CameraModel& camera, const TargetOptions& target,
    const LandingPatternDetectorOptions& ring = {});

// Returns what finds the other tags of the target's family; nothing for a target without tags.
// Throws InputError when the options are not valid.
std::optional<OtherTagFinder> MakeOtherTagFinder(const CameraModel& camera,
                                                 const TargetOptions& target);

// Returns the shape of that detector's pad. Throws InputError when the options of the target are
// not valid.
TargetShape ShapeOfTarget(const TargetOptions& target, const LandingPatternDetectorOptions& ring);

// Returns what is printed on its board. Throws InputError when the options are not valid.
TargetPrint PrintOfTarget(const TargetOptions& target, const LandingPattern& ring);

}  // namespace kestrel
