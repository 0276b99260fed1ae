// SPDX-License-Identifier: BSD-3-Clause
// Phantom tags: every id of every family against pictures without tags (windows with a lamp,
// letters, buttons, wheels, logos, scratched ground, tiles; frames of a folder), and how often what
// is said of a tag is true, beside rendered tags. All quads of a picture are read once; a search is
// made for those ids alone that a quad resembles.
#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <filesystem>
#include <map>
#include <mutex>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <opencv2/imgproc.hpp>

#include "for_each_index.h"
#include "kestrel/core/base/random.h"
#include "kestrel/io/recording/media/image_file.h"
#include "kestrel/vision/tags/tag_match.h"
#include "kestrel/vision/tags/tag_search.h"
#include "kestrel/vision/tags/test_tag_images.h"
#include "kestrel/vision/tags/test_tagless_pictures.h"
#include "report_main.h"

namespace kestrel {
namespace {

constexpr double kTagSize = 0.5;  // m

// Quality above which a detection of the bin counts, and its name.
constexpr std::array<double, 5> kBinEdges{0.5, 0.7, 0.9, 0.99, 1.0 + 1e-9};
constexpr double kAccepted = 0.7;  // default of tags.min_quality

CameraModel CameraOf(cv::Size size) {
  return CameraModel(CameraIntrinsics{.width_px = size.width,
                                      .height_px = size.height,
                                      .fx_px = static_cast<double>(size.width),
                                      .fy_px = static_cast<double>(size.width),
                                      .cx_px = 0.5 * size.width,
                                      .cy_px = 0.5 * size.height,
                                      .distortion = {}});
}

// --- The ids ---

// The data bits of all ids of a family in four turns, to compare with those of a quad.
struct Dictionary {
  std::string family;
  TagGrid layout;  // with the borders of all ids
  bool dark_inside;
  std::vector<int> data;           // cells that are data
  std::vector<int> borders;        // and those that all ids have
  std::vector<std::uint64_t> ids;  // bits of each id

  explicit Dictionary(const std::string& name) : family(name) {
    const TagFamily of(name);
    const TagModel model = BoardModel(BoardOfTag(name, 0, kTagSize)).tags.front();
    layout = model.grid();
    dark_inside = model.dark_inside;
    for (std::size_t i = 0; i < layout.cells.size(); ++i) {
      if (layout.cells[i] == TagCell::kNone) continue;
      (model.is_data[i] ? data : borders).push_back(static_cast<int>(i));
    }
    for (int id = 0; id < of.id_count(); ++id) {
      const TagGrid grid = of.Grid(id);
      std::uint64_t bits = 0;
      for (const int cell : data) bits = 2 * bits + (grid.cells[cell] == TagCell::kWhite);
      ids.push_back(bits);
    }
  }

  // Adds the ids that the gray values of the layout's cells in any turn are nearly those of.
  void AddLike(std::span<const float> gray, std::set<int>* like) const {
    double sum[2] = {0, 0};
    int count[2] = {0, 0};
    for (const int cell : borders) {
      if (gray[cell] < 0) continue;
      const bool white = layout.cells[cell] == TagCell::kWhite;
      sum[white] += gray[cell];
      ++count[white];
    }
    if (count[0] == 0 || count[1] == 0) return;
    const double threshold = 0.5 * (sum[0] / count[0] + sum[1] / count[1]);
    const int most = 2 + static_cast<int>(data.size()) / 12;
    for (int turn = 0; turn < 4; ++turn) {
      std::uint64_t bits = 0;
      for (const int cell : data) {
        const int at = TurnedIndex(cell % layout.width, cell / layout.width, turn, layout.width);
        bits = 2 * bits + (gray[at] > threshold);
      }
      for (std::size_t id = 0; id < ids.size(); ++id) {
        if (std::popcount(bits ^ ids[id]) <= most) like->insert(static_cast<int>(id));
      }
    }
  }
};

// Returns each family once: the largest of ArUco's dictionaries of a size has the ids of all.
std::vector<Dictionary> Dictionaries() {
  std::vector<Dictionary> all;
  for (const std::string& name : TagFamily::Names()) {
    const bool is_part =
        name.starts_with("aruco_") && !name.ends_with("_1000") && name != "aruco_original";
    if (!is_part) all.emplace_back(name);
  }
  return all;
}

// --- The search ---

struct Counts {
  std::array<int, kBinEdges.size()> right{}, wrong{};  // by quality
  int accepted = 0;                                    // of the wrong ones
  int searched = 0;

  void Add(double quality, bool is_right) {
    const auto bin = std::upper_bound(kBinEdges.begin(), kBinEdges.end(), quality);
    ++(is_right ? right : wrong)[bin - kBinEdges.begin()];
    accepted += !is_right && quality >= kAccepted;
  }
  void Add(const Counts& other) {
    for (std::size_t i = 0; i < right.size(); ++i) {
      right[i] += other.right[i];
      wrong[i] += other.wrong[i];
    }
    accepted += other.accepted;
    searched += other.searched;
  }
};

using FamilyCounts = std::map<std::string, Counts>;

// Finds tags of any family in the images of one camera.
class AnyTagFinder {
 public:
  explicit AnyTagFinder(const CameraModel& camera) : camera_(camera), finder_(camera) {}

