// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/tags/tag_reader.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "kestrel/vision/tags/tag_match.h"

namespace kestrel {
namespace {

// Returns the gray value between those of the black and the white cells that all tags have in
// common. Nothing without contrast, or where such a cell is on the wrong side.
std::optional<double> ThresholdOf(const TagGrid& layout, std::span<const float> gray) {
  std::array<double, 2> sum{};
  std::array<int, 2> count{};
  for (std::size_t i = 0; i < layout.cells.size(); ++i) {
    if (layout.cells[i] == TagCell::kNone || gray[i] < 0) continue;
    const bool white = layout.cells[i] == TagCell::kWhite;
    sum[white] += gray[i];
    ++count[white];
  }
  if (count[0] == 0 || count[1] == 0) return std::nullopt;
  const double black = sum[0] / count[0], white = sum[1] / count[1];
  const double middle = 0.5 * (black + white);
  constexpr double kLeastContrast = 20;  // gray values
  if (white - black < kLeastContrast) return std::nullopt;
  for (std::size_t i = 0; i < layout.cells.size(); ++i) {
    if (layout.cells[i] == TagCell::kNone || gray[i] < 0) continue;
    if ((gray[i] > middle) != (layout.cells[i] == TagCell::kWhite)) return std::nullopt;
  }
  return middle;
}

}  // namespace

TagReader::TagReader(const std::string& family, bool inverted) {
  const TagFamily tags(family);
  layout_ = tags.Grid(0, inverted);
  dark_inside_ = layout_.at(layout_.margin(), layout_.margin()) == TagCell::kBlack;
  for (std::size_t i = 0; i < layout_.cells.size(); ++i) {
    const int cell = static_cast<int>(i);
    if (layout_.cells[i] == TagCell::kNone ||
        !layout_.IsDataCell(cell % layout_.width, cell / layout_.width)) {
      continue;
    }
    data_cells_.push_back(i);
    layout_.cells[i] = TagCell::kNone;
  }
  most_wrong_ = MostWrongBits(tags.min_distance(), static_cast<int>(data_cells_.size()));
  for (int id = 0; id < tags.id_count(); ++id) codes_.push_back(BitsOf(tags.Grid(id, inverted)));
}

std::uint64_t TagReader::BitsOf(const TagGrid& grid) const {
  std::uint64_t bits = 0;
  for (const std::size_t cell : data_cells_) {
    bits = bits << 1 | static_cast<std::uint64_t>(grid.cells[cell] == TagCell::kWhite);
  }
  return bits;
}

std::optional<TagReading> TagReader::Read(const cv::Mat& image, const CameraModel& camera,
                                          const TagQuad& quad, PadSamples* samples) const {
  if (quad.dark_inside != dark_inside_) return std::nullopt;
  const std::optional<Eigen::Matrix3d> homography = HomographyOfSquare(quad.corners);
  if (!homography) return std::nullopt;
  const std::span<const float> gray =
      ReadQuad(image, camera, *homography, quad.side_px, layout_, samples);
  const std::optional<double> threshold = ThresholdOf(layout_, gray);
  if (!threshold) return std::nullopt;
  constexpr int kTurns = 4;
  std::optional<TagReading> best;
  for (int turn = 0; turn < kTurns; ++turn) {
    const std::optional<TagReading> reading = ReadTurn(gray, *threshold, turn);
    if (reading && (!best || reading->wrong_bits < best->wrong_bits)) best = reading;
  }
  return best;
}

std::optional<TagReading> TagReader::ReadTurn(std::span<const float> gray, double threshold,
                                              int turn) const {
  std::uint64_t bits = 0;
  std::array<double, 2> distance{};  // from the threshold, of black and white bits
  std::array<int, 2> count{};
  for (const std::size_t cell : data_cells_) {
    const int index = static_cast<int>(cell);
    const float value =
        gray[TurnedIndex(index % layout_.width, index / layout_.width, turn, layout_.width)];
    if (value < 0) return std::nullopt;
    const bool white = value > threshold;
    bits = bits << 1 | static_cast<std::uint64_t>(white);
    distance[white] += std::abs(value - threshold);
    ++count[white];
  }
  const auto wrong = [bits](std::uint64_t code) { return std::popcount(code ^ bits); };
  const auto nearest =
      std::min_element(codes_.begin(), codes_.end(),
                       [&](std::uint64_t a, std::uint64_t b) { return wrong(a) < wrong(b); });
  if (wrong(*nearest) > most_wrong_) return std::nullopt;
  // libapriltag counts one bit more of each colour, which may have none.
  const double margin = std::min(distance[0] / (count[0] + 1), distance[1] / (count[1] + 1));
  return TagReading{static_cast<int>(nearest - codes_.begin()), turn, wrong(*nearest), margin};
}

}  // namespace kestrel
