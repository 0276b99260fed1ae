// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <filesystem>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <variant>
#include <vector>

#include "kestrel/app/console/colors/color_page.h"
#include "kestrel/app/console/colors/kept_frames.h"
#include "kestrel/app/console/flight/flight_health.h"
#include "kestrel/app/console/messages/console_feed.h"
#include "kestrel/app/views/task_view.h"
#include "kestrel/app/web_server/console_options.h"
#include "kestrel/app/web_server/web_server.h"
#include "kestrel/core/base/bounded_queue.h"
#include "kestrel/flight/doctor/flight_examination.h"
#include "kestrel/flight/session/asynchronous_sink.h"

namespace kestrel {

// Requests that the page may make of a flight. Each returns a sentence that says what was done, and
// throws InputError when it cannot be done. They may block.
struct FlightRequests {
  std::function<std::string(bool is_on)> record;  // switches recording on or off
  std::function<std::string(const cv::Mat& image, Time captured)> keep_snapshot;
  // Follows what was marked in the picture of this time.
  std::function<std::string(Time captured, const cv::Rect2d& box_px)> mark = {};
  std::function<std::string()> point = {};    // points the gimbal again that was left alone
  std::function<std::string()> confirm = {};  // lets the UAV fly to what is marked
  std::function<std::string()> stop = {};     // lets it stand still
  // Saves settings, each as "key=value", and returns the state of all that can be changed, with
  // what was saved or why not; none: only returns it. Does not throw InputError.
  std::function<ConsoleSettings(const std::vector<std::string>& settings)> settings;
};

// Places for what the page of colours keeps of a flight.
struct FlightColors {
  std::filesystem::path frames;  // folder for the kept frames; it must not exist yet
  std::string folder;            // for the model, its versions and the draft
  std::function<std::vector<std::string>()> warn;  // as in ColorSource
};

// A session on the page. A thread of its own turns the observations into what the page shows, and
// only while a browser looks: otherwise a frame costs the vision thread one read of a number.
class FlightConsole : public ObservationSink {
 public:
  // Starts the server. 'title': title of the page. 'views': of each camera. The page shows the
  // camera that sees the target, and checks the first one. 'channels' as for WebServer. 'colors':
  // for a hunt only; the page then teaches its model's colours. 'offers': commands of the page that
  // only some flights have. Throws InputError as WebServer and ColorPage do.
  FlightConsole(const ConsoleOptions& options, const std::string& title,
                const std::vector<TaskView>& views, FlightExamination examination,
                ChannelFeed* channels = nullptr, std::optional<FlightColors> colors = std::nullopt,
                const std::vector<ConsoleCommandKind>& offers = {});
  ~FlightConsole() override { Finish(); }
  FlightConsole(const FlightConsole&) = delete;
  FlightConsole& operator=(const FlightConsole&) = delete;

  // As WebServer::urls.
  std::vector<std::string> urls() const { return server_.urls(); }
  // URL for a viewer that speaks Foxglove's protocol.
  std::string viewer_url() const { return server_.viewer_url(); }

  // Starts a thread that answers requests; until then the requests of users wait. Call it once
  // only. What 'requests' use must live until Finish.
  void Answer(FlightRequests requests);

  bool IsWanted() const override { return feed_.IsWatched(); }
  void Take(const Observation& observation) override;
  void Take(const FlightReport& report) override { pictures_.Take(report); }
  void Take(const TeamReport& report) override { pictures_.Take(report); }
  void Take(const SessionEvent& event) override { feed_.Add(event); }
  // Answers no more requests; the page stays.
  void Finish() override;
  // Keeps the page after Finish, with how the flight ended, as long as a browser looks at it, or
  // has a moment ago, and 'is_stopped' returns false.
  void Stay(const std::function<bool()>& is_stopped);

 private:
  struct Image {
    cv::Mat image;  // empty: none yet
    Time captured;
  };
  class Page;

  void TeachColors(const FlightColors& colors, const TaskView& view);
  Image Newest();
  void Answer(const FlightRequests& requests, const ConsoleCommand& command);
  void KeepSnapshot(const FlightRequests& requests);
  void Mark(const FlightRequests& requests, const std::vector<std::string>& mark);
  void Report(EventLevel level, const std::string& text) {
    feed_.Add(SessionEvent{Now(), level, text});
  }

  ConsoleFeed feed_;
  BoundedQueue<FrameSample> arrivals_;
  std::mutex mutex_;  // protects shown_
  Image shown_;       // the newest frame
  WebServer server_;
  std::optional<KeptFrames> kept_;  // frames of the page of colours
  std::optional<ColorPage> colors_;
  AsynchronousSink pictures_;
  std::atomic<bool> is_over_{false};
  std::thread answering_thread_;
};

}  // namespace kestrel