  // Returns the detection of a tag, however unlikely.
  std::optional<TargetDetection> Find(const cv::Mat& image, const std::string& family,
                                      int id) const {
    const BoardModel board(BoardOfTag(family, id, kTagSize));
    const PadAlignment alignment(camera_, board.tags);
    TagSearchBuffers buffers;
    buffers.pad.samples.Reserve(board.most_cells);
    alignment.Reserve(&buffers.pad.alignment);
    constexpr double kLevelSigmaDeg = 3, kPartFactor = 1.3, kPartMarginPx = 8;
    const TagSearchModels models{
        {camera_, alignment, board.radius_m, kLevelSigmaDeg, kPartFactor, kPartMarginPx},
        board,
        finder_,
        kLeastQuality};
    return TagSearch(models, image, {}, &buffers).Run().detection;
  }

  // Returns the ids of each dictionary that a quad of the image resembles.
  std::vector<std::set<int>> Like(const cv::Mat& image,
                                  const std::vector<Dictionary>& dictionaries) const {
    std::vector<std::set<int>> like(dictionaries.size());
    TagQuadBuffers buffers;
    const cv::Rect whole(0, 0, image.cols, image.rows);
    finder_.Begin(image, whole, &buffers);
    for (int step = 0; step < 2 * PlaneBorders::kPasses; ++step) {
      if (step == PlaneBorders::kPasses) finder_.BeginLinear(image, whole, &buffers);
      for (const TagQuad& quad : finder_.Find(whole, step % PlaneBorders::kPasses, &buffers)) {
        AddLike(image, quad, dictionaries, &like);
      }
    }
    return like;
  }

 private:
  static constexpr double kLeastQuality = 0.01;

  void AddLike(const cv::Mat& image, const TagQuad& quad,
               const std::vector<Dictionary>& dictionaries,
               std::vector<std::set<int>>* like) const {
    const auto homography = HomographyOfSquare(quad.corners);
    if (!homography) return;
    PadSamples samples;
    for (std::size_t k = 0; k < dictionaries.size(); ++k) {
      const Dictionary& dictionary = dictionaries[k];
      if (dictionary.dark_inside != quad.dark_inside) continue;
      samples.Reserve(dictionary.layout.cells.size());
      dictionary.AddLike(
          ReadQuad(image, camera_, *homography, quad.side_px, dictionary.layout, &samples),
          &(*like)[k]);
    }
  }

