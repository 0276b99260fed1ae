// SPDX-License-Identifier: BSD-3-Clause
// Flies simulated autopilots without any position over a pad, over MAVLink, in simulated time and
// without images, and prints how well they hover and land, and how far they get when the pad is
// lost. Usage: no_position_accuracy [--flights N] [--first-seed N] [--case TEXT] [--log]
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "flight_arguments.h"
#include "kestrel/simulation/autopilots/test_no_position_flight.h"
#include "report_main.h"

namespace kestrel {
namespace {

struct Arguments : FlightArguments {
  bool logs = false;
};

class Report {
 public:
  explicit Report(const Arguments& arguments) : arguments_(arguments) {}

  void Run() {
    fmt::print("| flight | autopilot | result |\n|---|---|---|\n");
    for (const double height_m : {1.0, 3.0, 6.0}) {
      Hover(height_m, 0, 0);
      Hover(height_m, 3, 0);
      Hover(height_m, 3, kGusts);
    }
    for (const double wind_mps : {0.0, 3.0}) Land("a pad that stands", 0, wind_mps, 0.05);
    for (const double pad_mps : {1.0, 2.0}) {
      Land(fmt::format("a pad at {:g} m/s", pad_mps), pad_mps, 3, 0.15);
    }
    LandByPosition("is lost", &NoPositionSetup::gnss_lost_after_s);
    LandByPosition("jumps by 5 m", &NoPositionSetup::gnss_jumps_after_s);
    for (const double height_m : {1.0, 3.0, 6.0}) {
      for (const double lost_s : {0.5, 1.0, 3.0, 60.0}) Lose(height_m, lost_s, false);
      Lose(height_m, 60, true);
    }
    for (const bool hangs : {false, true}) Abandon(hangs);
    Change("compass turns by 40 degrees",
           [](NoPositionSetup* setup) { setup->turn_after_s = kNoPositionStart_s + 10; });
    Change("hover thrust a fifth too high",
           [](NoPositionSetup* setup) { setup->hover_thrust_error = 0.2; });
    Change("hover thrust a fifth too low",
           [](NoPositionSetup* setup) { setup->hover_thrust_error = -0.2; });
    Change("battery sags by a fifth in a minute",
           [](NoPositionSetup* setup) { setup->battery_sag = 0.2; });
    Change("accelerometer shakes by 2 m/s2", [](NoPositionSetup* setup) { setup->vibration = 2; });
    Change("pad accelerates by 1.5 m/s2 for 5 s", [](NoPositionSetup* setup) {
      constexpr double kFastest_mps = 7.5;
      setup->job.pad_moves = true;
      setup->pad_mps = kFastest_mps;
      setup->drive_after_s = kNoPositionStart_s + 10;
      setup->drive_acceleration = 1.5;
    });
  }

 private:
  static constexpr double kSettle_s = 8, kGusts = 0.25;

  // Calls fly(setup) for each seed, and prints what print() returns for each autopilot.
  void Each(const std::string& name, const NoPositionSetup& setup,
            const std::function<void(const NoPositionSetup&)>& fly,
            const std::function<std::string()>& print) {
    if (!arguments_.Wants(name)) return;
    for (const auto firmware : {AutopilotFirmware::kArduPilot, AutopilotFirmware::kPx4}) {
      for (int i = 0; i < arguments_.flights; ++i) {
        NoPositionSetup one = setup;
        one.firmware = firmware;
        one.seed = arguments_.first_seed + static_cast<std::uint64_t>(i);
        fly(one);
      }
      fmt::print("| {} | {} | {} |\n", name,
                 firmware == AutopilotFirmware::kPx4 ? "PX4" : "ArduPilot", print());
      std::fflush(stdout);
    }
  }
  void Log(const PointedFlight& flight) const {
    if (arguments_.logs) fmt::print(stderr, "{}---\n", flight.reported);
  }
  static double Take(std::vector<double>* values, double part) {
    if (values->empty()) return 0;
    std::ranges::sort(*values);
    return (*values)[static_cast<std::size_t>(part * static_cast<double>(values->size() - 1))];
  }

