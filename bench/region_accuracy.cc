// SPDX-License-Identifier: BSD-3-Clause
// RegionTracker over sequences of images with truth, beside the trackers of OpenCV (opencv-contrib)
// in the same run: success (area under the curve of overlaps), precision (share of centres within
// 20 px), images per second of processor time of one thread, the 99th percentile of the time of an
// image, and the shares of the images in which the region is reported as lost, and in which
// something else is followed. Then how probabilities and their truth compare (expected calibration
// error), of regions below 20 px and of others. Usage: region_accuracy FOLDER... [--peers]
// [--robustness]
//
// --robustness gives means over twelve first boxes for each sequence, which are a little off (the
// spatial robustness of Wu, Lim, Yang, "Online object tracking: a benchmark", CVPR 2013): a single
// run of a sequence is as much luck as skill.
//
// A FOLDER has a folder for each sequence: groundtruth_rect.txt (x,y,width,height by image; NaN
// where the region is hidden) and img/*.jpg, as in OTB; or NAME.txt beside the folder NAME, as the
// sequences of UAV123@10fps that github.com/vision4robotics/ARCF-tracker has in seq/. There NAME_1,
// NAME_2 ... are the parts of the folder NAME: each starts with the last image of the one before.
#include <algorithm>
#include <array>
#include <cmath>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <memory>
#include <numeric>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <opencv2/core.hpp>
#include <opencv2/tracking.hpp>
#include <opencv2/tracking/tracking_legacy.hpp>

#include "kestrel/core/base/error.h"
#include "kestrel/io/recording/media/image_file.h"
#include "kestrel/vision/region/region_tracker.h"
#include "reliability.h"
#include "report_main.h"

namespace kestrel {
namespace {

namespace fs = std::filesystem;

constexpr double kPeriod_s = 0.1;  // of the images

struct Sequence {
  std::string name;
  std::vector<fs::path> images;
  std::vector<cv::Rect2d> truth;  // of no area where the region is hidden
};

std::vector<cv::Rect2d> ReadTruth(const fs::path& file) {
  std::ifstream in(file);
  std::vector<cv::Rect2d> boxes;
  for (std::string line; std::getline(in, line);) {
    std::replace_if(
        line.begin(), line.end(), [](char c) { return c == ',' || c == '\t'; }, ' ');
    char* at = line.data();
    double values[4];
    for (double& value : values) value = std::strtod(at, &at);
    const bool is_hidden = !(values[2] > 0 && values[3] > 0 && std::isfinite(values[0]));
    if (at == line.data()) continue;
    boxes.push_back(is_hidden ? cv::Rect2d()
                              : cv::Rect2d(values[0], values[1], values[2], values[3]));
  }
  if (boxes.empty() || boxes[0].area() == 0) {
    throw InputError(file.string() + ": expected x,y,width,height in its first row");
  }
  return boxes;
}

std::vector<fs::path> ImagesIn(const fs::path& folder) {
  std::vector<fs::path> images;
  for (const auto& entry : fs::directory_iterator(folder)) images.push_back(entry.path());
  std::sort(images.begin(), images.end());
  return images;
}

// Name of the folder with the images of NAME.txt: NAME, or NAME without "_1".
std::string FolderOf(const fs::path& folder, const std::string& name) {
  if (fs::is_directory(folder / name)) return name;
  return name.substr(0, name.rfind('_'));
}

std::vector<Sequence> SequencesIn(const fs::path& folder) {
  std::vector<Sequence> sequences;
  std::map<std::string, std::size_t> used;  // images, by folder
  std::vector<fs::path> entries = ImagesIn(folder);
  for (const fs::path& entry : entries) {
    Sequence sequence{entry.stem().string(), {}, {}};
    if (fs::exists(entry / "groundtruth_rect.txt")) {
      sequence.images = ImagesIn(entry / "img");
      sequence.truth = ReadTruth(entry / "groundtruth_rect.txt");
    } else if (entry.extension() == ".txt") {
      const std::string images = FolderOf(folder, sequence.name);
      sequence.images = ImagesIn(folder / images);
      sequence.truth = ReadTruth(entry);
      const std::size_t first = used[images];
      used[images] += sequence.truth.size() - 1;
      if (first >= sequence.images.size()) {
        throw InputError(entry.string() + ": has more rows than there are images");
      }
      sequence.images.erase(sequence.images.begin(),
                            sequence.images.begin() + static_cast<std::ptrdiff_t>(first));
    } else {
      continue;
    }
    sequence.images.resize(std::min(sequence.images.size(), sequence.truth.size()));
    sequences.push_back(std::move(sequence));
  }
  if (sequences.empty()) throw InputError(folder.string() + ": has no sequences with truth");
  return sequences;
}

// A tracker's result for an image.
struct Found {
  std::optional<cv::Rect2d> box;      // nothing where the region is lost
  std::optional<double> probability;  // of a region that is followed, where the tracker has one
};

// A tracker of any kind.
class Tracker {
 public:
  virtual ~Tracker() = default;
  virtual void Start(const cv::Mat& image, const cv::Rect2d& box) = 0;
  virtual Found Next(const cv::Mat& image) = 0;
};

class Own : public Tracker {
 public:
  void Start(const cv::Mat& image, const cv::Rect2d& box) override {
    tracker_.Mark(image, time_, box);
  }
  Found Next(const cv::Mat& image) override {
    time_ += DurationFromSeconds(kPeriod_s);
    const RegionReport report = tracker_.Track(image, time_);
    if (report.state == RegionState::kLost) return {};
    if (report.state == RegionState::kCoasting) return {report.box_px, std::nullopt};
    return {report.box_px, report.probability};
  }

