// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/tags/board_reading.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>

#include "kestrel/vision/tags/cell_agreement.h"
#include "kestrel/vision/tags/tag_family.h"

namespace kestrel {
namespace {

constexpr double kLeastBorderContrast = 6;  // gray values between its white and its black square
constexpr double kOtherOdds = 6;            // against the board's tag: two clear bits

std::span<const float> ReadCellsAt(const cv::Mat& image, const CameraModel& camera,
                                   const RigidTransform& pose, const TagModel& tag, double cell_px,
                                   PadSamples* samples) {
  samples->Place(camera, pose, tag.cell_centers);
  return samples->ReadCells(image, tag.grid().width, cell_px);
}

// Gray values of the black and the white square that all tags have: of the cells that are no data.
struct SquareGrays {
  double threshold = 0;  // gray value between black and white
  double contrast = 0;   // white minus black; 0 where one of them is out of view
};

SquareGrays SquareGraysOf(const TagModel& tag, std::span<const float> gray) {
  double sum[2] = {0, 0};
  int count[2] = {0, 0};
  for (std::size_t i = 0; i < gray.size(); ++i) {
    const TagCell cell = tag.grid().cells[i];
    if (tag.is_data[i] || cell == TagCell::kNone || gray[i] < 0) continue;
    const bool white = cell == TagCell::kWhite;
    sum[white] += gray[i];
    ++count[white];
  }
  if (count[0] == 0 || count[1] == 0) return {};
  const double black = sum[0] / count[0];
  const double white = sum[1] / count[1];
  return {0.5 * (black + white), white - black};
}

// Returns the one of 'grids' of which the fewest data cells are on the wrong side of the threshold.
const TagGrid* MostLikeGrid(const std::vector<TagGrid>& grids, const TagModel& tag,
                            std::span<const float> gray, double threshold) {
  const TagGrid* best = nullptr;
  int fewest = std::numeric_limits<int>::max();
  for (const TagGrid& grid : grids) {
    int wrong = 0;
    for (std::size_t i = 0; i < gray.size() && wrong < fewest; ++i) {
      if (!tag.is_data[i] || grid.cells[i] == TagCell::kNone) continue;
      wrong += (gray[i] > threshold) != (grid.cells[i] == TagCell::kWhite);
    }
    if (wrong >= fewest) continue;
    fewest = wrong;
    best = &grid;
  }
  return best;
}

bool AllDataIsInView(const TagModel& tag, std::span<const float> gray) {
  for (std::size_t i = 0; i < gray.size(); ++i) {
    if (tag.is_data[i] && tag.grid().cells[i] != TagCell::kNone && gray[i] < 0) return false;
  }
  return true;
}

bool ShowsOther(const TagModel& tag, const std::vector<TagGrid>& grids, double cell_px,
                std::span<const float> gray) {
  const SquareGrays squares = SquareGraysOf(tag, gray);
  if (squares.contrast < kLeastBorderContrast || !AllDataIsInView(tag, gray)) return false;
  const TagGrid* const grid = MostLikeGrid(grids, tag, gray, squares.threshold);
  if (grid == nullptr) return false;
  const TagAgreement other = CompareCells(*grid, tag.is_data, cell_px, gray);
  // The more tags there are, the likelier it is that chance makes one of them.
  const double odds = kExpectedOdds + std::log(static_cast<double>(grids.size()));
  return other.wrong <= tag.most_wrong && other.evidence > odds &&
         other.evidence >
             CompareCells(tag.grid(), tag.is_data, cell_px, gray).evidence + kOtherOdds;
}

// Returns the tag of this id as it would be printed in the place of 'tag'.
TagGrid InPlaceOf(const PrintedTag& tag, bool inverted, const TagFamily& family, int id) {
  TagGrid grid = family.Grid(id, inverted);
  for (std::size_t i = 0; i < grid.cells.size(); ++i) {
    if (tag.grid.cells[i] == TagCell::kNone) grid.cells[i] = TagCell::kNone;
  }
  return grid;
}

}  // namespace

BoardReading ReadBoard(const cv::Mat& image, const CameraModel& camera, const BoardModel& board,
                       const RigidTransform& camera_from_board, PadSamples* samples,
                       DimSample dim) {
  BoardReading reading;
  for (std::size_t index = 0; index < board.tags.size(); ++index) {
    const TagModel& tag = board.tags[index];
    const double cell_px = tag.StrokePx(camera, camera_from_board);
    if (cell_px < PadPart::kLeastStrokePx) continue;
    const std::span<const float> gray =
        ReadCellsAt(image, camera, camera_from_board, tag, cell_px, samples);
    const TagAgreement agreement = CompareCells(tag.grid(), tag.is_data, cell_px, gray, dim);
    if (agreement.wrong > tag.most_wrong || agreement.evidence <= 0) continue;
    reading.evidence += agreement.evidence;
    reading.parts.Add({"tag", index, cell_px * tag.grid().border_width});
  }
  return reading;
}

OtherTags::OtherTags(const TagBoard& board) {
  const std::vector<PrintedTag> printed = board.Printed();
  for (std::size_t i = 0; i < printed.size(); ++i) {
    const BoardTag& tag = board.tags[i];
    std::vector<TagGrid>& grids = grids_.emplace_back();
    if (!tag.IsOfFamily()) continue;
    const TagFamily family(tag.family);
    for (int id = 0; id < family.id_count(); ++id) {
      const bool own = std::any_of(
          board.tags.begin(), board.tags.end(),
          [&](const BoardTag& other) { return other.family == tag.family && other.id == id; });
      if (!own) grids.push_back(InPlaceOf(printed[i], tag.inverted, family, id));
    }
  }
}

bool OtherTags::IsRead(const cv::Mat& image, const CameraModel& camera, const BoardModel& board,
                       const RigidTransform& camera_from_board, const SeenParts& read,
                       PadSamples* samples) const {
  for (std::size_t index = 0; index < board.tags.size(); ++index) {
    const std::span<const SeenPart> parts = read.all();
    if (std::any_of(parts.begin(), parts.end(),
                    [&](const SeenPart& part) { return part.tag == index; })) {
      continue;
    }
    const TagModel& tag = board.tags[index];
    const double cell_px = tag.StrokePx(camera, camera_from_board);
    if (cell_px < PadPart::kLeastStrokePx) continue;
    const std::span<const float> gray =
        ReadCellsAt(image, camera, camera_from_board, tag, cell_px, samples);
    if (ShowsOther(tag, grids_[index], cell_px, gray)) return true;
  }
  return false;
}

}  // namespace kestrel
