// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/console/camera/lens_page.h"

#include <algorithm>
#include <filesystem>
#include <utility>

#include <fmt/format.h>
#include <opencv2/imgproc.hpp>

#include "kestrel/calibration/lens/board_view.h"
#include "kestrel/core/base/error.h"
#include "kestrel/io/recording/euroc/calibration_output.h"
#include "kestrel/io/recording/euroc/euroc_text.h"
#include "kestrel/io/recording/frame_source.h"

namespace kestrel {
namespace {

constexpr std::size_t kLeastViews = 8;
constexpr double kGoodFocalSigma = 0.005;  // relative

// A name without a folder: a browser may not write anywhere else.
std::string PathOf(const std::string& folder, const std::string& name) {
  const std::filesystem::path path(name);
  if (name.empty() || path.filename() != path || name == "." || name == "..") {
    throw InputError("'" + name + "': expected the name of a file, without a folder");
  }
  return (std::filesystem::path(folder) / path).lexically_normal().string();
}

std::optional<DistortionModel> ModelNamed(const std::string& name) {
  for (const auto model : {DistortionModel::kNone, DistortionModel::kRadialTangential,
                           DistortionModel::kEquidistant}) {
    if (name == DistortionName(model)) return model;
  }
  return std::nullopt;
}

OverlayShape ShapeOf(const LensView& view) {
  std::vector<cv::Point2f> points;
  for (const LensEdge& edge : view.edges) {
    points.emplace_back(static_cast<float>(edge.pixel.x()), static_cast<float>(edge.pixel.y()));
  }
  OverlayShape shape;
  cv::convexHull(points, shape.outline);
  return shape;
}

}  // namespace

std::string ShellWord(const std::string& word) {
  return word.find_first_of(" !\"$&;|<>()*") == std::string::npos ? word : "'" + word + "'";
}

LensPage::LensPage(Options options, ConsoleFeed* feed) : options_(std::move(options)), feed_(feed) {
  state_.folder = std::filesystem::absolute(options_.folder).lexically_normal().string();
  Notify();
}

void LensPage::Obey(const ConsoleCommand& command) {
  if (command.kind == ConsoleCommandKind::kLens) return Begin(command.settings);
  if (command.kind == ConsoleCommandKind::kLensStop) return Stop();
  if (command.kind == ConsoleCommandKind::kLensSave) return Save(command.settings);
}

// 'words': the board, empty for Kestrel's own print, and the distortion model, empty for the best.
void LensPage::Begin(const std::vector<std::string>& words) {
  Stop();
  const std::string folder = state_.folder;
  state_ = {};
  state_.folder = folder;
  result_.reset();
  board_.reset();
  guide_.reset();
  estimated_ = 0;
  try {
    if (words.size() != 2) throw InputError("expected a board and a distortion model");
    if (!words[0].empty()) board_ = ParseLensBoard(words[0]);
    model_ = ModelNamed(words[1]);
    state_.board = words[0];
    state_.is_running = true;
  } catch (const InputError& error) {
    state_.error = error.what();
  }
  Notify();
}

void LensPage::Stop() {
  search_.Cancel();
  estimation_.Cancel();
  shapes_.clear();
  if (!state_.is_running) return;
  state_.is_running = false;
  Notify();
}

void LensPage::Look(const cv::Mat& gray, Time captured) {
  if (!state_.is_running || search_.is_running()) return;
  if (!guide_ || gray.size() != size_) {
    size_ = gray.size();
    guide_.emplace(size_);
    guess_ = 0;
    camera_ = LensGuesses(size_)[guess_];
  }
  searched_ = captured;
  const std::string name = fmt::format("view {}", guide_->views().size() + 1);
  search_.Start("lens board", [=, image = gray.clone(), camera = camera_, board = board_,
                               detector = options_.detector](const auto&) {
    if (board) return FindBoard(name, image, *board, camera);
    return LensViewFinder(camera, detector).Find(name, image);
  });
}

void LensPage::Follow() {
  if (auto found = search_.TakeOutcome()) TakeSight(std::move(found->result));
  if (auto outcome = estimation_.TakeOutcome()) TakeEstimate(*std::move(outcome));
}

void LensPage::TakeSight(std::optional<LensView> view) {
  shapes_.clear();
  if (view) shapes_.push_back(ShapeOf(*view));
  const bool is_first_guess = !board_ && guide_->views().empty();
  if (!view && is_first_guess) {  // Kestrel's own print is found by a lens that is nearly right
    const std::vector<CameraIntrinsics> guesses = LensGuesses(size_);
    guess_ = (guess_ + 1) % guesses.size();
    camera_ = guesses[guess_];
  }
  if (guide_->Look(std::move(view), searched_, camera_)) Estimate();
  Notify();
}

void LensPage::Estimate() {
  const std::vector<LensView>& views = guide_->views();
  if (views.size() < kLeastViews || estimation_.is_running() || views.size() == estimated_) return;
  estimated_ = views.size();
  estimation_.Start("lens", [=, views = views, size = size_, camera = camera_, model = model_,
                             is_board = board_.has_value()](const auto&) {
    return std::optional(is_board ? EstimateBoardLens(views, size, model)
                                  : EstimateLens(views, camera, model));
  });
}

void LensPage::TakeEstimate(BackgroundRun<LensCalibration>::Outcome outcome) {
  state_.refusal = outcome.error;
  if (outcome.result) {
    result_ = std::move(outcome.result);
    camera_ = result_->intrinsics;
    const double sigma_px = result_->fit.sigmas(kFocal);
    state_.estimate = ConsoleLens::Estimate{camera_.fx_px,
                                            sigma_px,
                                            result_->fit.RootMeanSquare(),
                                            result_->views.size(),
                                            DistortionName(camera_.distortion_model),
                                            result_->warnings};
    state_.is_good = guide_->is_complete() && result_->warnings.empty() &&
                     sigma_px <= kGoodFocalSigma * camera_.fx_px;
  }
  Estimate();
  Notify();
}

// 'words': the file's name, and "replace" where an existing one may be replaced.
void LensPage::Save(const std::vector<std::string>& words) {
  if (!result_ || words.empty()) return;
  state_.saved.clear();
  state_.save_error.clear();
  state_.exists = false;
  try {
    const std::string path = PathOf(options_.folder, words[0]);
    const bool may_replace = words.size() > 1 && words[1] == "replace";
    state_.exists = !may_replace && std::filesystem::exists(path);
    if (!state_.exists) {
      std::filesystem::create_directories(options_.folder);
      CameraCalibration calibration;
      calibration.intrinsics = result_->intrinsics;
      WriteCalibration(calibration, kNominalRateHz, path, may_replace);
      state_.saved = path;
      state_.next = fmt::format("kestrel fly {} --camera {} --console", ShellWord(options_.camera),
                                ShellWord(path));
    }
  } catch (const InputError& error) {
    state_.save_error = error.what();
  } catch (const std::filesystem::filesystem_error& error) {
    state_.save_error = error.what();
  }
  Notify();
}

void LensPage::Notify() {
  if (guide_ && state_.is_running) {
    const LensVariety& variety = guide_->variety();
    state_.advice = guide_->Advice();
    state_.views = guide_->views().size();
    state_.fields = variety.coverage.edges;
    state_.left = variety.left;
    state_.right = variety.right;
    state_.top = variety.top;
    state_.bottom = variety.bottom;
    state_.near = variety.near;
    state_.far = variety.far;
  }
  feed_->Add(state_);
}

}  // namespace kestrel
