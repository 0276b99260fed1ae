// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/vision/region/region_tracker.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "kestrel/core/base/error.h"
#include "kestrel/core/geometry/angles.h"
#include "kestrel/vision/region/appearance_features.h"
#include "kestrel/vision/region/appearance_filter.h"
#include "kestrel/vision/region/background_motion.h"
#include "kestrel/vision/region/region_colors.h"
#include "kestrel/vision/region/window_sampler.h"

namespace kestrel {
namespace {

// Chosen on sequences of UAV123 and DTB70 that docs/follow.md does not list, and on copies of them
// that were reduced to objects of 5 to 20 px; the least window, and when a region is lost, also on
// those listed. Those of the colours: on rendered cars.
constexpr int kCells = 32, kCellPx = 4;
constexpr double kMiddle = 0.5 * (kCells * kCellPx - 1);  // of a window, samples
constexpr int kChannels = AppearanceFeatures::kChannels;
constexpr double kPadding = 5;          // side of the window by that of a square like the region
constexpr double kLeastWindow_px = 64;  // small things move as fast as large ones
constexpr double kScaleStep = 1.03;
constexpr double kTemporal = 3000;       // weight of what was learnt before
constexpr double kSlowTemporal = 20000;  // the same for the slow filter
constexpr int kSlowPeriod = 5;           // images from one step of the slow filter to the next
constexpr double kVelocityTime_s = 0.3;
constexpr double kPredictedShare = 0.5;  // how much of the velocity counts: it is uncertain

// Agreement is 1 where a region looks as it usually did.
constexpr double kLeastToSee = 0.35;
constexpr double kLeastToLearn = 0.65;
constexpr double kLeastToLearnSlowly = 0.6;
// The colours must agree as well: a filter that has slid off a small region agrees with what it has
// learnt since.
constexpr double kLeastColorsToLearnSlowly = 0.6;
constexpr double kLeastToFind = 0.65;
constexpr double kLeastSharpness = 0.5;
constexpr double kLeastColorsToFind = 0.6;
// Images in a row; colours alone are more often those of something else.
constexpr int kHits = 2, kHitsByColors = 3;
// The mean of the slow filter's agreement and that of the colours: the other filter learns whatever
// it is on.
constexpr double kLeastToKnow = 0.4;

constexpr double kLeastSide_px = 4;
constexpr double kCoasting_s = 0.5;
constexpr int kPlacesPerImage = 3;

void RequireImage(const cv::Mat& image) {
  if (image.empty() || (image.type() != CV_8UC1 && image.type() != CV_8UC3)) {
    throw InputError("image: expected 8 bits, gray or BGR, and not empty");
  }
}

void RequireBox(const cv::Rect2d& box, const cv::Size& size) {
  const double middle_x = box.x + 0.5 * box.width, middle_y = box.y + 0.5 * box.height;
  const bool is_box = std::isfinite(middle_x) && std::isfinite(middle_y) &&
                      box.width >= kLeastSide_px && box.height >= kLeastSide_px;
  if (!is_box) {
    throw InputError(
        fmt::format("box {:g},{:g},{:g},{:g}: expected x,y,width,height in px, width "
                    "and height at least {:g}",
                    box.x, box.y, box.width, box.height, kLeastSide_px));
  }
  if (middle_x < 0 || middle_x > size.width || middle_y < 0 || middle_y > size.height ||
      box.width > size.width || box.height > size.height) {
    throw InputError(
        fmt::format("box {:g},{:g},{:g},{:g}: expected one within the image of {} x {}", box.x,
                    box.y, box.width, box.height, size.width, size.height));
  }
}

// Returns the largest factor by which a side or the area has changed.
double ChangeOf(const Eigen::Vector2d& size, const Eigen::Vector2d& before) {
  const Eigen::Vector2d ratio = size.cwiseQuotient(before);
  return std::max(std::max(ratio.maxCoeff(), ratio.prod()),
                  1 / std::min(ratio.minCoeff(), ratio.prod()));
}

// Returns how probably a region is what was marked, by the agreement of both filters: even where
// half of the templates agree. Set by hand, not calibrated.
double ProbabilityOf(double agreement) {
  constexpr double kEven = 0.45, kSlope = 8;
  return 1 / (1 + std::exp(-kSlope * (agreement - kEven)));
}

}  // namespace

const char* ToString(RegionState state) {
  switch (state) {
    case RegionState::kFollowing:
      return "following";
    case RegionState::kCoasting:
      return "coasting";
    case RegionState::kLost:
      return "lost";
  }
  return "";
}

struct RegionTracker::Impl {
  // Mean of the last responses of a filter to the region.
  struct UsualResponse {
    void Start(const FilterPeak& peak) {
      // A filter agrees best with the image that it learnt.
      constexpr double kShare = 0.7;
      value = kShare * peak.value;
      sharpness = kShare * peak.sharpness;
    }
    void Add(const FilterPeak& peak) {
      constexpr double kNewShare = 0.05;
      value += kNewShare * (peak.value - value);
      sharpness += kNewShare * (peak.sharpness - sharpness);
    }

