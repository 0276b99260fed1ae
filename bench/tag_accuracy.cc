// SPDX-License-Identifier: BSD-3-Clause
// Detections of TagBoardDetector on rendered images, by altitude, in one table with libapriltag and
// OpenCV's ArUco on the raw image and on an undistorted one. Times are processor times of one
// thread and include the undistortion.
#include <algorithm>
#include <array>
#include <ctime>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <opencv2/imgproc.hpp>
#if __has_include(<opencv2/objdetect/aruco_detector.hpp>)
#include <opencv2/objdetect/aruco_detector.hpp>
#else
#include <opencv2/aruco.hpp>
#endif

#include "apriltag_peer.h"
#include "for_each_index.h"
#include "kestrel/core/base/random.h"
#include "kestrel/core/base/robust_statistics.h"
#include "kestrel/core/camera/paper_camera.h"
#include "kestrel/vision/tags/tag_board_detector.h"
#include "kestrel/vision/tags/test_tag_images.h"
#include "report_main.h"

namespace kestrel {
namespace {

constexpr double kTagSize = 0.5;  // m
constexpr int kTagId = 7;
constexpr std::array<double, 8> kBinEdges{0.3, 0.6, 1, 2, 4, 6, 8, 11};  // altitude, m
constexpr double kWrongPx = 10;  // corners farther off than this are a false detection

using Corners =
    std::array<Eigen::Vector2d, 4>;  // of the tag's square, clockwise from the upper left

// Result of a finder on one image: the corners of the tag, in the image that it looked at.
struct Found {
  std::optional<Corners> corners;
  bool wrong_id = false;
};

struct Frame {
  cv::Mat image;
  RigidTransform pose;
  TargetHint hint;      // place and up
  TargetHint followed;  // and orientation
};

Corners CornersOf(const CameraModel& camera, const RigidTransform& pose) {
  constexpr double kHalf = 0.5 * kTagSize;
  constexpr std::array<std::array<double, 2>, 4> kPlaces{
      {{-kHalf, kHalf}, {kHalf, kHalf}, {kHalf, -kHalf}, {-kHalf, -kHalf}}};
  Corners corners;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    corners[i].setConstant(NAN);
    camera.Project(pose * Eigen::Vector3d(kPlaces[i][0], kPlaces[i][1], 0), &corners[i]);
  }
  return corners;
}

// --- The peers ---

// libapriltag on the raw corners, in the order of CornersOf.
class AprilTagFinder {
 public:
  explicit AprilTagFinder(float decimate) : peer_("tag36h11", decimate) {}
  Found operator()(const cv::Mat& image) const {
    Found found;
    for (const AprilTagPeer::Tag& tag : peer_.Find(image)) {
      if (tag.id != kTagId) {
        found.wrong_id = true;
        continue;
      }
      found.corners.emplace();
      std::reverse_copy(tag.corners.begin(), tag.corners.end(), found.corners->begin());
    }
    return found;
  }

 private:
  AprilTagPeer peer_;
};

// OpenCV's ArUco with corners refined to sub-pixel.
class ArucoPeer {
 public:
  ArucoPeer(int dictionary, int turns) : dictionary_(dictionary), turns_(turns) {}
  Found operator()(const cv::Mat& image) const {
    std::vector<std::vector<cv::Point2f>> corners;
    std::vector<int> ids;
#if __has_include(<opencv2/objdetect/aruco_detector.hpp>)
    cv::aruco::DetectorParameters parameters;
    parameters.cornerRefinementMethod = cv::aruco::CORNER_REFINE_SUBPIX;
    const cv::aruco::ArucoDetector detector(cv::aruco::getPredefinedDictionary(dictionary_),
                                            parameters);
    detector.detectMarkers(image, corners, ids);
#else
    const auto parameters = cv::aruco::DetectorParameters::create();
    parameters->cornerRefinementMethod = cv::aruco::CORNER_REFINE_SUBPIX;
    cv::aruco::detectMarkers(image, cv::aruco::getPredefinedDictionary(dictionary_), corners, ids,
                             parameters);
#endif
    Found found;
    for (std::size_t i = 0; i < ids.size(); ++i) {
      if (ids[i] != kTagId) {
        found.wrong_id = true;
        continue;
      }
      Corners seen;
      for (int k = 0; k < 4; ++k) {
        const cv::Point2f& corner = corners[i][(k + turns_) % 4];
        seen[k] = {corner.x, corner.y};
      }
      found.corners = seen;
    }
    return found;
  }

