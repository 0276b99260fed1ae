// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>

#include "kestrel/core/base/time.h"

namespace kestrel {

// What the clock of another computer says and how fast it runs, from messages that say it: the
// remote time of a round trip lies between two local ones, and a stamped message was not received
// before it was sent. A message that was held up says little; so the clock is taken to run along
// the middle of the widest straight strip that no message of the last minute and a half lies in,
// between the fastest ways there and the fastest ways back. Fixed memory; not thread-safe.
class TimeSync {
 public:
  // A question sent at 'sent' was answered with the remote time 'remote_ns', received at
  // 'received'. An impossible one (received before it was sent) is left out.
  void AddRoundTrip(Time sent, std::int64_t remote_ns, Time received);

  // A message that was sent at the remote time 'remote_ns' was received at 'received'.
  void AddOneWay(std::int64_t remote_ns, Time received);

  // The other computer started again: nothing is known any more.
  void Reset();

  // From the third round trip on; from one-way messages alone after two seconds of them, as if the
  // fastest had taken no time, with the uncertainty that this costs.
  bool is_known() const { return is_known_; }

  // The instant at which the remote clock says 'remote_ns', and back. Needs is_known().
  Time ToLocal(std::int64_t remote_ns) const;
  std::int64_t ToRemote(Time time) const;

  // Standard deviation of ToLocal at 'now', s: of the fit, of what the clocks may have drifted
  // since the last message, and of that the fastest way there need not take as long as the fastest
  // back, which nobody can see from here.
  double sigma_s(Time now) const;

  // By how much the remote clock is faster, 1: 5e-5 gains 50 us in a second.
  double drift() const { return line_.drift; }

  // The fastest round trip of the last minute and a half; of a clock in software what it is mostly.
  Duration round_trip() const { return DurationFromSeconds(line_.width_s); }

  // How often the remote clock was found to have jumped: three messages in a row that it cannot
  // have sent unless it did. One that drifts as no crystal does (an autopilot in software) does
  // not: from then on what it shows mostly is followed over some seconds, and its stalls are not.
  int jumps() const { return jumps_; }

 private:
  // Seconds since 'local_origin_' for times, and of the remote clock ahead of 'remote_origin_' and
  // these for offsets: small numbers.
  struct Sample {
    double time_s = 0;
    double bound_s = std::numeric_limits<double>::infinity();
  };
  // The fastest messages of a fifth of a second.
  struct Cell {
    std::int64_t index = -1;
    Sample there;  // the offset is no more than the bound
    Sample back;   // the offset is no less than minus the bound
  };
  struct Line {
    double time_s = 0;  // where 'offset_s' is
    double offset_s = 0;
    double drift = 0;
    double width_s = 0;  // of the strip: the fastest round trip
    double fit_sigma_s = std::numeric_limits<double>::infinity();
  };
  // Sums over the cells that are young enough.
  struct Strip {
    int there = 0;
    int back = 0;
    double mean_time_s = 0;
    double newest_s = 0;
    double mean_slack_s = 0;  // by how much messages were slower than the fastest
  };
  struct Bounds {
    double there_s;
    double back_s;
    double width_s() const { return there_s + back_s; }
  };

  // Between the fastest ways there and back of a cell.
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
  bool is_crystal_ = true;  // it runs as steadily as clocks do, as far as is known
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