    double value = 0, sharpness = 0;
  };

  // What a filter finds in a window.
  struct Look {
    Eigen::Vector2d center_px = Eigen::Vector2d::Zero();
    double scale = 1;
    FilterPeak peak;
    std::optional<RegionColors::Box> by_colors = std::nullopt;  // px
  };

  // A place by colours.
  struct ColorPlace {
    Eigen::Vector2d center_px;
    double contrast;
  };

  void Mark(const cv::Mat& image, Time now, const cv::Rect2d& box);
  RegionReport Track(const cv::Mat& image, Time now, const std::optional<RegionHint>& hint);

  // Computes the spectrum of the window around a place.
  void See(const cv::Mat& image, const Eigen::Vector2d& at, double scale);
  // A filter begins with the region in the middle of what was seen.
  void StartOn(double temporal, AppearanceFilter* by, UsualResponse* usually);
  Look LookAt(const cv::Mat& image, const AppearanceFilter& by, const Eigen::Vector2d& at,
              double scale);
  // Looks for the region near a place, at three scales.
  Look Follow(const cv::Mat& image, const Eigen::Vector2d& expected);
  // Moves the box, and learns what it shows unless that is ambiguous. Returns how much it looks
  // like what was marked.
  double Accept(const cv::Mat& image, const Look& look);
  // Returns the region's box, as it is seen at scale 1, in the window.
  RegionColors::Box BoxInWindow(const Eigen::Vector2d& center_px) const {
    return {((center_px - window_center) / PixelsPerSample()).array() + kMiddle,
            size / PixelsPerSample()};
  }
  // Returns where in the image a place in the window is, which is seen at scale 1.
  Eigen::Vector2d PixelOf(const Eigen::Vector2d& in_window) const {
    return window_center + PixelsPerSample() * (in_window.array() - kMiddle).matrix();
  }
  double PixelsPerSample() const { return window_px / (kCells * kCellPx); }
  // Returns the box (px) that the region's colours show near a place in the window, which is seen
  // at scale 1; nothing where they show none.
  // 'larger': sizes of the region to begin with.
  std::optional<RegionColors::Box> FitColors(const Eigen::Vector2d& near_px, double larger = 1);
  // The colours near the expected place replace a weak look elsewhere. The response counts as just
  // strong enough: it is low while the form changes.
  void TakeByColors(const cv::Mat& image, const Eigen::Vector2d& expected, Look* look);
  // True when the box has stopped with the background, which the region had not done.
  bool HasDrifted(const Eigen::Vector2d& shift, double seconds, double agreement);
  // True where the slow filter and the colours find what was marked in the window.
  bool IsLike(const Look& look);
  // True where the colours show it in the middle of the window, in another form: it has turned.
  // 'contrast': of the colours there, see RegionColors::Place.
  bool IsTurned(double contrast, Look* look);
  void FollowAgain(const cv::Mat& image, bool is_turned);
  // Counts the region as lost from now on. Its size is that of the last image in which both filters
  // knew it, unless it has changed little since: the box may have grown to that of a shadow.
  void Lose();
  // Looks for a region that is not seen, around the expected place.
  // 'reach_px': farther from there it cannot be.
  void Search(const cv::Mat& image, const Eigen::Vector2d& expected, double radius_px,
              double reach_px);
  Eigen::Vector2d NextPlace(const Eigen::Vector2d& around, double radius_px);
  RegionReport Report(double probability) const;
  // A window shows more than where the region can be: what looks like it may be there.
  double ReachOf(const RegionHint& hint) const {
    constexpr double kMargin = 0.25;  // sizes of the region
    return RadiusOf(hint) + kMargin * std::sqrt(size.prod());
  }
  static double RadiusOf(const RegionHint& hint) {
    constexpr double kSigmas = 2;
    return kSigmas * std::sqrt(hint.covariance_px2.trace());
  }
  bool IsInImage(const Eigen::Vector2d& at) const {
    return at.x() >= 0 && at.y() >= 0 && at.x() <= image_size.width && at.y() <= image_size.height;
  }