 private:
  int dictionary_;
  int turns_;  // quarters by which OpenCV draws the family turned
};

// --- What is measured ---

struct Finder {
  std::string name;
  const CameraModel* camera;  // of the image that it looks at
  std::function<Found(const Frame&)> find;
};

struct Score {
  int frames = 0, found = 0, wrong = 0;
  std::vector<double> corner_px;
  std::vector<double> ms;
};

double ThreadMs() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return 1e3 * static_cast<double>(now.tv_sec) + 1e-6 * static_cast<double>(now.tv_nsec);
}

void Measure(const Finder& finder, const Frame& frame, Score* score) {
  const double start = ThreadMs();
  const Found found = finder.find(frame);
  score->ms.push_back(ThreadMs() - start);
  ++score->frames;
  score->wrong += found.wrong_id;
  if (!found.corners) return;
  const Corners truth = CornersOf(*finder.camera, frame.pose);
  double squares = 0;
  for (int k = 0; k < 4; ++k) squares += ((*found.corners)[k] - truth[k]).squaredNorm() / 4;
  if (!(squares < kWrongPx * kWrongPx)) {
    ++score->wrong;
    return;
  }
  ++score->found;
  score->corner_px.push_back(std::sqrt(squares));
}

std::string Shown(Score score) {
  if (score.frames == 0) return "";
  const double corner = score.corner_px.empty() ? NAN : MedianInPlace(score.corner_px);
  return fmt::format("{}/{} | {} | {:.2f} | {:.2f}", score.found, score.frames, score.wrong, corner,
                     MedianInPlace(score.ms));
}

// --- Frames ---

Frame MakeFrame(const TagRenderer& renderer, const std::vector<PrintedTag>& tags, double least_m,
                double most_m, Random* random) {
  Frame frame;
  const double height = random->Uniform(least_m, most_m);
  TagImageOptions taken;
  taken.noise = random->Uniform(1, 6);
  taken.blur_px = random->Uniform(0.3, 0.9);
  taken.contrast = random->Uniform(0.4, 1);
  taken.motion_px = random->Chance(0.3) ? random->Uniform(1, 5) : 0;
  taken.shadow = random->Chance(0.2);
  frame.pose = RandomBoardBelow(height, 0.5, 0.2, random);
  frame.image = renderer.Render(tags, frame.pose, taken, random->Bits());
  const double sigma = 0.03 + 0.02 * height;
  const double x = sigma * random->Normal();
  const double y = sigma * random->Normal();
  const double z = sigma * random->Normal();
  frame.hint.center_in_camera = frame.pose.translation + Eigen::Vector3d(x, y, z);
  frame.hint.center_sigma_m = sigma;
  frame.hint.up_in_camera = frame.pose.rotation * Eigen::Vector3d::UnitZ();
  frame.followed = frame.hint;
  constexpr double kTurn = 0.02;  // rad
  const double turn_x = kTurn * random->Normal();
  const double turn_y = kTurn * random->Normal();
  const double turn_z = kTurn * random->Normal();
  frame.followed.rotation_in_camera = RotationBy({turn_x, turn_y, turn_z}) * frame.pose.rotation;
  return frame;
}

// Maps for cv::remap from the camera to a pinhole of the same size and focal length.
class Undistortion {
 public:
  Undistortion(const CameraModel& camera, const CameraModel& pinhole)
      : u_(pinhole.height_px(), pinhole.width_px(), CV_32FC1), v_(u_.size(), CV_32FC1) {
    for (int v = 0; v < u_.rows; ++v) {
      for (int u = 0; u < u_.cols; ++u) {
        Eigen::Vector3d ray;
        Eigen::Vector2d pixel(-1, -1);
        pinhole.Unproject({u, v}, &ray);
        camera.Project(ray, &pixel);
        u_.at<float>(v, u) = static_cast<float>(pixel.x());
        v_.at<float>(v, u) = static_cast<float>(pixel.y());
      }
    }
  }
  cv::Mat operator()(const cv::Mat& image) const {
    cv::Mat flat;
    cv::remap(image, flat, u_, v_, cv::INTER_LINEAR);
    return flat;
  }