  void Hover(double height_m, double wind_mps, double gusts) {
    NoPositionSetup setup;
    setup.job.lands = false;
    setup.altitude_m = height_m;
    setup.wind_mps = wind_mps;
    setup.gusts = gusts;
    HoverFor(fmt::format("hover at {:g} m, wind {:g} m/s{}", height_m, wind_mps,
                         gusts > 0 ? ", gusts of a quarter" : ""),
             setup);
  }
  void Change(const std::string& name, const std::function<void(NoPositionSetup*)>& change) {
    NoPositionSetup setup;
    setup.job.lands = false;
    change(&setup);
    HoverFor(name, setup);
  }
  void HoverFor(const std::string& name, const NoPositionSetup& setup) {
    constexpr double kHover_s = 60;
    std::vector<double> within, largest, height, sink;
    int stayed = 0;
    Each(
        name, setup,
        [&](const NoPositionSetup& one) {
          PointedFlight flight = NoPositionFlightOf(one);
          flight.Fly(kNoPositionStart_s);
          const double settle_s = one.hover_thrust_error != 0 ? 0.1 : kSettle_s;
          flight.Fly(settle_s);
          const HoverErrors errors = MeasureHover(&flight, kHover_s, one.altitude_m);
          within.push_back(errors.within_95);
          largest.push_back(errors.largest);
          height.push_back(errors.height_95);
          sink.push_back(errors.fastest_sink_mps);
          stayed += flight.model.result().left ? 0 : 1;
          Log(flight);
        },
        [&] {
          const std::string result = fmt::format(
              "within (95 %) {:.3f} m, worst flight {:.3f}; farthest {:.2f} m; height (95 %) "
              "{:.2f} m; sink {:.2f} m/s; to the end {} of {}",
              Take(&within, 0.5), Take(&within, 1), Take(&largest, 1), Take(&height, 1),
              Take(&sink, 1), stayed, arguments_.flights);
          for (auto* values : {&within, &largest, &height, &sink}) values->clear();
          stayed = 0;
          return result;
        });
  }

  void Land(const std::string& pad, double pad_mps, double wind_mps, double limit_m) {
    NoPositionSetup setup;
    setup.altitude_m = 4;
    setup.pad_mps = pad_mps;
    setup.job.pad_moves = pad_mps > 0;
    setup.wind_mps = wind_mps;
    setup.touchdown_heading = "30";
    LandAll(fmt::format("landing on {}, wind {:g} m/s", pad, wind_mps), setup, limit_m);
  }
  // Begins at 5 m. 'fault': when it happens.
  void LandByPosition(const std::string& what, double NoPositionSetup::*fault) {
    NoPositionSetup setup;
    setup.altitude_m = 5;
    setup.*fault = kNoPositionStart_s + 0.5;
    LandAll(fmt::format("GNSS {} in a landing at 5 m, wind 3 m/s", what), setup, 0.15);
  }
  void LandAll(const std::string& name, const NoPositionSetup& setup, double limit_m) {
    std::vector<double> offsets, times, headings;
    int on_pad = 0, within = 0;
    Each(
        name, setup,
        [&](const NoPositionSetup& one) {
          PointedFlight flight = NoPositionFlightOf(one);
          const bool is_down = flight.Land(90);
          const SitlResult& result = flight.model.result();
          Log(flight);
          if (!is_down || !result.contact || !result.contact->on_board) return;
          ++on_pad;
          offsets.push_back(result.offset_m());
          times.push_back(result.landing_s);
          if (one.touchdown_heading != std::string("any")) {
            const double off =
                result.contact->heading_in_pattern - Radians(std::atof(one.touchdown_heading));
            headings.push_back(std::abs(Degrees(std::remainder(off, kFullTurn))));
          }
          within += result.offset_m() <= limit_m ? 1 : 0;
        },
        [&] {
          std::string result = fmt::format(
              "on the pad {} of {}, within {:g} m {}; median {:.3f}, largest {:.3f} m; {:.0f} s",
              on_pad, arguments_.flights, limit_m, within, Take(&offsets, 0.5), Take(&offsets, 1),
              Take(&times, 0.5));
          if (!headings.empty()) {
            result += fmt::format("; heading off by {:.1f} deg at most", Take(&headings, 1));
          }
          for (auto* values : {&offsets, &times, &headings}) values->clear();
          on_pad = within = 0;
          return result;
        });
  }

