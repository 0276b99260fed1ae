// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <variant>

#include "kestrel/console/console_feed.h"
#include "kestrel/console/console_options.h"
#include "kestrel/console/flight_health.h"
#include "kestrel/console/hunt_view.h"
#include "kestrel/console/landing_view.h"
#include "kestrel/console/web_server.h"
#include "kestrel/onboard/bounded_queue.h"
#include "kestrel/onboard/flight_observer.h"

namespace kestrel {

// What a flight looks for.
using FlightView = std::variant<LandingView, HuntView>;

// A flight on the page. What the vision sees is handed to a thread that makes of it what the page
// shows, and only while somebody looks: else a frame costs the vision one look at a number.
class FlightConsole : public FlightObserver {
 public:
  // Serves from now on. 'title': of the page. Throws InputError as WebServer does.
  FlightConsole(const ConsoleOptions& options, const std::string& title, FlightView view);
  ~FlightConsole() override;
  FlightConsole(const FlightConsole&) = delete;
  FlightConsole& operator=(const FlightConsole&) = delete;

  // What to open in a browser on this computer.
  std::string url() const { return server_.url(); }

  // Something that happened, in words. By any thread.
  void Say(EventLevel level, const std::string& text) {
    feed_.Add(ConsoleEvent{Now(), level, text});
  }

  void See(const Frame& frame, const LandingObservation& observation) override;
  void See(const Frame& frame, const HuntObservation& observation) override;
  void See(const FlightReport& report) override;

 private:
  struct SeenFrame {
    cv::Mat image;
    Time captured;
    Duration latency{};  // from capture until it was processed
    std::variant<LandingObservation, HuntObservation> observation;
  };

  void Show();
  void Show(SeenFrame seen);
  void Show(const LandingObservation& observation, Duration latency);
  void Show(const HuntObservation& observation, Duration latency);
  void AddSample(ConsoleSample sample, Duration latency);
  void SetVision(const ConsoleStatus& status);

  FlightView view_;
  ConsoleFeed feed_;
  BoundedQueue<SeenFrame> seen_;

  // Of the thread that shows.
  ConsoleFrame frame_;

  // Of the flight's own thread.
  FlightHealth health_;

  std::atomic<double> link_rate_hz_;  // NaN: not known
  std::mutex mutex_;                  // of what is below
  ConsoleStatus vision_;              // what the newest frame says
  ConsoleStatus told_;                // the page, the last time

  WebServer server_;
  std::atomic<bool> is_over_{false};
  std::thread thread_;
};

}  // namespace kestrel