 private:
  RegionTracker tracker_;
  Time time_{};
};

template <class Peer>
class OpenCvTracker : public Tracker {
 public:
  explicit OpenCvTracker(cv::Ptr<Peer> peer) : peer_(std::move(peer)) {}

  void Start(const cv::Mat& image, const cv::Rect2d& box) override { peer_->init(image, box); }
  Found Next(const cv::Mat& image) override {
    Box box;
    if (!peer_->update(image, box)) return {};
    return {box, std::nullopt};
  }

 private:
  using Box = std::conditional_t<std::is_same_v<Peer, cv::Tracker>, cv::Rect, cv::Rect2d>;
  cv::Ptr<Peer> peer_;
};

struct Competitor {
  std::string_view name;
  std::function<std::unique_ptr<Tracker>()> make;
};

std::vector<Competitor> Competitors(bool with_peers) {
  std::vector<Competitor> all = {{"Kestrel", [] { return std::make_unique<Own>(); }}};
  if (!with_peers) return all;
  all.push_back({"CSRT", [] {
                   return std::make_unique<OpenCvTracker<cv::Tracker>>(cv::TrackerCSRT::create());
                 }});
  all.push_back({"KCF", [] {
                   return std::make_unique<OpenCvTracker<cv::Tracker>>(cv::TrackerKCF::create());
                 }});
  all.push_back({"MOSSE", [] {
                   return std::make_unique<OpenCvTracker<cv::legacy::Tracker>>(
                       cv::legacy::TrackerMOSSE::create());
                 }});
  return all;
}

struct Score {
  double success = 0, precision = 0;
  double ms = 0, p99_ms = 0;   // of an image: mean, and 99th percentile
  double lost = 0, wrong = 0;  // shares of the images

