// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/targets/other_tag_finder.h"

#include <algorithm>
#include <array>
#include <span>

#include "kestrel/vision/tags/board_model.h"
#include "kestrel/vision/tags/tag_family.h"
#include "kestrel/vision/tags/tag_match.h"
#include "kestrel/vision/tags/tag_search.h"

namespace kestrel {
namespace {

constexpr double kLeastContrast = 20;  // gray values between black and white
constexpr int kTurns = 4;
constexpr std::size_t kMostBits = 64;

// Gray value between those of the black and the white cells that all tags have in common.
struct Threshold {
  double gray = 0;
  bool is_clear = false;  // there is contrast, and no such cell is on the wrong side
};

Threshold ThresholdOf(const TagGrid& layout, std::span<const float> gray) {
  std::array<double, 2> sum{};
  std::array<int, 2> count{};
  for (std::size_t i = 0; i < layout.cells.size(); ++i) {
    if (layout.cells[i] == TagCell::kNone || gray[i] < 0) continue;
    const bool white = layout.cells[i] == TagCell::kWhite;
    sum[white] += gray[i];
    ++count[white];
  }
  if (count[0] == 0 || count[1] == 0) return {};
  const double black = sum[0] / count[0], white = sum[1] / count[1];
  const double middle = 0.5 * (black + white);
  for (std::size_t i = 0; i < layout.cells.size(); ++i) {
    if (layout.cells[i] == TagCell::kNone || gray[i] < 0) continue;
    if ((gray[i] > middle) != (layout.cells[i] == TagCell::kWhite)) return {};
  }
  return {middle, white - black >= kLeastContrast};
}

}  // namespace

OtherTagFinder::OtherTagFinder(const CameraModel& camera, const TagBoard& board)
    : camera_(camera), id_(board.tags.front().id) {
  const BoardTag& tag = board.tags.front();
  if (!tag.IsOfFamily()) return;
  const TagFamily family(tag.family);
  const std::vector<std::string>& names = TagFamily::Names();
  family_ = *std::find(names.begin(), names.end(), tag.family);
  layout_ = tag.Grid();
  const BoardModel model(board);
  dark_inside_ = model.tags.front().dark_inside;
  for (std::size_t i = 0; i < layout_.cells.size(); ++i) {
    if (layout_.cells[i] == TagCell::kNone || !model.tags.front().is_data[i]) continue;
    data_cells_.push_back(i);
    layout_.cells[i] = TagCell::kNone;
  }
  if (data_cells_.size() > kMostBits) return;
  for (int id = 0; id < family.id_count(); ++id) {
    const bool is_own = std::any_of(board.tags.begin(), board.tags.end(), [&](const BoardTag& own) {
      return own.family == tag.family && own.id == id;
    });
    if (!is_own) others_.push_back({BitsOf(family.Grid(id, tag.inverted)), id});
  }
  std::sort(others_.begin(), others_.end(),
            [](const Code& a, const Code& b) { return a.bits < b.bits; });
}

std::uint64_t OtherTagFinder::BitsOf(const TagGrid& grid) const {
  std::uint64_t bits = 0;
  for (const std::size_t cell : data_cells_) {
    bits = bits << 1 | static_cast<std::uint64_t>(grid.cells[cell] == TagCell::kWhite);
  }
  return bits;
}

std::optional<int> OtherTagFinder::Find(const cv::Mat& image, TargetWorkspace* searched) const {
  if (others_.empty()) return std::nullopt;
  auto& buffers = dynamic_cast<TagSearchBuffers&>(*searched);
  for (const TagQuad& quad : buffers.quads.quads) {
    if (quad.dark_inside != dark_inside_) continue;
    if (const auto id = Read(image, quad, &buffers.pad.samples)) return id;
  }
  return std::nullopt;
}

std::optional<int> OtherTagFinder::Read(const cv::Mat& image, const TagQuad& quad,
                                        PadSamples* samples) const {
  const std::optional<Eigen::Matrix3d> homography = HomographyOfSquare(quad.corners);
  if (!homography) return std::nullopt;
  const std::span<const float> gray =
      ReadQuad(image, camera_, *homography, quad.side_px, layout_, samples);
  const Threshold threshold = ThresholdOf(layout_, gray);
  if (!threshold.is_clear) return std::nullopt;
  for (int turn = 0; turn < kTurns; ++turn) {
    std::uint64_t bits = 0;
    bool is_in_view = true;
    for (const std::size_t cell : data_cells_) {
      const auto index = static_cast<int>(cell);
      const float value =
          gray[TurnedIndex(index % layout_.width, index / layout_.width, turn, layout_.width)];
      is_in_view = is_in_view && value >= 0;
      bits = bits << 1 | static_cast<std::uint64_t>(value > threshold.gray);
    }
    if (!is_in_view) return std::nullopt;
    if (const auto id = IdOf(bits)) return id;
  }
  return std::nullopt;
}

std::optional<int> OtherTagFinder::IdOf(std::uint64_t bits) const {
  const auto found = std::lower_bound(others_.begin(), others_.end(), bits,
                                      [](const Code& a, std::uint64_t b) { return a.bits < b; });
  if (found == others_.end() || found->bits != bits) return std::nullopt;
  return found->id;
}

}  // namespace kestrel
