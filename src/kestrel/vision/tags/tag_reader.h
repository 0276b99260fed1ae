// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <opencv2/core.hpp>

#include "kestrel/core/camera/camera_model.h"
#include "kestrel/vision/search/pad_samples.h"
#include "kestrel/vision/tags/tag_family.h"
#include "kestrel/vision/tags/tag_quads.h"

namespace kestrel {

// A tag of a family as a quad shows it.
struct TagReading {
  int id;
  int turn;                // the tag's first corner is the quad's corner 'turn', clockwise
  int wrong_bits;          // that differ from the tag's
  double decision_margin;  // as TagDetection's
};

// Reads the tags of a family in quads: all ids, in four turns.
class TagReader {
 public:
  // 'inverted': black and white are exchanged. Throws InputError for an unknown family.
  TagReader(const std::string& family, bool inverted);

  // Number of cells that 'samples' must have room for.
  std::size_t cell_count() const { return layout_.cells.size(); }

  // Returns the tag whose bits are most like what a quad shows. Nothing where the border is not
  // clear, a cell is out of view, or more bits are wrong than can be corrected. Does not allocate.
  std::optional<TagReading> Read(const cv::Mat& image, const CameraModel& camera,
                                 const TagQuad& quad, PadSamples* samples) const;

 private:
  std::uint64_t BitsOf(const TagGrid& grid) const;
  std::optional<TagReading> ReadTurn(std::span<const float> gray, double threshold, int turn) const;

  TagGrid layout_;                       // kNone where tags of the family differ
  std::vector<std::size_t> data_cells_;  // cells of the grid where they do
  bool dark_inside_ = true;              // side of the edge of the square that the size refers to
  int most_wrong_ = 0;
  std::vector<std::uint64_t> codes_;  // bits of the data cells of each id; true is white
};

}  // namespace kestrel