  // The end of a flight that hovered, from an event on.
  struct Aftermath {
    std::vector<double> farthest, impact;
    int down = 0, back = 0;
  };
  void Watch(PointedFlight* flight, const std::function<void(double seconds)>& act,
             Aftermath* after) const {
    constexpr double kLongest_s = 40, kStep_s = 0.1;
    const Eigen::Vector3d place = flight->model.truth().world_from_body.translation;
    double farthest = 0;
    for (double s = 0; s < kLongest_s && flight->model.is_armed(); s += kStep_s) {
      act(s);
      flight->Fly(kStep_s);
      const Eigen::Vector3d off = flight->model.truth().world_from_body.translation - place;
      farthest = std::max(farthest, off.head<2>().norm());
    }
    after->farthest.push_back(farthest);
    const auto& contact = flight->model.result().contact;
    if (contact) after->impact.push_back(-contact->velocity_in_world.z());
    after->down += flight->model.is_armed() ? 0 : 1;
    after->back += flight->model.is_armed() ? 1 : 0;
    Log(*flight);
  }
  std::string Print(Aftermath* after) const {
    const std::string result = fmt::format(
        "farthest {:.2f} m (median {:.2f}); landed {}, flies on {} of {}; impact {:.2f} m/s",
        Take(&after->farthest, 1), Take(&after->farthest, 0.5), after->down, after->back,
        arguments_.flights, Take(&after->impact, 1));
    *after = {};
    return result;
  }
  NoPositionSetup Hovering(double height_m) const {
    NoPositionSetup setup;
    setup.job.lands = false;
    setup.altitude_m = height_m;
    return setup;
  }

  void Lose(double height_m, double lost_s, bool has_flow) {
    Aftermath after;
    NoPositionSetup setup = Hovering(height_m);
    setup.has_flow = has_flow;
    const std::string time =
        lost_s > 50 ? std::string("for good") : fmt::format("for {:g} s", lost_s);
    Each(
        fmt::format("pad lost {} at {:g} m, wind 3 m/s{}", time, height_m,
                    has_flow ? ", with flow" : ""),
        setup,
        [&](const NoPositionSetup& one) {
          PointedFlight flight = NoPositionFlightOf(one);
          flight.Fly(kNoPositionStart_s + kSettle_s);
          Watch(
              &flight, [&](double s) { flight.is_blind = s < lost_s; }, &after);
        },
        [&] { return Print(&after); });
  }
  void Abandon(bool hangs) {
    Aftermath after;
    Each(
        hangs ? "Kestrel hangs at 2 m" : "Kestrel is killed at 2 m", Hovering(2),
        [&](const NoPositionSetup& one) {
          PointedFlight flight = NoPositionFlightOf(one);
          flight.Fly(kNoPositionStart_s + kSettle_s);
          if (hangs) {
            flight.Hang();
          } else {
            flight.Kill();
          }
          Watch(
              &flight, [](double) {}, &after);
        },
        [&] { return Print(&after); });
  }

  Arguments arguments_;
};

}  // namespace
}  // namespace kestrel

int main(int argc, char** argv) {
  CLI::App app{"Flights over a pad without a position, and what becomes of them"};
  kestrel::Arguments arguments;
  arguments.AddTo(&app);
  app.add_flag("--log", arguments.logs, "Print what each flight reports");
  CLI11_PARSE(app, argc, argv);
  return kestrel::ReportMain([&] {
    kestrel::Report(arguments).Run();
    return 0;
  });
}
