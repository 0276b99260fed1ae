// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace kestrel {

// A cell of a printed tag. kNone: not a part of the tag, whatever is printed there (the corners of
// tagCircle21h7, the empty centre of tagCustom48h12).
enum class TagCell : std::uint8_t { kNone, kBlack, kWhite };

// A tag as a square of cells, upright as its library draws it.
struct TagGrid {
  int width = 0;         // cells per side, all that belongs to the tag
  int border_width = 0;  // cells per side of the square that the tag's size refers to, centred
  std::vector<TagCell> cells;  // row by row from the upper left

  TagCell at(int column, int row) const { return cells[row * width + column]; }
  // Cells between the edge of the drawing and the square that the size refers to.
  int margin() const { return (width - border_width) / 2; }
  // Returns whether tags of a family may differ in a cell. Those on both sides of the square's edge
  // are all tags' own.
  bool IsDataCell(int column, int row) const;
};

// Returns how many of 'bits' may be misread in tags that differ in 'min_distance' bits: with more
// it may be another tag, and of few bits chance makes too many.
int MostWrongBits(int min_distance, int bits);

// Returns a tag in ArUco's layout: side x side bits (true is white), row by row from the upper
// left, in a black border of one cell and the white margin.
TagGrid SquareTag(int side, const std::vector<bool>& bits);

// Returns in how many cells a tag differs from itself, turned to where it is most alike.
int TurnDistance(const TagGrid& grid);

// A family of tags: the AprilTag families of libapriltag by its names ("tag36h11",
// "tagStandard41h12", "tagCircle21h7", ...) and the ArUco dictionaries of OpenCV ("aruco_4x4_50",
// ... "aruco_original"). A tag has the margin of one white cell that its finders need, ArUco too.
//
// The size of a tag is the side of the square whose edge the finders look for: where black and
// white borders meet. Its frame: origin in the centre, x right, y up, z out of the face, for the
// picture as the library draws it. (OpenCV's own drawings of AprilTags are turned by 180 degrees.)
class TagFamily {
 public:
  // OpenCV's names are known, too: "DICT_4X4_50", "4x4_50", "DICT_APRILTAG_36h11". Throws
  // InputError for an unknown name, with the nearest one.
  explicit TagFamily(const std::string& name);

  // All names, in the order in which they are explained.
  static const std::vector<std::string>& Names();

  const std::string& name() const { return name_; }
  int id_count() const { return static_cast<int>(codes_.size()); }
  // Two tags of the family, however turned, differ in at least so many bits.
  int min_distance() const { return min_distance_; }
  // Cells per side: of the whole tag, and of the square that the size refers to.
  int width() const { return width_; }
  int border_width() const { return border_width_; }

  // Returns a tag's cells. 'inverted': black and white exchanged. Throws InputError for an id that
  // the family does not have.
  TagGrid Grid(int id, bool inverted = false) const;

 private:
  struct BitPlace {
    int column;
    int row;
  };

  void ReadAprilTag();
  void ReadAruco(int side, int id_count, int corrected_bits);

  std::string name_;
  int width_ = 0;
  int border_width_ = 0;
  bool white_inside_ = false;  // whether the square is white inside its edge, black outside
  int min_distance_ = 0;
  std::vector<BitPlace> bits_;        // place of each bit in the grid
  std::vector<std::uint64_t> codes_;  // by id; the first bit is the highest of bits_.size()
};

}  // namespace kestrel