 private:
  cv::Mat u_, v_;
};

struct Settings {
  int frames_per_bin = 20;
  std::uint64_t seed = 1;
  bool with_peers = true;
};

int Run(const Settings& settings) {
  cv::setNumThreads(1);
  const CameraModel camera(PaperCamera());
  CameraIntrinsics flat = PaperCamera();
  flat.distortion_model = DistortionModel::kNone;
  flat.distortion.clear();
  const CameraModel pinhole(flat);
  const Undistortion undistort(camera, pinhole);
  const TagRenderer renderer(camera);
  for (const std::string family : {"tag36h11", "aruco_4x4_50"}) {
    const bool is_april = family == "tag36h11";
    BoardTag tag;
    tag.family = family;
    tag.id = kTagId;
    tag.size_m = kTagSize;
    const TagBoard board{{tag}};
    const TagBoardDetector detector(camera, board, {});
    const auto workspace = detector.MakeWorkspace();
    const auto kestrel = [&](const TargetHint& hint, const cv::Mat& image) {
      Found found;
      const TargetReport report = detector.Detect(image, hint, *workspace);
      if (report.detection) {
        found.corners = CornersOf(camera, report.detection->camera_from_target);
      }
      return found;
    };
    std::vector<Finder> finders{
        {"kestrel", &camera, [&](const Frame& f) { return kestrel({}, f.image); }},
        {"kestrel, place known", &camera, [&](const Frame& f) { return kestrel(f.hint, f.image); }},
        {"kestrel, followed", &camera,
         [&](const Frame& f) { return kestrel(f.followed, f.image); }},
    };
    const auto add_peer = [&](const std::string& name, const auto& peer) {
      finders.push_back(
          {name + ", raw", &camera, [peer](const Frame& f) { return peer(f.image); }});
      finders.push_back({name + ", undistorted", &pinhole,
                         [peer, &undistort](const Frame& f) { return peer(undistort(f.image)); }});
    };
    if (!settings.with_peers) {
      // Kestrel alone.
    } else if (is_april) {
      add_peer("libapriltag", AprilTagFinder(1));
      add_peer("libapriltag, decimate 2", AprilTagFinder(2));
      add_peer("OpenCV", ArucoPeer(cv::aruco::DICT_APRILTAG_36h11, 2));
    } else {
      add_peer("OpenCV", ArucoPeer(cv::aruco::DICT_4X4_50, 0));
    }
    fmt::print(
        "{}, {} m\n\n| altitude | finder | found | false | corners px | ms "
        "|\n|---|---|---|---|---|---|\n",
        family, kTagSize);
    Random random(settings.seed);
    for (std::size_t bin = 0; bin + 1 < kBinEdges.size(); ++bin) {
      std::vector<Score> scores(finders.size());
      std::vector<std::uint64_t> seeds(settings.frames_per_bin);
      for (std::uint64_t& seed : seeds) seed = random.Bits();
      std::vector<Frame> frames(seeds.size());
      ForEachIndex(frames.size(), [&](std::size_t i) {
        Random of_frame(seeds[i]);
        frames[i] =
            MakeFrame(renderer, board.Printed(), kBinEdges[bin], kBinEdges[bin + 1], &of_frame);
      });
      for (const Frame& frame : frames) {
        for (std::size_t k = 0; k < finders.size(); ++k) Measure(finders[k], frame, &scores[k]);
      }
      for (std::size_t k = 0; k < finders.size(); ++k) {
        fmt::print("| {} to {} m | {} | {} |\n", kBinEdges[bin], kBinEdges[bin + 1],
                   finders[k].name, Shown(scores[k]));
      }
    }
    fmt::print("\n");
  }
  return 0;
}

}  // namespace
}  // namespace kestrel

int main(int argc, char** argv) {
  CLI::App app("What is found of tags by altitude, beside libapriltag and OpenCV");
  kestrel::Settings settings;
  bool kestrel_only = false;
  app.add_option("--frames", settings.frames_per_bin, "frames per range of altitudes");
  app.add_option("--seed", settings.seed, "of the rendered frames");
  app.add_flag("--kestrel-only", kestrel_only, "leave libapriltag and OpenCV out");
  CLI11_PARSE(app, argc, argv);
  settings.with_peers = !kestrel_only;
  return kestrel::ReportMain([&] { return kestrel::Run(settings); });
}
