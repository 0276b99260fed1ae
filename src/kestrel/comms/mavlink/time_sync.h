// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>

#include "kestrel/core/base/time.h"

namespace kestrel {

// Estimates offset and rate of another computer's clock from messages that carry its time: the
// remote time of a round trip lies between two local times, and a stamped message was not received
// before it was sent. A delayed message hardly constrains the clock. The clock is therefore fitted
// by the middle of the widest straight strip that contains no message of the last minute and a
// half, between the fastest messages there and the fastest messages back. Fixed memory; not
// thread-safe.
class TimeSync {
 public:
  // A request sent at 'sent' was answered with the remote time 'remote_ns', received at 'received'.
  // An impossible one (received before it was sent) is left out.
  void AddRoundTrip(Time sent, std::int64_t remote_ns, Time received);

  // A message that was sent at the remote time 'remote_ns' was received at 'received'.
  void AddOneWay(std::int64_t remote_ns, Time received);

  // The other computer has restarted: nothing is known any more.
  void Reset();

  // True from the third round trip on; with one-way messages alone after two seconds, as if the
  // fastest had taken no time, with the uncertainty that this causes.
  bool is_known() const { return is_known_; }

  // Converts between the remote clock's time and the local time. Needs is_known().
  Time ToLocal(std::int64_t remote_ns) const;
  std::int64_t ToRemote(Time time) const;

  // Standard deviation of ToLocal at 'now', s. It contains the error of the fit, the possible drift
  // since the last message, and the possible asymmetry of the fastest messages there and back,
  // which cannot be measured.
  double sigma_s(Time now) const;

  // Relative rate of the remote clock minus 1: 5e-5 gains 50 us per second.
  double drift() const { return line_.drift; }

  // Fastest round trip of the last minute and a half; for a simulated clock the typical one.
  Duration round_trip() const { return DurationFromSeconds(line_.width_s); }

  // Number of jumps of the remote clock: three messages in a row that are impossible without a
  // jump. A clock that drifts more than a crystal (a simulated autopilot) does not count as
  // jumping: from then on its typical time is followed over some seconds, without its stalls.
  int jumps() const { return jumps_; }

 private:
  // Small numbers: times in seconds since 'local_origin_'; offsets of the remote clock relative to
  // 'remote_origin_' and these times.
  struct Sample {
    double time_s = 0;
    double bound_s = std::numeric_limits<double>::infinity();
  };
  // The fastest messages within a fifth of a second.
  struct Cell {
    std::int64_t index = -1;
    Sample there;  // upper bound of the offset
    Sample back;   // minus the lower bound of the offset
  };
  struct Line {
    double time_s = 0;  // time of 'offset_s'
    double offset_s = 0;
    double drift = 0;
    double width_s = 0;  // width of the strip: the fastest round trip
    double fit_sigma_s = std::numeric_limits<double>::infinity();
  };
  // Sums over the cells within the window.
  struct Strip {
    int there = 0;
    int back = 0;
    double mean_time_s = 0;
    double newest_s = 0;
    double mean_slack_s = 0;  // mean delay of messages beyond the fastest
  };
  struct Bounds {
    double there_s;
    double back_s;
    double width_s() const { return there_s + back_s; }
  };

  // Middle between the fastest messages there and back of a cell.
  struct Middle {
    double time_s = 0;
    double offset_s = 0;
    double width_s = 0;
  };

  static constexpr std::size_t kCells = 450;

  static bool IsClock(std::int64_t remote_ns);
  void Start(std::int64_t remote_ns, Time local);
  Cell& CellAt(double time_s);
  double Seconds(Time time) const { return ToSeconds(time - local_origin_); }
  double OffsetOf(std::int64_t remote_ns, double time_s) const;
  double OffsetAt(double time_s) const;
  bool IsPossible(double excess_s, int* impossible);
  bool AddBack(std::int64_t remote_ns, double received_s);
  void Fit(double now_s);
  void FitBoth(const Strip& strip);
  void FitSimulated(double now_s);
  void FitOneWay(const Strip& strip);
  std::size_t CollectMiddles(double now_s, std::span<Middle> middles) const;
  static double MedianDrift(std::span<const Middle> middles);
  Strip Sum(double now_s) const;
  Bounds BoundsFor(double drift, double center_s) const;
  double BestDrift(const Strip& strip) const;
  double SigmaAt(double time_s) const;

  bool has_origin_ = false;
  bool is_known_ = false;
  // The remote clock has run as steadily as a crystal so far. False once it has drifted more, as
  // the clock of a simulated autopilot does.
  bool is_crystal_ = true;
  Time local_origin_{};
  std::int64_t remote_origin_ = 0;
  std::array<Cell, kCells> cells_;
  double newest_s_ = 0;
  double fitted_s_ = 0;
  int round_trips_ = 0;
  int impossible_there_ = 0;  // messages in a row
  int impossible_back_ = 0;
  int jumps_ = 0;
  Line line_;
};

}  // namespace kestrel