  WindowSampler sampler;
  SampledWindow window{kCells * kCellPx, 3};
  AppearanceFeatures features{kCells, kCellPx};
  FeatureGrid grid{kCells, kChannels};
  GridSpectrum sample{kCells, kChannels};
  FilterWorkspace workspace{kCells, kChannels};
  AppearanceFilter filter{kCells, kChannels}, slow{kCells, kChannels};
  RegionColors colors{kCells * kCellPx};
  BackgroundMotion background;
  std::array<float, kCells> taper;

  int type = -1;  // as the images have it
  cv::Size image_size;
  Time time, seen;
  RegionState state = RegionState::kLost;
  Eigen::Vector2d center, size;  // the region's, px
  double window_px = 0;          // side
  Eigen::Vector2d sure_size;     // when both filters knew it
  double sure_window_px = 0;
  Eigen::Vector2d window_center;  // of what was seen last, px
  Eigen::Vector2d velocity;       // against the background, px/s
  double usual_speed = 0, still_s = 0;
  UsualResponse usual, slow_usual;
  int learnt = 0;  // images
  int place = 0;   // the next of the search
  int hits = 0;    // images in a row that had it at 'center', while it is looked for
};

void RegionTracker::Impl::See(const cv::Mat& image, const Eigen::Vector2d& at, double scale) {
  const double side = scale * window_px;
  window_center = at;
  sampler.Sample(image, at, {side, side}, &window);
  features.Compute(window, &grid);
  for (int y = 0; y < kCells; ++y) {
    for (int x = 0; x < kCells; ++x) {
      const float weight = taper[x] * taper[y];
      float* cell = grid.Cell(x, y);
      for (int c = 0; c < kChannels; ++c) cell[c] *= weight;
    }
  }
  workspace.transform.Forward(&grid, &sample);
}

RegionTracker::Impl::Look RegionTracker::Impl::LookAt(const cv::Mat& image,
                                                      const AppearanceFilter& by,
                                                      const Eigen::Vector2d& at, double scale) {
  See(image, at, scale);
  Look look;
  look.peak = by.Find(sample, &workspace);
  look.scale = scale;
  look.center_px = at + look.peak.displacement * (scale * window_px / kCells);
  return look;
}

void RegionTracker::Impl::Mark(const cv::Mat& image, Time now, const cv::Rect2d& box) {
  for (int i = 0; i < kCells; ++i) {
    taper[i] = static_cast<float>(0.5 - 0.5 * std::cos(2 * kPi * (i + 0.5) / kCells));
  }
  type = image.type();
  image_size = image.size();
  sampler.Reserve(image_size, image.channels());
  window.planes = image.channels();
  time = seen = now;
  state = RegionState::kFollowing;
  center = {box.x + 0.5 * (box.width - 1), box.y + 0.5 * (box.height - 1)};
  size = sure_size = {box.width, box.height};
  window_px = sure_window_px = std::max(kPadding * std::sqrt(size.prod()), kLeastWindow_px);
  velocity.setZero();
  usual_speed = still_s = 0;
  learnt = place = 0;
  hits = 0;
  See(image, center, 1);
  StartOn(kTemporal, &filter, &usual);
  StartOn(kSlowTemporal, &slow, &slow_usual);
  colors.Mark(window, BoxInWindow(center));
  background.Update(image);
}

void RegionTracker::Impl::StartOn(double temporal, AppearanceFilter* by, UsualResponse* usually) {
  by->Reset(size * (kCells / window_px), &workspace);
  by->Learn(sample, temporal, &workspace);
  usually->Start(by->Find(sample, &workspace));
}

RegionReport RegionTracker::Impl::Report(double probability) const {
  const Eigen::Vector2d corner = center - 0.5 * (size - Eigen::Vector2d::Ones());
  return {state, {corner.x(), corner.y(), size.x(), size.y()}, probability};
}

RegionTracker::Impl::Look RegionTracker::Impl::Follow(const cv::Mat& image,
                                                      const Eigen::Vector2d& expected) {
  constexpr double kFar = 0.125 * kCells;
  Look look = LookAt(image, filter, expected, 1);
  // Near the border of a window a response is weak.
  if (look.peak.displacement.norm() > kFar) look = LookAt(image, filter, look.center_px, 1);
  if (look.peak.value < kLeastToLearn * usual.value) {
    TakeByColors(image, expected, &look);
  } else {
    look.by_colors = FitColors(look.center_px);
  }
  const double larger = LookAt(image, filter, look.center_px, kScaleStep).peak.value;
  const double smaller = LookAt(image, filter, look.center_px, 1 / kScaleStep).peak.value;
  // The vertex of the parabola through the three responses.
  const double bend = smaller - 2 * look.peak.value + larger;
  const double steps = bend < 0 ? std::clamp(0.5 * (smaller - larger) / bend, -1.0, 1.0)
                                : (larger > smaller ? 1.0 : -1.0);
  look.scale = std::pow(kScaleStep, steps);
  return look;
}

double RegionTracker::Impl::Accept(const cv::Mat& image, const Look& look) {
  constexpr double kColorGain = 0.2;  // what turns gets another form, but slowly
  center = look.center_px;
  if (look.by_colors) {
    center += kColorGain * (look.by_colors->middle - center);
    size += kColorGain * (look.by_colors->size - size);
    size = size.cwiseMax(kLeastSide_px);
  }
  const double least = kLeastSide_px / size.minCoeff();
  const double most = std::min(image_size.width / size.x(), image_size.height / size.y());
  const double scale = std::clamp(look.scale, std::min(least, 1.0), std::max(most, 1.0));
  size *= scale;
  window_px *= scale;
  See(image, center, 1);
  const double share = look.peak.value / usual.value;
  const FilterPeak slow_peak = slow.Find(sample, &workspace);
  const double slow_share = slow_peak.value / slow_usual.value;
  const double agreement = 0.5 * (share + slow_share);
  const double color_share = colors.AgreementOf(window, BoxInWindow(center));
  if (0.5 * (slow_share + color_share) < kLeastToKnow) return 0;
  if (share > kLeastToLearn || look.by_colors) {
    usual.Add(look.peak);
    filter.Learn(sample, kTemporal, &workspace);
  }
  if (std::min(share, slow_share) > kLeastToLearnSlowly &&
      color_share > kLeastColorsToLearnSlowly) {
    sure_size = size;
    sure_window_px = window_px;
    slow_usual.Add(slow_peak);
    if (++learnt % kSlowPeriod == 0) {
      slow.Learn(sample, kSlowTemporal, &workspace);
      colors.LearnAround(window, BoxInWindow(center));
    }
  }
  return agreement;
}

std::optional<RegionColors::Box> RegionTracker::Impl::FitColors(const Eigen::Vector2d& near_px,
                                                                double larger) {
  const RegionColors::Box box = BoxInWindow(near_px);
  const auto fit = colors.Fit(window, {box.middle, larger * box.size});
  if (!fit) return std::nullopt;
  return RegionColors::Box{PixelOf(fit->middle), PixelsPerSample() * fit->size};
}

void RegionTracker::Impl::TakeByColors(const cv::Mat& image, const Eigen::Vector2d& expected,
                                       Look* look) {
  constexpr double kSame = 0.25;  // sizes of the region
  window_center = expected;
  sampler.Sample(image, expected, {window_px, window_px}, &window);
  look->by_colors = FitColors(expected);
  if (!look->by_colors) return;
  const Eigen::Vector2d aside = look->by_colors->middle - look->center_px;
  if (aside.norm() < kSame * std::sqrt(size.prod())) return;
  look->center_px = look->by_colors->middle;
  look->peak.value = std::max(look->peak.value, 1.01 * kLeastToSee * usual.value);
}

bool RegionTracker::Impl::HasDrifted(const Eigen::Vector2d& moved, double seconds,
                                     double agreement) {
  constexpr double kUsual_s = 2, kStill_s = 0.3;
  constexpr double kMoving = 0.5;  // sizes of the region per second
  constexpr double kStillShare = 0.1, kDoubtful = 0.8;
  velocity += std::min(1.0, seconds / kVelocityTime_s) * (moved / seconds - velocity);
  const double speed = velocity.norm();
  const bool was_moving = usual_speed > kMoving * std::sqrt(size.prod());
  const bool is_still = was_moving && speed < kStillShare * usual_speed && agreement < kDoubtful;
  still_s = is_still ? still_s + seconds : 0;
  if (!is_still) usual_speed += std::min(1.0, seconds / kUsual_s) * (speed - usual_speed);
  return still_s > kStill_s;
}

// The expected place first, then places of a spiral around it, half a window apart, that are in the
// image.
Eigen::Vector2d RegionTracker::Impl::NextPlace(const Eigen::Vector2d& around, double radius_px) {
  constexpr double kGoldenAngle = 2.399963;
  constexpr int kTries = 16;
  const double spacing = 0.4 * window_px;
  for (int i = 0; i < kTries; ++i) {
    const double away = spacing * std::sqrt(place);
    const double angle = place * kGoldenAngle;
    ++place;
    if (away + spacing > radius_px) place = 0;
    Eigen::Vector2d at = around + away * Eigen::Vector2d(std::cos(angle), std::sin(angle));
    if (IsInImage(at)) return at;
  }
  return around;
}

void RegionTracker::Impl::Search(const cv::Mat& image, const Eigen::Vector2d& expected,
                                 double radius_px, double reach_px) {
  Look best;
  ColorPlace by_colors{expected, 0};
  for (int i = 0; i < kPlacesPerImage; ++i) {
    const Eigen::Vector2d at = i == 0 ? expected : NextPlace(expected, radius_px);
    const Look look = LookAt(image, slow, at, 1);
    if (look.peak.value > best.peak.value) best = look;
    const auto [box, contrast] = colors.Find(window, size / PixelsPerSample());
    if (contrast > by_colors.contrast) by_colors = {PixelOf(box.middle), contrast};
  }
  const auto can_be_at = [&](const Eigen::Vector2d& at) {
    return IsInImage(at) && (at - expected).norm() < reach_px;
  };
  // A second look, from the place itself: a window's middle is seen best.
  best = LookAt(image, slow, best.center_px, 1);
  const bool is_alike = can_be_at(best.center_px) && IsLike(best);
  if (!is_alike) best = LookAt(image, slow, by_colors.center_px, 1);
  // Something else has the brightness of what is gray, and may be anywhere.
  const bool is_far = !colors.HasHues() && (by_colors.center_px - expected).norm() > window_px;
  const bool is_turned =
      !is_alike && !is_far && can_be_at(by_colors.center_px) && IsTurned(by_colors.contrast, &best);
  hits = is_alike || is_turned ? hits + 1 : 0;
  if (hits == 0) return;
  center = is_turned ? best.by_colors->middle : best.center_px;
  if (hits >= (is_turned ? kHitsByColors : kHits)) FollowAgain(image, is_turned);
}

bool RegionTracker::Impl::IsLike(const Look& look) {
  return look.peak.value > kLeastToFind * slow_usual.value &&
         look.peak.sharpness > kLeastSharpness * slow_usual.sharpness &&
         colors.MatchOf(window, BoxInWindow(look.center_px)) > kLeastColorsToFind;
}

bool RegionTracker::Impl::IsTurned(double contrast, Look* look) {
  constexpr double kLeast = 0.45;  // mean of the slow filter's agreement and that of the colours
  constexpr double kMost = 2;      // by which sides and area may have changed
  constexpr double kNearer = 1.4;  // times as large, if it has come nearer meanwhile
  constexpr double kLeastContrast = 0.35, kLeastMatch = 0.8;  // without an outline
  const double slow_share = look->peak.value / slow_usual.value;
  const double match = colors.MatchOf(window, BoxInWindow(window_center));
  look->by_colors = FitColors(window_center);
  if (!look->by_colors) look->by_colors = FitColors(window_center, kNearer);
  if (!look->by_colors && contrast > kLeastContrast && match > kLeastMatch) {
    look->by_colors = {window_center, size};
  }
  return look->by_colors && 0.5 * (slow_share + match) > kLeast &&
         ChangeOf(look->by_colors->size, size) < kMost;
}

void RegionTracker::Impl::FollowAgain(const cv::Mat& image, bool is_turned) {
  state = RegionState::kFollowing;
  seen = time;
  if (is_turned) {
    See(image, center, 1);
    StartOn(kTemporal, &filter, &usual);
  } else {
    filter = slow;
    usual = slow_usual;
  }
  velocity.setZero();
  usual_speed = still_s = 0;
  place = 0;
  hits = 0;
}

void RegionTracker::Impl::Lose() {
  constexpr double kDoubtful = 1.5;
  if (state == RegionState::kLost) return;
  state = RegionState::kLost;
  if (ChangeOf(size, sure_size) < kDoubtful) return;
  size = sure_size;
  window_px = sure_window_px;
}

RegionReport RegionTracker::Impl::Track(const cv::Mat& image, Time now,
                                        const std::optional<RegionHint>& hint) {
  if (image.type() != type || image.size() != image_size) {
    state = RegionState::kLost;
    return Report(0);
  }
  constexpr double kShortest_s = 1e-3, kLongest_s = 1;
  const double seconds = std::clamp(ToSeconds(now - time), kShortest_s, kLongest_s);
  time = now;
  const Eigen::Vector2d shift = background.Update(image);
  Eigen::Vector2d expected = center + shift;
  if (state == RegionState::kFollowing) expected += kPredictedShare * seconds * velocity;
  if (state == RegionState::kCoasting) expected += seconds * velocity;
  if (hint && hits == 0) expected = hint->center_px;
  if (state != RegionState::kLost) {
    const Eigen::Vector2d before = center + shift;
    const Look look = Follow(image, expected);
    const double share = look.peak.value / usual.value;
    // A region that jumps away from its path in the world is something else. Beyond its borders an
    // image shows nothing.
    const bool is_there = IsInImage(look.center_px) &&
                          (!hint || (look.center_px - hint->center_px).norm() < ReachOf(*hint));
    if (share > kLeastToSee && is_there) {
      const Eigen::Vector2d size_before = size;
      const double window_before_px = window_px;
      const double agreement = Accept(image, look);
      // A prediction counts as seen only by a sure look: what hides a region looks a little like
      // it.
      const double least = state == RegionState::kFollowing ? kLeastToSee : kLeastToFind;
      if (agreement > least && !HasDrifted(center - before, seconds, agreement)) {
        state = RegionState::kFollowing;
        seen = now;
        hits = 0;
        return Report(ProbabilityOf(agreement));
      }
      size = size_before;
      window_px = window_before_px;
    }
  }
  if (state != RegionState::kLost) state = RegionState::kCoasting;
  center = expected.cwiseMax(0).cwiseMin(Eigen::Vector2d(image_size.width, image_size.height));
  const double unseen_s = ToSeconds(now - seen);
  if (unseen_s > kCoasting_s) Lose();
  // Without a hint the region may move on by a few of its sizes in a second.
  constexpr double kSizesPerSecond = 4;
  const double radius =
      hint ? RadiusOf(*hint)
           : kSizesPerSecond * unseen_s * std::sqrt(size.prod()) + velocity.norm() * unseen_s;
  const double reach = hint ? ReachOf(*hint) : std::numeric_limits<double>::infinity();
  Search(image, center, std::min(radius, std::hypot(image_size.width, image_size.height)), reach);
  if (state == RegionState::kFollowing) return Report(ProbabilityOf(kLeastToFind));
  return Report(state == RegionState::kLost ? 0 : ProbabilityOf(0));
}

RegionTracker::RegionTracker() : impl_(std::make_unique<Impl>()) {}
RegionTracker::~RegionTracker() = default;
RegionTracker::RegionTracker(RegionTracker&&) noexcept = default;
RegionTracker& RegionTracker::operator=(RegionTracker&&) noexcept = default;

void RegionTracker::Mark(const cv::Mat& image, Time time, const cv::Rect2d& box_px) {
  RequireImage(image);
  RequireBox(box_px, image.size());
  impl_->Mark(image, time, box_px);
}

RegionReport RegionTracker::Track(const cv::Mat& image, Time time,
                                  const std::optional<RegionHint>& hint) {
  return impl_->Track(image, time, hint);
}

}  // namespace kestrel
