// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/comms/mavlink/time_sync.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "kestrel/core/base/robust_statistics.h"

namespace kestrel {
namespace {

constexpr double kCell_s = 0.2;

// Behaviour of a clock.
struct ClockKind {
  double window_s;      // time over which its drift is constant
  double max_drift;     // largest drift of a working clock of this kind
  double drift_sigma;   // usual drift
  double drift_wander;  // uncertainty of the drift once no messages come any more
};
constexpr ClockKind kCrystal = {90, 500e-6, 50e-6, 20e-6};
// An autopilot in software, whose time is that of a simulation: it falls behind by a percent or so,
// stalls and catches up, depending on the computer's load. The fit should follow its typical time,
// not its stalls.
constexpr ClockKind kSimulated = {8, 0.1, 0.02, 5e-3};
constexpr double kSimulatedOffset_s = 2;  // part of the window used for the present offset
constexpr int kSimulatedCells = 40;       // cells that its window is divided into

constexpr const ClockKind& KindOf(bool is_crystal) { return is_crystal ? kCrystal : kSimulated; }

constexpr int kMinRoundTrips = 3;

}  // namespace

// True when differences of such times can be computed: for a clock that counts from its start or
// from 1970.
bool TimeSync::IsClock(std::int64_t remote_ns) {
  constexpr std::int64_t kLimit = std::int64_t{1} << 61;
  return remote_ns > -kLimit && remote_ns < kLimit;
}

void TimeSync::Start(std::int64_t remote_ns, Time local) {
  has_origin_ = true;
  local_origin_ = local;
  remote_origin_ = remote_ns;
}

void TimeSync::Reset() {
  const int jumps = jumps_;
  const bool is_crystal = is_crystal_;
  *this = TimeSync();
  jumps_ = jumps;
  is_crystal_ = is_crystal;
}

TimeSync::Cell& TimeSync::CellAt(double time_s) {
  const auto index = static_cast<std::int64_t>(std::floor(time_s / kCell_s));
  const auto count = static_cast<std::int64_t>(kCells);
  Cell& cell = cells_[static_cast<std::size_t>(((index % count) + count) % count)];
  if (cell.index != index) cell = {index, {}, {}};
  return cell;
}

double TimeSync::OffsetOf(std::int64_t remote_ns, double time_s) const {
  return ToSeconds(Duration(remote_ns - remote_origin_)) - time_s;
}

double TimeSync::OffsetAt(double time_s) const {
  return line_.offset_s + line_.drift * (time_s - line_.time_s);
}

// 'excess_s': by how much a message was faster than possible, if the estimated offset is right. The
// error of the offset is at most half of the fastest round trip.
bool TimeSync::IsPossible(double excess_s, int* impossible) {
  constexpr double kMargin_s = 0.005;
  constexpr int kMaxImpossible = 3;
  constexpr double kJump_s = 1;  // no clock stalls or catches up by so much
  // Its stalls are outliers of a robust fit.
  if (!is_crystal_ && excess_s <= kJump_s) {
    *impossible = 0;
    return true;
  }
  if (!is_known_ || round_trips_ < kMinRoundTrips || excess_s < line_.width_s / 2 + kMargin_s) {
    *impossible = 0;
    return true;
  }
  if (++*impossible < kMaxImpossible) return false;
  if (excess_s > kJump_s) {
    ++jumps_;
    Reset();
    return false;
  }
  // It drifts more than a crystal does. The last estimate holds until there is a new one.
  is_crystal_ = false;
  *impossible = 0;
  return true;
}

void TimeSync::AddRoundTrip(Time sent, std::int64_t remote_ns, Time received) {
  if (received < sent || !IsClock(remote_ns)) return;
  if (!has_origin_) Start(remote_ns, sent);
  const double sent_s = Seconds(sent);
  const double there_s = OffsetOf(remote_ns, sent_s);
  if (!IsPossible(OffsetAt(sent_s) - there_s, &impossible_there_)) return;
  if (!AddBack(remote_ns, Seconds(received))) return;
  Sample& fastest = CellAt(sent_s).there;
  if (there_s < fastest.bound_s) fastest = {sent_s, there_s};
  ++round_trips_;
  Fit(Seconds(received));
}

void TimeSync::AddOneWay(std::int64_t remote_ns, Time received) {
  if (!IsClock(remote_ns)) return;
  if (!has_origin_) Start(remote_ns, received);
  if (AddBack(remote_ns, Seconds(received))) Fit(Seconds(received));
}

bool TimeSync::AddBack(std::int64_t remote_ns, double received_s) {
  const double back_s = -OffsetOf(remote_ns, received_s);
  if (!IsPossible(-OffsetAt(received_s) - back_s, &impossible_back_)) return false;
  Sample& fastest = CellAt(received_s).back;
  if (back_s < fastest.bound_s) fastest = {received_s, back_s};
  newest_s_ = std::max(newest_s_, received_s);
  return true;
}

TimeSync::Strip TimeSync::Sum(double now_s) const {
  Strip strip;
  double sum_s = 0;
  double there_sum_s = 0;
  double back_sum_s = 0;
  double first_there_s = std::numeric_limits<double>::infinity();
  double first_back_s = first_there_s;
  const auto oldest =
      static_cast<std::int64_t>(std::floor((now_s - KindOf(is_crystal_).window_s) / kCell_s));
  for (const Cell& cell : cells_) {
    if (cell.index <= oldest) continue;
    if (std::isfinite(cell.there.bound_s)) {
      ++strip.there;
      sum_s += cell.there.time_s;
      there_sum_s += cell.there.bound_s;
      first_there_s = std::min(first_there_s, cell.there.bound_s);
    }
    if (std::isfinite(cell.back.bound_s)) {
      ++strip.back;
      sum_s += cell.back.time_s;
      back_sum_s += cell.back.bound_s;
      first_back_s = std::min(first_back_s, cell.back.bound_s);
    }
  }
  strip.newest_s = now_s;
  if (strip.there + strip.back > 0) strip.mean_time_s = sum_s / (strip.there + strip.back);
  if (strip.there > 0 && strip.back > 0) {
    strip.mean_slack_s =
        (there_sum_s / strip.there - first_there_s + back_sum_s / strip.back - first_back_s) / 2;
  }
  return strip;
}

TimeSync::Bounds TimeSync::BoundsFor(double drift, double center_s) const {
  const auto oldest =
      static_cast<std::int64_t>(std::floor((newest_s_ - KindOf(is_crystal_).window_s) / kCell_s));
  Bounds bounds = {std::numeric_limits<double>::infinity(),
                   std::numeric_limits<double>::infinity()};
  for (const Cell& cell : cells_) {
    if (cell.index <= oldest) continue;
    bounds.there_s =
        std::min(bounds.there_s, cell.there.bound_s - drift * (cell.there.time_s - center_s));
    bounds.back_s =
        std::min(bounds.back_s, cell.back.bound_s + drift * (cell.back.time_s - center_s));
  }
  return bounds;
}

// Returns the drift with the widest strip, minus a penalty for unlikely drifts: the most likely
// drift when delays beyond the fastest are distributed exponentially. The width is a concave
// function of the drift; it is maximized by golden section search.
double TimeSync::BestDrift(const Strip& strip) const {
  constexpr double kGolden = 0.6180339887498949;
  constexpr int kSteps = 25;  // to 0.01 ppm of a crystal
  const ClockKind& kind = KindOf(is_crystal_);
  const double weight = strip.mean_slack_s /
                        (std::min(strip.there, strip.back) * kind.drift_sigma * kind.drift_sigma) /
                        2;
  const auto worth = [&](double drift) {
    return BoundsFor(drift, strip.mean_time_s).width_s() - weight * drift * drift;
  };
  double low = -kind.max_drift;
  double high = kind.max_drift;
  double left = high - kGolden * (high - low);
  double right = low + kGolden * (high - low);
  double left_worth = worth(left);
  double right_worth = worth(right);
  for (int i = 0; i < kSteps; ++i) {
    if (left_worth > right_worth) {
      high = right;
      right = left;
      right_worth = left_worth;
      left = high - kGolden * (high - low);
      left_worth = worth(left);
    } else {
      low = left;
      left = right;
      left_worth = right_worth;
      right = low + kGolden * (high - low);
      right_worth = worth(right);
    }
  }
  return (low + high) / 2;
}

void TimeSync::Fit(double now_s) {
  constexpr double kEvery_s = 0.05;
  if (round_trips_ > kMinRoundTrips && now_s - fitted_s_ < kEvery_s && now_s >= fitted_s_) return;
  fitted_s_ = now_s;
  const Strip strip = Sum(newest_s_ = std::max(newest_s_, now_s));
  if (round_trips_ >= kMinRoundTrips && strip.there > 0 && strip.back > 0) {
    if (is_crystal_) {
      FitBoth(strip);
    } else {
      FitSimulated(strip.newest_s);
    }
  } else if (round_trips_ == 0) {
    FitOneWay(strip);
  }
}

// The old estimate stays as long as it is better than one from the present messages: after a pause
// there are few.
void TimeSync::FitBoth(const Strip& strip) {
  constexpr double kSpread = 1.0;  // error of the fit, measured, in units of slack per message
  const int count = std::min(strip.there, strip.back);
  Line line;
  line.time_s = strip.mean_time_s;
  line.drift = BestDrift(strip);
  const Bounds bounds = BoundsFor(line.drift, line.time_s);
  line.offset_s = (bounds.there_s - bounds.back_s) / 2;
  line.width_s = std::max(bounds.width_s(), 0.0);
  line.fit_sigma_s =
      kSpread * strip.mean_slack_s / count + (count < kMinRoundTrips ? line.width_s / 2 : 0);
  // Moves both to the time of the newest message.
  line.offset_s += line.drift * (strip.newest_s - line.time_s);
  line.time_s = strip.newest_s;
  constexpr int kEnough = 50;
  const bool was_fitted = is_known_ && round_trips_ > kMinRoundTrips;
  if (is_crystal_ && was_fitted && count < kEnough && SigmaAt(line.time_s) < line.fit_sigma_s)
    return;
  line_ = line;
  is_known_ = true;
}

// Collects the middles between there and back of all cells with both, the newest last; returns
// their number.
std::size_t TimeSync::CollectMiddles(double now_s, std::span<Middle> middles) const {
  const auto newest = static_cast<std::int64_t>(std::floor(now_s / kCell_s));
  const auto count = static_cast<std::int64_t>(kCells);
  std::size_t size = 0;
  for (auto index = newest - static_cast<std::int64_t>(middles.size()) + 1; index <= newest;
       ++index) {
    const Cell& cell = cells_[static_cast<std::size_t>(((index % count) + count) % count)];
    if (cell.index != index || !std::isfinite(cell.there.bound_s + cell.back.bound_s)) continue;
    middles[size++] = {(cell.there.time_s + cell.back.time_s) / 2,
                       (cell.there.bound_s - cell.back.bound_s) / 2,
                       cell.there.bound_s + cell.back.bound_s};
  }
  return size;
}

// Returns the median slope of all pairs, drawn towards zero where they are close together.
double TimeSync::MedianDrift(std::span<const Middle> middles) {
  constexpr double kSure_s = 1;
  std::array<double, kSimulatedCells*(kSimulatedCells - 1) / 2> slopes;
  std::size_t size = 0;
  for (std::size_t i = 1; i < middles.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const double apart_s = middles[i].time_s - middles[j].time_s;
      if (apart_s > kCell_s / 2) {
        slopes[size++] = (middles[i].offset_s - middles[j].offset_s) / apart_s;
      }
    }
  }
  if (size == 0) return 0;
  const double span_s = middles.back().time_s - middles.front().time_s;
  const double weight = span_s * span_s / (span_s * span_s + kSure_s * kSure_s);
  return weight * std::clamp(MedianInPlace(std::span(slopes).first(size)), -kSimulated.max_drift,
                             kSimulated.max_drift);
}