  CameraModel camera_;
  TagQuadFinder finder_;
};

FamilyCounts CountPhantoms(const cv::Mat& image, const AnyTagFinder& finder,
                           const std::vector<Dictionary>& dictionaries) {
  FamilyCounts counts;
  const std::vector<std::set<int>> like = finder.Like(image, dictionaries);
  for (std::size_t k = 0; k < dictionaries.size(); ++k) {
    Counts& of = counts[dictionaries[k].family];
    of.searched += static_cast<int>(dictionaries[k].ids.size());
    for (const int id : like[k]) {
      const auto found = finder.Find(image, dictionaries[k].family, id);
      if (found) of.Add(found->quality, false);
    }
  }
  return counts;
}

// Searches a rendered tag of any family and id.
FamilyCounts CountRealTag(const CameraModel& camera, const TagRenderer& renderer,
                          const AnyTagFinder& finder, const std::vector<Dictionary>& dictionaries,
                          Random random) {
  const Dictionary& dictionary =
      dictionaries[random.Integer(0, static_cast<int>(dictionaries.size()) - 1)];
  const int id = random.Integer(0, static_cast<int>(dictionary.ids.size()) - 1);
  TagImageOptions taken;
  taken.noise = random.Uniform(1, 6);
  taken.blur_px = random.Uniform(0.3, 0.9);
  taken.contrast = random.Uniform(0.4, 1);
  const RigidTransform pose = RandomBoardBelow(random.Uniform(1, 8), 0.3, 0.3, &random);
  const cv::Mat image = renderer.Render(BoardOfTag(dictionary.family, id, kTagSize).Printed(), pose,
                                        taken, random.Bits());
  FamilyCounts counts;
  Counts& of = counts[dictionary.family];
  of.searched = 1;
  const auto found = finder.Find(image, dictionary.family, id);
  if (!found) return counts;
  constexpr double kWrongPx = 10;
  Eigen::Vector2d truth(NAN, NAN);
  camera.Project(pose.translation, &truth);
  of.Add(found->quality, (found->center_px - truth).norm() < kWrongPx);
  return counts;
}

void AddTo(const FamilyCounts& counts, FamilyCounts* sum) {
  for (const auto& [family, of] : counts) (*sum)[family].Add(of);
}

// --- The report ---

std::vector<std::string> ImagesBelow(const std::string& folder) {
  std::vector<std::string> files;
  if (!std::filesystem::is_directory(folder)) return files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    const std::string extension = entry.path().extension().string();
    if (extension == ".png" || extension == ".jpg") files.push_back(entry.path().string());
  }
  std::sort(files.begin(), files.end());
  return files;
}

void PrintPhantoms(const std::string& pictures, std::size_t number, const FamilyCounts& counts) {
  for (const auto& [family, c] : counts) {
    fmt::print("| {} | {} | {} | {} | {} | {} | {} |\n", pictures, number, family,
               TagFamily(family).id_count(), c.searched, c.accepted, c.wrong[1]);
  }
}

// 'pictures': number of those without tags. The false ones are those of all ids; of a search for
// one id in each picture, of a family at random as the rendered tags are, they are fewer.
void PrintReliability(std::size_t pictures, const FamilyCounts& phantoms,
                      const FamilyCounts& real) {
  std::array<double, kBinEdges.size()> right{}, wrong{}, wrong_of_one{};
  for (const auto& [family, c] : phantoms) {
    for (std::size_t i = 0; i < kBinEdges.size(); ++i) {
      wrong[i] += c.wrong[i];
      wrong_of_one[i] += c.wrong[i] * static_cast<double>(pictures) /
                         (static_cast<double>(c.searched) * static_cast<double>(phantoms.size()));
    }
  }
  for (const auto& [family, c] : real) {
    for (std::size_t i = 0; i < kBinEdges.size(); ++i) {
      right[i] += c.right[i];
      wrong_of_one[i] += c.wrong[i];
    }
  }
  fmt::print(
      "\n| quality said | true | false, of all ids | false, of one id a picture |\n"
      "|---|---|---|---|\n");
  double low = 0;
  for (std::size_t i = 0; i < kBinEdges.size(); ++i) {
    fmt::print("| {} to {:.4g} | {} | {} | {:.3f} |\n", low, kBinEdges[i], right[i], wrong[i],
               wrong_of_one[i]);
    low = kBinEdges[i];
  }
  fmt::print("\n| family | rendered tags | found with 0.7 and more |\n|---|---|---|\n");
  for (const auto& [family, c] : real) {
    fmt::print("| {} | {} | {} |\n", family, c.searched, c.right[2] + c.right[3] + c.right[4]);
  }
}

struct Settings {
  int pictures = 3000;
  std::uint64_t seed = 1;
  std::string frames = "../shared/data";
};

int Run(const Settings& settings) {
  const std::vector<Dictionary> dictionaries = Dictionaries();
  const CameraModel camera = CameraOf(kTaglessSize);
  const AnyTagFinder finder(camera);
  const TagRenderer renderer(camera);
  std::mutex mutex;
  std::map<std::string, FamilyCounts> by_kind;
  FamilyCounts drawn, photographs, real;
  ForEachIndex(static_cast<std::size_t>(settings.pictures), [&](std::size_t i) {
    Random random(settings.seed + 7919 * i);
    const TaglessKind kind = kTaglessKinds[i % kTaglessKinds.size()];
    const FamilyCounts counts = CountPhantoms(kind.draw(&random), finder, dictionaries);
    const FamilyCounts tag = CountRealTag(camera, renderer, finder, dictionaries, random);
    const std::lock_guard lock(mutex);
    AddTo(counts, &by_kind[kind.name]);
    AddTo(counts, &drawn);
    AddTo(tag, &real);
  });
  const std::vector<std::string> files = ImagesBelow(settings.frames);
  ForEachIndex(files.size(), [&](std::size_t i) {
    const cv::Mat image = ReadGrayImage(files[i]);
    const AnyTagFinder of_size(CameraOf(image.size()));
    const FamilyCounts counts = CountPhantoms(image, of_size, dictionaries);
    const std::lock_guard lock(mutex);
    AddTo(counts, &photographs);
  });
  fmt::print("| drawn | said with 0.7 and more | with 0.5 to 0.7 |\n|---|---|---|\n");
  for (const auto& [kind, counts] : by_kind) {
    Counts all;
    for (const auto& [family, c] : counts) all.Add(c);
    fmt::print("| {} | {} | {} |\n", kind, all.accepted, all.wrong[1]);
  }
  fmt::print(
      "\n| pictures | number | family | ids | trials | said with 0.7 and more | with 0.5 to 0.7 |\n"
      "|---|---|---|---|---|---|---|\n");
  PrintPhantoms("drawn", settings.pictures, drawn);
  PrintPhantoms("frames", files.size(), photographs);
  AddTo(photographs, &drawn);
  PrintReliability(settings.pictures + files.size(), drawn, real);
  return 0;
}

}  // namespace
}  // namespace kestrel

int main(int argc, char** argv) {
  CLI::App app("Phantom tags in pictures that have none");
  kestrel::Settings settings;
  app.add_option("--pictures", settings.pictures, "number of drawn pictures")
      ->capture_default_str();
  app.add_option("--seed", settings.seed, "of the drawn pictures");
  app.add_option("--frames", settings.frames, "folder of images without tags")
      ->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  return kestrel::ReportMain([&] { return kestrel::Run(settings); });
}
