// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "kestrel/core/geometry/rigid_transform.h"
#include "kestrel/vision/tags/tag_family.h"

namespace kestrel {

// A tag on a board.
struct BoardTag {
  std::string family = "tag36h11";  // a name alone where 'own' has cells
  int id = 0;
  TagGrid own{};          // cells of a tag that is of no family
  double size_m = 0.5;    // side of the square where its black and white borders meet
  bool inverted = false;  // black and white exchanged
  bool over = false;      // printed over larger tags, which do without the cells that it covers
  // Its frame (TagFamily) on the board, whose z = 0 it lies in.
  RigidTransform board_from_tag;

  bool IsOfFamily() const { return own.cells.empty(); }
  // Returns its cells. Throws InputError for a family or an id that is not known.
  TagGrid Grid() const;
  // It, however turned, differs from other tags of its family (of none: from itself, turned) in at
  // least so many cells.
  int MinDistance() const;
};

// A tag as it is printed, in the plane of the board.
struct PrintedTag {
  TagGrid grid;       // inverted where the tag is; kNone where another tag is printed over it
  double cell_m = 0;  // side of a cell
  Eigen::Vector2d center = Eigen::Vector2d::Zero();
  double heading = 0;  // where the tag's x axis points, rad from the board's x to its y

  // Returns the place on the board of a point of the grid: columns and rows from the upper left
  // corner of the drawing, so that a cell's centre is at (column + 0.5, row + 0.5).
  Eigen::Vector2d OnBoard(double column, double row) const;
};

// Tags that are one target: one tag, a bundle side by side, small ones in the empty centre of large
// ones or printed over them. Frame P: that of the board, x and y in the print, z out of its face.
struct TagBoard {
  std::vector<BoardTag> tags;

  // Returns every violation, a line each: no tag, an unknown family or id, a tag that is there
  // twice, a size that is not positive or was meant in millimetres, a tag out of the plane, prints
  // that contradict each other where no tag is said to lie over the other.
  std::vector<std::string> Validate() const;

  // Returns the side of the largest tag (m).
  double LargestSize() const;
  // Returns the board with all sizes and places multiplied by 'factor'.
  TagBoard Scaled(double factor) const;

  // Returns the tags as they are printed, in their order. The board must be valid.
  std::vector<PrintedTag> Printed() const;
};

// Reads a board from YAML text:
//
//   tags:
//     - {family: tag36h11, id: 3, size_m: 0.5}
//     - {id: 7, size_m: 0.1, x_m: 0.4, y_m: -0.1, yaw_deg: 90, inverted: true, over: true}
//
// or the bundle of an apriltag_ros (ROS 1) file of tags: tag_bundles with one item, whose layout
// has id, size, x, y, z, qw, qx, qy, qz; or a fractal marker of the library ArUco
// (ParseFractalMarker). 'family': of tags that name none. 'size_m': side of a fractal marker whose
// file does not give it in metres. Throws InputError that names 'file', line and key. The board may
// be invalid.
TagBoard ParseTagBoard(const std::string& yaml, const std::string& file, const std::string& family,
                       double size_m);

// One tag, or a board from a file, as a target.
struct TagTargetOptions {
  std::string family = "tag36h11";
  int id = 0;
  double size_m = 0.5;
  std::string board{};

  static void Visit(auto& self, auto&& visit) {
    visit("family", self.family,
          "family of the tag: tag36h11, tagStandard41h12, aruco_4x4_50, ...");
    visit("id", self.id, "id of the tag");
    visit("size_m", self.size_m, "side of the square where the tag's black and white borders meet");
    visit("board", self.board,
          "YAML file of a board of several tags, or apriltag_ros' file of a bundle, instead of id "
          "and size; or ArUco's file of a fractal marker, of this size");
  }
  // Includes the violations of the board; a file that cannot be read is one, too.
  std::vector<std::string> ValidateBoard() const;
  // Returns the board. Throws InputError for a file that cannot be read.
  TagBoard Board() const;
};

}  // namespace kestrel
