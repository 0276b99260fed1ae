// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "kestrel/flight/doctor/finding.h"
#include "kestrel/flight/doctor/observations.h"

namespace kestrel {

// Speed of a vehicle when none is given, from the paper: 15 km/h.
inline constexpr double kUsualSpeed_mps = 4.2;
// Speed margin of the UAV over the target.
inline constexpr double kSpeedMargin_mps = 3;

// The wanted value of a parameter.
struct Wanted {
  double value;
  std::string_view why;  // the consequence otherwise
  bool needs_reboot = false;
};

// Checks one parameter after the other and collects the findings.
class ParameterRules {
 public:
  explicit ParameterRules(const DoctorObservations& observations) : all_(observations) {}

  std::optional<double> Find(std::string_view name) const {
    const auto found = all_.parameters.find(name);
    if (found == all_.parameters.end()) return std::nullopt;
    return found->second.value;
  }
  bool IsSet(std::string_view name, int bit) const {
    return (static_cast<int>(Find(name).value_or(0)) >> bit & 1) != 0;
  }

  // Adds a finding: good where 'is_good', else 'otherwise' with the value to set. A parameter that
  // the autopilot does not have is left out.
  template <class IsGood>
  void Want(std::string_view name, Verdict otherwise, const Wanted& wanted, const IsGood& is_good) {
    const auto found = all_.parameters.find(name);
    if (found == all_.parameters.end()) return;
    const ReportedParameter& reported = found->second;
    Finding finding = Good(reported.own_name, fmt::format("{:g}", reported.value / reported.scale));
    if (!is_good(reported.value)) {
      finding.verdict = otherwise;
      finding.measured += fmt::format(": {}", wanted.why);
      finding.advice =
          fmt::format("param set {} {:g}{}; or kestrel doctor --fix", reported.own_name,
                      wanted.value / reported.scale, wanted.needs_reboot ? ", then reboot" : "");
      finding.fix = ParameterFix{std::string(name), wanted.value, wanted.needs_reboot};
    }
    findings_.push_back(std::move(finding));
  }
  void WantExactly(std::string_view name, Verdict otherwise, const Wanted& wanted) {
    Want(name, otherwise, wanted, [&](double value) { return value == wanted.value; });
  }
  void WantAtLeast(std::string_view name, Verdict otherwise, double least, const Wanted& wanted) {
    Want(name, otherwise, wanted, [&](double value) { return value >= least; });
  }
  void WantBit(std::string_view name, Verdict otherwise, int bit, std::string_view why) {
    const auto now = static_cast<int>(Find(name).value_or(0));
    Want(name, otherwise, {static_cast<double>(now | 1 << bit), why},
         [&](double value) { return (static_cast<int>(value) >> bit & 1) != 0; });
  }
  void Add(Finding finding) { findings_.push_back(std::move(finding)); }

  // Verdict where targets are ignored: set-points land without them, but less surely.
  Verdict without_targets() const { return all_.use.guides ? Verdict::kDoubtful : Verdict::kWrong; }
  bool moves() const { return all_.use.target_mps.has_value(); }
  // Wanted speed of the UAV, m/s.
  double wanted_mps() const { return target_mps() + kSpeedMargin_mps; }
  double target_mps() const { return all_.use.target_mps.value_or(kUsualSpeed_mps); }
  const DoctorObservations& all() const { return all_; }
  std::vector<Finding> Take() { return std::move(findings_); }

 private:
  const DoctorObservations& all_;
  std::vector<Finding> findings_;
};

// Returns the delay of the link, one way: as the user gives it, or half of the round trip, s.
inline double LinkDelayOf(const DoctorObservations& observations) {
  return observations.use.link_delay_s.value_or(observations.link.round_trip_s / 2);
}

}  // namespace kestrel
