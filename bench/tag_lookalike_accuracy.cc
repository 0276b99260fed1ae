// SPDX-License-Identifier: BSD-3-Clause
// False detections of TagBoardDetector on rendered look-alikes, at its default options: other tags,
// tags with some bits exchanged, grids, windows. Each frame is searched without a hint, and with
// that of a track that takes the look-alike for the tag.
#include <algorithm>
#include <array>
#include <atomic>
#include <cstdint>
#include <cstdlib>
#include <functional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "for_each_index.h"
#include "kestrel/core/base/random.h"
#include "kestrel/core/camera/paper_camera.h"
#include "kestrel/vision/tags/board_model.h"
#include "kestrel/vision/tags/tag_board_detector.h"
#include "kestrel/vision/tags/test_tag_images.h"
#include "report_main.h"

namespace kestrel {
namespace {

constexpr int kTagId = 7;
constexpr double kTagSize = 0.5;  // m

TagCell Other(TagCell cell) {
  if (cell == TagCell::kNone) return cell;
  return cell == TagCell::kWhite ? TagCell::kBlack : TagCell::kWhite;
}

// A tag that is looked for, and prints that are not it.
class Lookalikes {
 public:
  explicit Lookalikes(const std::string& family)
      : family_(family), board_(BoardOfTag(family, kTagId, kTagSize)), model_(board_) {}

  const TagBoard& board() const { return board_; }

  PrintedTag OtherId(Random* random) const {
    int id = random->Integer(0, family_.id_count() - 2);
    if (id >= kTagId) ++id;
    return BoardOfTag(family_.name(), id, kTagSize).Printed().front();
  }
  static PrintedTag OtherFamily(Random* random) {
    const std::array<const char*, 6> kOthers{"tag16h5",        "tag25h9",       "tagStandard41h12",
                                             "tagCustom48h12", "aruco_5x5_250", "aruco_6x6_250"};
    const std::string family = kOthers[random->Integer(0, static_cast<int>(kOthers.size()) - 1)];
    return BoardOfTag(family, random->Integer(0, 9), kTagSize).Printed().front();
  }
  // Half of the bits by which the family's tags differ, so that another tag is as near, and up to
  // four more.
  PrintedTag WithWrongBits(Random* random) const {
    const TagModel& tag = model_.tags.front();
    std::vector<std::size_t> data;
    for (std::size_t i = 0; i < tag.is_data.size(); ++i) {
      if (tag.is_data[i]) data.push_back(i);
    }
    PrintedTag printed = tag.printed;
    for (int left = (family_.min_distance() + 1) / 2 + random->Integer(0, 4); left > 0; --left) {
      const int last = static_cast<int>(data.size()) - 1;
      const auto chosen = data.begin() + random->Integer(0, last);
      printed.grid.cells[*chosen] = Other(printed.grid.cells[*chosen]);
      data.erase(chosen);
    }
    return printed;
  }
  PrintedTag Inverted(Random* /*random*/) const {
    PrintedTag printed = model_.tags.front().printed;
    for (TagCell& cell : printed.grid.cells) cell = Other(cell);
    return printed;
  }
  PrintedTag Mirrored(Random* /*random*/) const {
    PrintedTag printed = model_.tags.front().printed;
    const TagGrid grid = printed.grid;
    for (int row = 0; row < grid.width; ++row) {
      for (int column = 0; column < grid.width; ++column) {
        printed.grid.cells[row * grid.width + column] = grid.at(grid.width - 1 - column, row);
      }
    }
    return printed;
  }
  // The border of the tag, with bits at random.
  PrintedTag RandomBits(Random* random) const {
    const TagModel& tag = model_.tags.front();
    PrintedTag printed = tag.printed;
    for (std::size_t i = 0; i < tag.is_data.size(); ++i) {
      if (tag.is_data[i]) {
        printed.grid.cells[i] = random->Chance(0.5) ? TagCell::kWhite : TagCell::kBlack;
      }
    }
    return printed;
  }
  static PrintedTag Checkers(Random* random) {
    const int square = random->Integer(1, 3);
    return Drawn(random->Integer(6, 12), [square](int column, int row, int /*width*/) {
      return (column / square + row / square) % 2 == 0;
    });
  }
  static PrintedTag Window(Random* random) {
    const int pane = random->Integer(2, 4);
    return Drawn(pane * random->Integer(2, 4) + 1, [pane](int column, int row, int /*width*/) {
      return column % pane == 0 || row % pane == 0;
    });
  }
  // As of a two-dimensional code of another kind: random cells with three squares in the corners.
  static PrintedTag OtherCode(Random* random) {
    const std::uint64_t seed = random->Bits();
    return Drawn(21, [seed](int column, int row, int width) {
      const auto in_corner = [&](int x, int y) {
        const int ring = std::max(std::abs(x - 3), std::abs(y - 3));
        return ring == 3 || ring < 2;
      };
      const int right = width - 1 - column;
      const int below = width - 1 - row;
      if (column < 8 && row < 8) return column < 7 && row < 7 && in_corner(column, row);
      if (right < 8 && row < 8) return right < 7 && row < 7 && in_corner(right, row);
      if (column < 8 && below < 8) return column < 7 && below < 7 && in_corner(column, below);
      Random cell(seed + static_cast<std::uint64_t>(row * width + column));
      return cell.Chance(0.5);
    });
  }

