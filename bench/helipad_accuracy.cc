// SPDX-License-Identifier: BSD-3-Clause
// Detections of HelipadDetector on rendered images: by altitude and condition, by quality, and on
// figures that resemble an H. Times are processor times of one thread.
#include <algorithm>
#include <array>
#include <cmath>
#include <ctime>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "for_each_index.h"
#include "kestrel/core/base/random.h"
#include "kestrel/core/base/robust_statistics.h"
#include "kestrel/core/camera/paper_camera.h"
#include "kestrel/vision/helipad/helipad_detector.h"
#include "kestrel/vision/helipad/test_ground_textures.h"
#include "kestrel/vision/helipad/test_helipad_images.h"
#include "kestrel/vision/helipad/test_helipad_lookalikes.h"
#include "report_main.h"

namespace kestrel {
namespace {

constexpr std::array<double, 9> kBinEdges{0.3, 0.6, 1, 2, 4, 6, 8, 11, 15};  // altitude, m
constexpr std::size_t kBins = kBinEdges.size() - 1;
const std::array<std::string, 5> kConditions{"calm", "dust", "motion", "shadow's edge", "glare"};
const std::array<std::string, 3> kHints{"none", "place known", "followed"};

struct Frame {
  cv::Mat image;
  RigidTransform pose;
  std::array<TargetHint, kHints.size()> hints;
};

// Returns a hint of each kind for a pad of that pose.
std::array<TargetHint, kHints.size()> HintsAt(const RigidTransform& pose, double altitude,
                                              Random* random) {
  TargetHint none;
  none.up_in_camera = pose.rotation * Eigen::Vector3d::UnitZ();
  TargetHint place = none;
  const double sigma = 0.02 + 0.02 * altitude;
  const double x = random->Normal();
  const double y = random->Normal();
  const double z = random->Normal();
  place.center_in_camera = pose.translation + sigma * Eigen::Vector3d(x, y, z);
  place.center_sigma_m = sigma;
  TargetHint followed = place;
  constexpr double kTurn = 0.02;  // rad
  const double turn_x = kTurn * random->Normal();
  const double turn_y = kTurn * random->Normal();
  const double turn_z = kTurn * random->Normal();
  followed.rotation_in_camera = RotationBy({turn_x, turn_y, turn_z}) * pose.rotation;
  return {none, place, followed};
}

PadImageOptions Conditions(std::size_t condition, Random* random) {
  PadImageOptions taken;
  taken.noise = random->Uniform(1, 5);
  taken.blur_px = random->Uniform(0.3, 0.9);
  taken.contrast = random->Uniform(0.6, 1);
  if (condition == 1) taken.contrast = random->Uniform(0.2, 0.5);
  if (condition == 2) taken.motion_px = random->Uniform(2, 6);
  if (condition == 3) taken.shadow = RandomShadow(random);
  if (condition == 4) taken.glare = RandomGlare(random);
  return taken;
}

struct Sighting {
  bool found = false, wrong = false;
  double center_px = 0, heading_deg = 0, quality = 0, ms = 0;
};

double ThreadMs() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return 1e3 * static_cast<double>(now.tv_sec) + 1e-6 * static_cast<double>(now.tv_nsec);
}

// Angle between the headings of two poses, up to half a turn.
double HeadingError(const RigidTransform& seen, const RigidTransform& truth) {
  const Eigen::Vector3d along =
      truth.rotation.conjugate() * (seen.rotation.toRotationMatrix().col(1));
  return Degrees(std::abs(std::atan(along.x() / along.y())));
}

Sighting Look(const HelipadDetector& detector, const Frame& frame, const TargetHint& hint,
              TargetWorkspace* workspace) {
  Sighting sighting;
  const double start = ThreadMs();
  const TargetReport report = detector.Detect(frame.image, hint, *workspace);
  sighting.ms = ThreadMs() - start;
  if (!report.detection) return sighting;
  const RigidTransform& seen = report.detection->camera_from_target;
  Eigen::Vector2d truth(NAN, NAN), place(NAN, NAN);
  detector.camera().Project(frame.pose.translation, &truth);
  detector.camera().Project(seen.translation, &place);
  sighting.center_px = (place - truth).norm();
  sighting.heading_deg = HeadingError(seen, frame.pose);
  sighting.quality = report.detection->quality;
  const double range = frame.pose.translation.norm();
  constexpr double kWrongShare = 0.1, kWrongDeg = 10;
  const bool right = (seen.translation - frame.pose.translation).norm() < kWrongShare * range &&
                     sighting.heading_deg < kWrongDeg;
  sighting.found = right;
  sighting.wrong = !right;
  return sighting;
}

std::string Shown(const std::vector<Sighting>& all) {
  int found = 0, wrong = 0;
  std::vector<double> center, heading, ms;
  for (const Sighting& one : all) {
    found += one.found;
    wrong += one.wrong;
    ms.push_back(one.ms);
    if (!one.found) continue;
    center.push_back(one.center_px);
    heading.push_back(one.heading_deg);
  }
  const auto median = [](std::vector<double>& values) {
    return values.empty() ? NAN : MedianInPlace(values);
  };
  return fmt::format("{}/{} | {} | {:.2f} | {:.2f} | {:.2f}", found, all.size(), wrong,
                     median(center), median(heading), median(ms));
}

// Counts of the detections in a range of qualities, and of those that are right.
struct Calibration {
  static constexpr std::array<double, 6> kEdges{0, 0.5, 0.7, 0.9, 0.99, 1.01};
  std::array<int, kEdges.size() - 1> right{}, all{};