  void Add(const Score& other, double weight) {
    success += weight * other.success;
    precision += weight * other.precision;
    ms += weight * other.ms;
    p99_ms += weight * other.p99_ms;
    lost += weight * other.lost;
    wrong += weight * other.wrong;
  }
};

// Reliability for regions below 20 px, and for others.
struct Calibration {
  Reliability small, large;
};

double Overlap(const cv::Rect2d& a, const cv::Rect2d& b) {
  const double both = (a & b).area();
  return both / (a.area() + b.area() - both);
}

// The first boxes for a region: its own, or those around it.
std::vector<cv::Rect2d> StartsOn(const cv::Rect2d& truth, bool is_box_off) {
  if (!is_box_off) return {truth};
  constexpr double kShift = 0.1;  // sizes
  std::vector<cv::Rect2d> starts;
  for (const int y : {-1, 0, 1}) {
    for (const int x : {-1, 0, 1}) {
      if (x == 0 && y == 0) continue;
      starts.push_back(truth + cv::Point2d(kShift * x * truth.width, kShift * y * truth.height));
    }
  }
  for (const double scale : {0.8, 0.9, 1.1, 1.2}) {
    const cv::Point2d grown(0.5 * (scale - 1) * truth.width, 0.5 * (scale - 1) * truth.height);
    starts.emplace_back(truth.tl() - grown, truth.br() + grown);
  }
  return starts;
}

// A tracker that has lost its region keeps its last box, as the benchmarks have it.
Score Run(const Sequence& sequence, const cv::Rect2d& start, Tracker* tracker,
          Calibration* calibration) {
  constexpr int kThresholds = 20;
  constexpr double kNear_px = 20, kSmall_px = 20;
  constexpr double kOnIt = 0.05;  // overlap of a box that is on the region
  Score score;
  cv::Rect2d box = start;
  double scored = 0;
  std::vector<double> times_ms;  // of the processor: other programs do not count
  for (std::size_t i = 0; i < sequence.images.size(); ++i) {
    const cv::Rect2d& truth = sequence.truth[i];
    const cv::Mat image = ReadImage(sequence.images[i], PixelFormat::kBgr);
    if (i == 0) {
      tracker->Start(image, box);
    } else {
      const std::clock_t start = std::clock();
      const Found found = tracker->Next(image);
      times_ms.push_back(1e3 * static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC);
      if (found.box) box = *found.box;
      score.lost += !found.box;
      if (found.probability) {
        const bool is_right = truth.area() > 0 && Overlap(box, truth) > kOnIt;
        const bool is_small = std::sqrt(box.area()) < kSmall_px;
        score.wrong += !is_right;
        (is_small ? calibration->small : calibration->large).Add(*found.probability, is_right);
      }
    }
    if (truth.area() == 0) continue;
    ++scored;
    const double overlap = Overlap(box, truth);
    for (int k = 0; k <= kThresholds; ++k) {
      score.success += (overlap > static_cast<double>(k) / kThresholds) / (kThresholds + 1.0);
    }
    const cv::Point2d away = 0.5 * (box.tl() + box.br() - truth.tl() - truth.br());
    score.precision += std::hypot(away.x, away.y) <= kNear_px;
  }
  score.success /= scored;
  score.precision /= scored;
  if (times_ms.empty()) return score;
  const double tracked = static_cast<double>(times_ms.size());
  score.ms = std::accumulate(times_ms.begin(), times_ms.end(), 0.0) / tracked;
  std::sort(times_ms.begin(), times_ms.end());
  score.p99_ms = times_ms[times_ms.size() * 99 / 100];
  score.lost /= tracked;
  score.wrong /= tracked;
  return score;
}

void PrintRow(std::string_view sequence, std::string_view tracker, const Score& score) {
  fmt::print("{:14} {:8} {:7.3f} {:9.3f} {:9.0f} {:7.1f} {:6.1f} {:7.1f}\n", sequence, tracker,
             score.success, score.precision, 1e3 / score.ms, score.p99_ms, 100 * score.lost,
             100 * score.wrong);
  std::fflush(stdout);
}

int Report(const std::vector<std::string>& folders, bool with_peers, bool is_box_off) {
  cv::setNumThreads(1);
  fmt::print("{:14} {:8} {:>7} {:>9} {:>9} {:>7} {:>6} {:>7}\n", "sequence", "tracker", "success",
             "precision", "images/s", "p99 ms", "lost %", "wrong %");
  const std::vector<Competitor> competitors = Competitors(with_peers);
  std::vector<Score> means(competitors.size());
  Calibration calibration;
  double count = 0;
  for (const std::string& folder : folders) {
    for (const Sequence& sequence : SequencesIn(folder)) {
      ++count;
      for (std::size_t i = 0; i < competitors.size(); ++i) {
        Score score;
        const std::vector<cv::Rect2d> starts = StartsOn(sequence.truth[0], is_box_off);
        for (const cv::Rect2d& start : starts) {
          score.Add(Run(sequence, start, competitors[i].make().get(), &calibration),
                    1.0 / static_cast<double>(starts.size()));
        }
        PrintRow(sequence.name, competitors[i].name, score);
        means[i].Add(score, 1);
      }
    }
  }
  for (std::size_t i = 0; i < competitors.size(); ++i) {
    Score mean;
    mean.Add(means[i], 1 / count);
    PrintRow("mean", competitors[i].name, mean);
  }
  fmt::print("expected calibration error: {:.3f} of {} boxes below 20 px, {:.3f} of {} others\n",
             calibration.small.ExpectedError(), calibration.small.count(),
             calibration.large.ExpectedError(), calibration.large.count());
  return 0;
}

}  // namespace
}  // namespace kestrel

int main(int argc, char** argv) {
  CLI::App app("RegionTracker over sequences of images with truth");
  std::vector<std::string> folders;
  bool with_peers = false, is_box_off = false;
  app.add_option("folder", folders, "Folders with sequences")
      ->required()
      ->check(CLI::ExistingDirectory);
  app.add_flag("--peers", with_peers, "OpenCV's CSRT, KCF and MOSSE, too");
  app.add_flag("--robustness", is_box_off, "Means over twelve first boxes that are a little off");
  CLI11_PARSE(app, argc, argv);
  return kestrel::ReportMain([&] { return kestrel::Report(folders, with_peers, is_box_off); });
}