 private:
  // A board of black and white cells; 'is_black' of column, row and width.
  template <class IsBlack>
  static PrintedTag Drawn(int width, const IsBlack& is_black) {
    PrintedTag printed;
    printed.grid.width = printed.grid.border_width = width;
    printed.cell_m = kTagSize / width;
    for (int row = 0; row < width; ++row) {
      for (int column = 0; column < width; ++column) {
        printed.grid.cells.push_back(is_black(column, row, width) ? TagCell::kBlack
                                                                  : TagCell::kWhite);
      }
    }
    return printed;
  }

  TagFamily family_;
  TagBoard board_;
  BoardModel model_;
};

struct Kind {
  std::string name;
  std::function<PrintedTag(Random*)> print;
};

std::vector<Kind> KindsOf(const Lookalikes& of) {
  return {
      {"another id", [&](Random* random) { return of.OtherId(random); }},
      {"another family", Lookalikes::OtherFamily},
      {"wrong bits", [&](Random* random) { return of.WithWrongBits(random); }},
      {"inverted", [&](Random* random) { return of.Inverted(random); }},
      {"mirrored", [&](Random* random) { return of.Mirrored(random); }},
      {"random bits", [&](Random* random) { return of.RandomBits(random); }},
      {"checkers", Lookalikes::Checkers},
      {"window", Lookalikes::Window},
      {"another code", Lookalikes::OtherCode},
  };
}

// Half of the paper's camera: less to render.
CameraIntrinsics SmallCamera() {
  CameraIntrinsics camera = PaperCamera();
  camera.width_px /= 2;
  camera.height_px /= 2;
  camera.fx_px /= 2;
  camera.fy_px /= 2;
  camera.cx_px /= 2;
  camera.cy_px /= 2;
  return camera;
}

struct Counts {
  std::atomic<int> searched = 0, followed = 0;  // false detections
};

void Search(const Kind& kind, const TagRenderer& renderer, const TagBoardDetector& detector,
            Random random, Counts* counts) {
  TagImageOptions taken;
  taken.noise = random.Uniform(1, 6);
  taken.blur_px = random.Uniform(0.3, 0.9);
  taken.contrast = random.Uniform(0.4, 1);
  taken.motion_px = random.Chance(0.3) ? random.Uniform(1, 4) : 0;
  taken.shadow = random.Chance(0.2);
  constexpr double kLeastHeight = 0.4, kMostHeight = 5;  // m
  const double height = random.Uniform(kLeastHeight, kMostHeight);
  const RigidTransform pose = RandomBoardBelow(height, 0.5, 0.2, &random);
  const PrintedTag print = kind.print(&random);
  const cv::Mat image = renderer.Render({print}, pose, taken, random.Bits());
  const auto workspace = detector.MakeWorkspace();
  TargetHint hint;
  counts->searched += detector.Detect(image, hint, *workspace).detection.has_value();
  hint.up_in_camera = pose.rotation * Eigen::Vector3d::UnitZ();
  hint.rotation_in_camera = pose.rotation;
  hint.center_in_camera = pose.translation;
  hint.center_sigma_m = 0.03 + 0.02 * height;
  counts->followed += detector.Detect(image, hint, *workspace).detection.has_value();
}

int Run(int frames, std::uint64_t seed) {
  const CameraModel camera(SmallCamera());
  const TagRenderer renderer(camera);
  fmt::print(
      "| tag | look-alike | frames | false without a hint | false with a track's hint |\n"
      "|---|---|---|---|---|\n");
  for (const std::string family : {"tag36h11", "aruco_4x4_50"}) {
    const Lookalikes lookalikes(family);
    const TagBoardDetector detector(camera, lookalikes.board(), {});
    const std::vector<Kind> kinds = KindsOf(lookalikes);
    const int of_each = frames / (2 * static_cast<int>(kinds.size()));
    for (const Kind& kind : kinds) {
      Counts counts;
      ForEachIndex(static_cast<std::size_t>(of_each), [&](std::size_t i) {
        Search(kind, renderer, detector, Random(seed + 7919 * i), &counts);
      });
      fmt::print("| {} | {} | {} | {} | {} |\n", family, kind.name, of_each, counts.searched.load(),
                 counts.followed.load());
    }
  }
  return 0;
}

}  // namespace
}  // namespace kestrel

int main(int argc, char** argv) {
  CLI::App app("False detections of tags on rendered look-alikes");
  int frames = 10000;
  std::uint64_t seed = 1;
  app.add_option("--frames", frames, "number of look-alikes, of two tags and nine kinds");
  app.add_option("--seed", seed, "of the rendered frames");
  CLI11_PARSE(app, argc, argv);
  return kestrel::ReportMain([&] { return kestrel::Run(frames, seed); });
}