  void Add(double quality, bool is_right) {
    for (std::size_t i = 0; i < all.size(); ++i) {
      if (quality < kEdges[i] || quality >= kEdges[i + 1]) continue;
      ++all[i];
      right[i] += is_right;
    }
  }
  void Print() const {
    fmt::print("\n| quality | right |\n|---|---|\n");
    for (std::size_t i = 0; i < all.size(); ++i) {
      fmt::print("| {} to {} | {}/{} |\n", kEdges[i], std::min(1.0, kEdges[i + 1]), right[i],
                 all[i]);
    }
  }
};

struct Settings {
  int frames = 10;
  std::string condition;  // all when it is empty
  int lookalikes = 0;
  int textures = 0;
  std::uint64_t seed = 1;
  HelipadDetectorOptions detector;
};

void PrintByAltitude(const HelipadDetector& detector, const PadRenderer& renderer,
                     const Settings& settings, Calibration* calibration) {
  fmt::print(
      "| altitude | condition | hint | found | false | centre px | heading deg | ms "
      "|\n|---|---|---|---|---|---|---|---|\n");
  const TargetPrint print = PrintOf(settings.detector);
  for (std::size_t bin = 0; bin < kBins; ++bin) {
    for (std::size_t condition = 0; condition < kConditions.size(); ++condition) {
      if (!settings.condition.empty() && settings.condition != kConditions[condition]) continue;
      std::array<std::vector<Sighting>, kHints.size()> seen;
      for (auto& column : seen) column.resize(settings.frames);
      ForEachIndex(settings.frames, [&](std::size_t i) {
        Random random(settings.seed + 1000000 * bin + 100000 * condition + i);
        const auto workspace = detector.MakeWorkspace();
        const double altitude = random.Uniform(kBinEdges[bin], kBinEdges[bin + 1]);
        Frame frame;
        frame.pose = RandomPadBelow(altitude, &random);
        frame.hints = HintsAt(frame.pose, altitude, &random);
        const PadImageOptions taken = Conditions(condition, &random);
        frame.image = renderer.Render(print, frame.pose, taken, random.Bits());
        detector.Detect(frame.image, {}, *workspace);  // warms up
        for (std::size_t k = 0; k < kHints.size(); ++k) {
          seen[k][i] = Look(detector, frame, frame.hints[k], workspace.get());
        }
      });
      for (std::size_t k = 0; k < kHints.size(); ++k) {
        fmt::print("| {} to {} m | {} | {} | {} |\n", kBinEdges[bin], kBinEdges[bin + 1],
                   kConditions[condition], kHints[k], Shown(seen[k]));
        for (const Sighting& one : seen[k]) {
          if (one.found || one.wrong) calibration->Add(one.quality, one.found);
        }
      }
    }
  }
}

void PrintLookalikes(const HelipadDetector& detector, const PadRenderer& renderer, bool white,
                     int figures, std::uint64_t seed, Calibration* calibration) {
  const std::size_t boards = (figures + kLookalikesPerBoard - 1) / kLookalikesPerBoard;
  std::vector<std::vector<std::string>> accepted(boards);
  std::vector<std::vector<double>> qualities(boards);
  ForEachIndex(boards, [&](std::size_t i) {
    Random random(seed + i);
    const auto workspace = detector.MakeWorkspace();
    const LookalikeBoard board = RandomLookalikeBoard(white, &random);
    const double altitude = random.Uniform(1.2, 8);
    const RigidTransform pose = RandomPadBelow(altitude, &random);
    const PadImageOptions taken = Conditions(random.Integer(0, kConditions.size() - 1), &random);
    const cv::Mat image = renderer.Render(board.print, pose, taken, random.Bits());
    const auto look = [&](const TargetHint& hint, const std::string& how) {
      const TargetReport report = detector.Detect(image, hint, *workspace);
      if (!report.detection) return;
      const Eigen::Vector3d place =
          pose.Inverse() * report.detection->camera_from_target.translation;
      accepted[i].push_back(fmt::format("{} ({}, quality {:.3f}, {:.1f} m, board {})",
                                        board.NameAt(place.head<2>()), how,
                                        report.detection->quality, altitude, i));
      qualities[i].push_back(report.detection->quality);
    };
    look({}, "no hint");
    for (const Lookalike& figure : board.figures) {
      const RigidTransform there = pose * RigidTransform{RotationBy({0, 0, figure.turn}),
                                                         {figure.place.x(), figure.place.y(), 0}};
      look(HintsAt(there, altitude, &random).back(), "followed");
    }
  });
  int count = 0;
  for (const auto& of_board : accepted) {
    count += static_cast<int>(of_board.size());
    for (const std::string& what : of_board) fmt::print("accepted: {}\n", what);
  }
  for (const auto& of_board : qualities) {
    for (const double quality : of_board) calibration->Add(quality, false);
  }
  fmt::print("| {} on {} | {} figures | {} accepted |\n", white ? "white" : "black",
             white ? "black" : "white", boards * kLookalikesPerBoard, count);
}

// False detections without a hint on images without a pad, by what they show, for pads with each
// frame in each colour.
void PrintTextures(const CameraModel& camera, const Settings& settings, Calibration* calibration) {
  fmt::print("| what is seen | pad | images | false | largest quality |\n|---|---|---|---|---|\n");
  const cv::Size size(camera.width_px(), camera.height_px());
  const std::size_t images = settings.textures / GroundTextures::kKinds.size();
  for (const std::string frame : {"none", "circle", "square"}) {
    for (const bool white : {true, false}) {
      HelipadDetectorOptions options = settings.detector;
      options.frame = frame;
      options.white = white;
      const HelipadDetector detector(camera, options);
      for (std::size_t kind = 0; kind < GroundTextures::kKinds.size(); ++kind) {
        std::vector<double> qualities(images);
        ForEachIndex(images, [&](std::size_t i) {
          GroundTextures textures(size, settings.seed + 1000 * kind + i);
          const auto workspace = detector.MakeWorkspace();
          const TargetReport report = detector.Detect(textures.Draw(kind), {}, *workspace);
          if (report.detection) qualities[i] = report.detection->quality;
        });
        const auto accepted =
            std::count_if(qualities.begin(), qualities.end(), [](double q) { return q > 0; });
        for (const double quality : qualities) {
          if (quality > 0) calibration->Add(quality, false);
        }
        fmt::print("| {} | {}, frame {} | {} | {} | {:.4f} |\n", GroundTextures::kKinds[kind],
                   white ? "white" : "black", frame, images, accepted,
                   *std::max_element(qualities.begin(), qualities.end()));
      }
    }
  }
}

int Run(const Settings& settings) {
  cv::setNumThreads(1);
  const CameraModel camera(PaperCamera());
  const PadRenderer renderer(camera);
  Calibration calibration;
  if (settings.frames > 0) {
    const HelipadDetector detector(camera, settings.detector);
    PrintByAltitude(detector, renderer, settings, &calibration);
  }
  for (const bool white : {true, false}) {
    if (settings.lookalikes == 0) break;
    HelipadDetectorOptions options = settings.detector;
    options.white = white;
    const HelipadDetector detector(camera, options);
    PrintLookalikes(detector, renderer, white, settings.lookalikes / 2, settings.seed + white,
                    &calibration);
  }
  if (settings.textures > 0) PrintTextures(camera, settings, &calibration);
  calibration.Print();
  return 0;
}

}  // namespace
}  // namespace kestrel

int main(int argc, char** argv) {
  CLI::App app("What is found of a helipad's H, by altitude and condition");
  kestrel::Settings settings;
  app.add_option("--frames", settings.frames, "frames per range of altitudes and condition");
  app.add_option("--condition", settings.condition, "the only one that is rendered");
  app.add_option("--lookalikes", settings.lookalikes, "number of figures that resemble an H");
  app.add_option("--textures", settings.textures, "number of images without a pad");
  app.add_option("--frame", settings.detector.frame, "of the rendered pad: circle, square or none");
  app.add_option("--min-quality", settings.detector.min_quality, "of an accepted detection");
  app.add_option("--seed", settings.seed, "of the rendered frames");
  CLI11_PARSE(app, argc, argv);
  return kestrel::ReportMain([&] { return kestrel::Run(settings); });
}