// Fits a line to the middles that is robust against up to half of the newest ones.
void TimeSync::FitSimulated(double now_s) {
  constexpr double kLeastSigma_s = 1e-3;
  std::array<Middle, kSimulatedCells> all;
  const std::span<Middle> middles(all.data(), CollectMiddles(now_s, all));
  if (middles.empty()) return;
  Line line;
  line.time_s = now_s;
  line.drift = MedianDrift(middles);
  std::array<double, kSimulatedCells> values;
  std::array<double, kSimulatedCells> widths;
  std::size_t size = 0;
  for (const Middle& middle : middles) {
    if (middle.time_s < middles.back().time_s - kSimulatedOffset_s) continue;
    widths[size] = middle.width_s;
    values[size++] = middle.offset_s + line.drift * (now_s - middle.time_s);
  }
  line.offset_s = MedianInPlace(std::span(values).first(size));
  line.width_s = std::max(MedianInPlace(std::span(widths).first(size)), 0.0);
  for (double& value : std::span(values.data(), size)) value = std::abs(value - line.offset_s);
  line.fit_sigma_s = kLeastSigma_s + MedianInPlace(std::span(values).first(size));
  line_ = line;
  is_known_ = true;
}

void TimeSync::FitOneWay(const Strip& strip) {
  constexpr int kMinCells = 10;
  constexpr double kSigma_s = 0.02;
  if (strip.back < kMinCells) return;
  const Bounds bounds = BoundsFor(0, strip.mean_time_s);
  line_ = {strip.newest_s, -bounds.back_s, 0, 0, kSigma_s};
  is_known_ = true;
}

Time TimeSync::ToLocal(std::int64_t remote_ns) const {
  const double remote_s = ToSeconds(Duration(remote_ns - remote_origin_));
  const double since_s = (remote_s - line_.time_s - line_.offset_s) / (1 + line_.drift);
  return local_origin_ + DurationFromSeconds(line_.time_s + since_s);
}

std::int64_t TimeSync::ToRemote(Time time) const {
  const double time_s = Seconds(time);
  return remote_origin_ + DurationFromSeconds(time_s + OffsetAt(time_s)).count();
}

double TimeSync::SigmaAt(double time_s) const {
  return line_.fit_sigma_s +
         KindOf(is_crystal_).drift_wander * std::max(time_s - line_.time_s, 0.0);
}

double TimeSync::sigma_s(Time now) const {
  constexpr double kAsymmetry = 0.05;  // share of the fastest round trip
  return std::hypot(SigmaAt(Seconds(now)), kAsymmetry * line_.width_s);
}

}  // namespace kestrel
