// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include <opencv2/core.hpp>

#include "kestrel/core/camera/camera_model.h"
#include "kestrel/vision/tags/tag_board.h"
#include "kestrel/vision/tags/tag_reader.h"
#include "kestrel/vision/target/target_detector.h"

namespace kestrel {

// Finds a tag of the family of a board's first tag whose id is not on the board: another pad is in
// view than the one that is looked for. Looks at the borders that the search for the board has
// found; reports only what is read without a single wrong cell.
class OtherTagFinder {
 public:
  // 'board' must be valid. One whose first tag is of no family has no other tags.
  OtherTagFinder(const CameraModel& camera, const TagBoard& board);

  // For example "tag36h11"; static text.
  std::string_view family() const { return family_; }
  // Id of the tag that is looked for.
  int id() const { return id_; }

  // Returns the id of another tag in the image, nothing when none is read. 'searched': the
  // workspace with which a detector of the board has just searched this image. Does not allocate.
  std::optional<int> Find(const cv::Mat& image, TargetWorkspace* searched) const;

 private:
  CameraModel camera_;
  std::string_view family_;
  int id_;
  std::vector<int> own_ids_;         // those of the family on the board
  std::optional<TagReader> reader_;  // reads the family, where there is one
};

}  // namespace kestrel
