// SPDX-License-Identifier: BSD-3-Clause
// Sessions: a source, the vision, and functions of Python that get the results.
#include "kestrel/session.h"

#include <array>
#include <atomic>
#include <exception>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include <fmt/format.h>

#include "arrays.h"
#include "bindings.h"
#include "enum_casters.h"
#include "kestrel/app/fly/fly_autopilot.h"
#include "kestrel/app/fly/fly_source.h"
#include "kestrel/asynchronous_sink.h"
#include "kestrel/comms/dds/dds_domain.h"
#include "kestrel/io/recording/tables/follow_csv.h"
#include "kestrel/io/recording/tables/landing_csv.h"
#include "kestrel/io/recording/tables/object_csv.h"
#include "kestrel/simulation/autopilots/sitl_result.h"
#include "option_values.h"
#include "recordings.h"
#include "seen.h"
#include "value_class.h"

namespace kestrel::python {
namespace {

namespace py = pybind11;

// A frame and what was seen in it, for functions of Python.
struct SeenFrame {
  Frame frame;
  std::variant<SeenLanding, SeenHunt, FollowObservation> seen;
  std::optional<Duration> latency;
};

// Pad and objects of a session, for drawing its results.
struct Views {
  std::vector<std::shared_ptr<PadView>> pads;  // one for each camera
  std::shared_ptr<ObjectModel> model;

  SeenFrame Seen(const Observation& observation) const {
    SeenFrame frame{observation.frame, {}, observation.latency};
    if (const auto* hunt = std::get_if<HuntObservation>(&observation.seen)) {
      frame.seen = SeenHunt{*hunt, model};
    } else if (const auto* follow = std::get_if<FollowObservation>(&observation.seen)) {
      frame.seen = *follow;
    } else {
      frame.seen = SeenLanding{std::get<LandingObservation>(observation.seen),
                               pads[observation.frame.camera]};
    }
    return frame;
  }
};

using Box = std::array<double, 4>;

// Throws InputError for two tasks at once.
std::string TaskName(bool hunt, bool follow) {
  if (hunt && follow) throw InputError("hunt, follow: expected one of them");
  return follow ? "follow" : hunt ? "hunt" : "land";
}

// The settings of a session, as its constructor takes them.
struct Choices {
  py::object source;  // a path, or a Recording
  py::object camera;
  std::string task;    // "land", "hunt" or "follow"
  py::object options;  // nothing, a dict or a path
  std::vector<py::function> sinks;
  py::object on_event;  // a function, or nothing
  std::optional<double> altitude_m;
  bool is_live = false;
  std::shared_ptr<ObjectModel> model;
  std::string output;
  std::string record;
  bool replace = false;
  std::string autopilot;
  bool guides = false;
  std::optional<FollowMark> mark = {};
};

// Calls functions of Python with the frames and events of a session over a recording.
class CallingSink : public ObservationSink {
 public:
  CallingSink(const Choices* choices, Views views) : choices_(*choices), views_(std::move(views)) {}

  void Take(const Observation& observation) override {
    if (choices_.sinks.empty()) return;
    const py::gil_scoped_acquire acquire;
    const py::object seen = py::cast(views_.Seen(observation));
    for (const py::function& sink : choices_.sinks) sink(seen);
  }
  void Take(const SessionEvent& event) override {
    const py::gil_scoped_acquire acquire;
    if (!choices_.on_event.is_none()) choices_.on_event(event.text);
  }

 private:
  const Choices& choices_;
  Views views_;
};

// The first error of a function of Python. A flight goes on without that function.
class FirstError {
 public:
  template <class Action>
  void Catch(const Action& action) {
    if (has_failed()) return;
    try {
      action();
    } catch (const std::exception& error) {
      fmt::print(stderr, "kestrel: a sink has failed, the session goes on without it: {}\n",
                 error.what());
      const std::lock_guard lock(mutex_);
      error_ = std::current_exception();
    }
  }
  void Rethrow() const {
    if (error_) std::rethrow_exception(error_);
  }

 private:
  bool has_failed() const {
    const std::lock_guard lock(mutex_);
    return error_ != nullptr;
  }

  mutable std::mutex mutex_;
  std::exception_ptr error_;
};

// Calls them in a flight, which does not wait: with a thread of its own.
class CallingWriter : public SinkWriter {
 public:
  CallingWriter(std::unique_ptr<CallingSink> sink, FirstError* error)
      : sink_(std::move(sink)), error_(error) {}

  void Write(const Observation& observation, std::size_t /*waiting*/) override {
    Pass(observation);
  }
  void Write(const SessionEvent& event) override { Pass(event); }

 private:
  void Pass(const auto& value) {
    error_->Catch([&] { sink_->Take(value); });
  }

  std::unique_ptr<CallingSink> sink_;
  FirstError* error_;
};

// Throws what Ctrl-C has raised. For the thread that has called the session.
void CheckSignals() {
  const py::gil_scoped_acquire acquire;
  if (PyErr_CheckSignals() != 0) throw py::error_already_set();
}

// Returns the groups of 'options' that a session over a recording reads, too.
TaskOptions VisionOptions(const py::object& options) {
  py::object vision = options;
  if (py::isinstance<py::dict>(options)) {
    vision = options.attr("copy")();
    vision.attr("pop")("fly", py::none());
  }
  const auto values = OptionsOf<TaskOptions>(vision, {}, [](const auto& file) { return file; });
  RequireValid(values.landing);
  RequireValid(values.hunt);
  RequireValid(values.follow);
  return values;
}

// Returns the options of a flight, by all names of `kestrel config`.
KestrelOptions FlightOptionsOf(const py::object& options) {
  const auto path = PathOf(options);
  const bool is_dict = !path && !options.is_none();
  return ReadKestrelOptions(path.value_or(""),
                            is_dict ? Settings(options) : std::vector<std::string>());
}

// Throws InputError for choices of a flight without live=True, and for a simulated camera without
// an autopilot, which says where it is.
void RequireConsistent(const Choices& choices) {
  const auto uri = PathOf(choices.source);
  const bool is_simulated = uri && SimulatedSource::IsNamed(*uri);
  if (is_simulated && !choices.is_live) throw InputError(*uri + ": expected live=True, too");
  if (is_simulated && choices.autopilot.empty()) {
    throw InputError(*uri + ": expected an autopilot, as autopilot='sim:ardupilot' or 'sim:px4'");
  }
  if (!choices.is_live &&
      (!choices.autopilot.empty() || !choices.record.empty() || choices.guides)) {
    throw InputError("autopilot, guide and record: expected live=True, too");
  }
}

// A source, the vision and the sinks, run once or again.
class Session {
 public:
  explicit Session(Choices choices) : choices_(std::move(choices)) {
    RequireConsistent(choices_);
    if (choices_.is_live) {
      flight_ = FlightOptionsOf(choices_.options);
      options_ = flight_;
    } else {
      options_ = VisionOptions(choices_.options);
    }
    WarnOf(options_.landing.target);
    if (!choices_.model) choices_.model = std::make_shared<ObjectModel>(DefaultObjectModel());
    task_ = MakeTask(choices_.task, options_, {.model = *choices_.model, .mark = choices_.mark});
  }
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  std::string Run() {
    is_stopped_ = false;
    return choices_.is_live ? RunLive() : RunRecorded();
  }
  void Stop() { is_stopped_ = true; }

  std::string InWords() const {
    return fmt::format("<Session over {}: {}{}>", std::string(py::repr(choices_.source)),
                       choices_.task, choices_.is_live ? ", live" : "");
  }

 private:
  OpenedSource Open() const {
    if (py::isinstance<Recording>(choices_.source)) {
      OpenedSource opened = choices_.source.cast<const Recording&>().open();
      opened.source->set_format(task_->format());
      return opened;
    }
    RecordingChoice choice = ChoiceOf(choices_.source, choices_.camera, task_->format());
    choice.all_cameras = task_->takes_several_cameras();
    return OpenWithWarnings(choice);
  }

  std::string RunRecorded() {
    const OpenedSource opened = Open();
    const py::gil_scoped_release release;
    const auto session = MakeSession(opened, *task_, WithChoices({}));
    session->sinks().Add(SinkFor(opened.calibration, opened.further));
    session->Run([this] {
      CheckSignals();
      return is_stopped_.load();
    });
    std::string text = session->Summary();
    if (const auto warning = session->vision().Warning(); !warning.empty()) text += warning + "\n";
    return text;
  }

  std::string RunLive() {
    const RecordingChoice recording = ChoiceOf(choices_.source, choices_.camera, task_->format());
    const py::gil_scoped_release release;
    FlySource source(flight_,
                     [this] { return OpenRos2Node(DdsDomain(std::nullopt), flight_.dds); });
    source.Open(recording, /*is_looped=*/false);
    const FlyAutopilot autopilot =
        MakeFlyAutopilot(choices_.autopilot, flight_.fly, choices_.guides, &source);
    FirstError sink_error;
    const auto session =
        MakeSession(source.live, *task_,
                    WithChoices(SessionOptionsFor(autopilot, flight_.fly, choices_.guides)));
    session->sinks().Add(std::make_unique<AsynchronousSink>(
        AsynchronousSinkOptions{.thread_name = "python"},
        std::make_unique<CallingWriter>(SinkFor(source.live.calibration, source.live.further),
                                        &sink_error)));
    if (autopilot.simulated) autopilot.simulated->Start();
    std::exception_ptr interruption;
    const FlightEnd end = session->Run([&] {
      try {
        CheckSignals();
      } catch (const py::error_already_set&) {
        interruption = std::current_exception();
      }
      return is_stopped_ || interruption;
    });
    if (autopilot.simulated) autopilot.simulated->Stop();
    if (interruption) std::rethrow_exception(interruption);
    sink_error.Rethrow();
    std::string text = kestrel::InWords(end) + "\n" + session->Summary();
    if (autopilot.simulated) text += kestrel::InWords(autopilot.simulated->result());
    return text;
  }

  SessionOptions WithChoices(SessionOptions options) const {
    options.altitude_m = choices_.altitude_m;
    options.output = choices_.output;
    options.replace = choices_.replace;
    options.record = choices_.record;
    return options;
  }

  // Returns a sink that calls the functions of Python.
  std::unique_ptr<CallingSink> SinkFor(const CameraCalibration& calibration,
                                       const std::vector<CameraCalibration>& further) const {
    const LandingPipelineOptions& landing = options_.landing;
    const TargetShape shape = ShapeOfTarget(landing.target, landing.detector);
    const auto view_of = [&](const CameraCalibration& camera) {
      return std::make_shared<PadView>(PadView{CameraModel(camera.intrinsics), shape});
    };
    Views views{{view_of(calibration)}, choices_.model};
    for (const CameraCalibration& camera : further) views.pads.push_back(view_of(camera));
    return std::make_unique<CallingSink>(&choices_, std::move(views));
  }

  Choices choices_;
  TaskOptions options_;
  std::shared_ptr<const Task> task_;
  KestrelOptions flight_;  // for live sessions
  std::atomic<bool> is_stopped_{false};
};

void BindSeenFrame(py::module_& module) {
  ValueClass<SeenFrame>(module, "Observation", "A frame and what was seen in it.")
      .Field("frame", &SeenFrame::frame, "Frame.")
      .Field("seen", &SeenFrame::seen, "LandingObservation, HuntObservation or FollowObservation.")
      .Field("latency_s", &SeenFrame::latency,
             "Time from the capture until it was processed, s; None for recordings.")
      .Derived(
          "csv_header",
          [](const SeenFrame& self) {
            if (std::holds_alternative<FollowObservation>(self.seen)) return FollowCsvHeader();
            return std::holds_alternative<SeenHunt>(self.seen) ? ObjectCsvHeader()
                                                               : LandingCsvHeader();
          },
          "First line of object_detections.csv, landing_detections.csv or follow_track.csv.")
      .Derived(
          "csv_rows",
          [](const SeenFrame& self) {
            if (const auto* follow = std::get_if<FollowObservation>(&self.seen)) {
              return follow->region ? FollowCsvRow(self.frame.name, *follow) : "";
            }
            const auto* hunt = std::get_if<SeenHunt>(&self.seen);
            return hunt ? ObjectCsvRows(self.frame.name, *hunt, *hunt->model)
                        : LandingCsvRow(self.frame, std::get<SeenLanding>(self.seen), false);
          },
          "Its lines of that table.");
}

}  // namespace

void BindSession(py::module_& module) {
  BindSeenFrame(module);
  py::class_<Session>(
      module, "Session",
      "A source, the vision, and functions that get the results: what `kestrel land`, `kestrel "
      "hunt`, `kestrel follow` and, live, `kestrel fly` run.")
      .def(
          py::init([](const py::object& source, const py::object& camera,
                      std::vector<py::function> sinks, bool hunt, const py::object& options,
                      std::optional<double> altitude_m, const std::shared_ptr<ObjectModel>& model,
                      const std::string& output, bool replace, bool live,
                      const std::string& autopilot, bool guide, const std::string& record,
                      const py::object& on_event, const std::optional<Box>& follow,
                      const std::string& follow_at) {
            Choices choices{source,
                            camera,
                            TaskName(hunt, follow.has_value()),
                            options,
                            std::move(sinks),
                            on_event,
                            altitude_m,
                            live,
                            model,
                            output,
                            record,
                            replace,
                            autopilot,
                            guide};
            if (follow) {
              const auto& [x, y, width, height] = *follow;
              choices.mark = {cv::Rect2d(x, y, width, height), follow_at};
            }
            return std::make_unique<Session>(std::move(choices));
          }),
          py::arg("source"), py::arg("camera") = py::none(), py::arg("sinks") = py::list(),
          py::kw_only(), py::arg("hunt") = false, py::arg("options") = py::none(),
          py::arg("altitude_m") = py::none(), py::arg("model") = py::none(), py::arg("output") = "",
          py::arg("replace") = false, py::arg("live") = false, py::arg("autopilot") = "",
          py::arg("guide") = false, py::arg("record") = "", py::arg("on_event") = py::none(),
          py::arg("follow") = py::none(), py::arg("follow_at") = "0",
          "source: a path (recording, bag, video, images), a Recording or SimulatedFlight; with "
          "live=True also '/dev/video0', 'rtsp://...', a GStreamer pipeline, "
          "'dds:/camera/image_raw' of ROS 2 or 'sim:standing', a simulated flight.\ncamera: path "
          "of "
          "the calibration; None: the source's own.\nsinks: functions that get each "
          "Observation.\nhunt: looks for coloured objects ('model') instead of a pad.\noptions: a "
          "dict by the names of `kestrel config`, as {'landing': {'target': {'kind': 'helipad'}}}, "
          "or the path of such a file.\naltitude_m: height of the camera above what it looks for, "
          "where there are no poses.\noutput: folder of the tables, as the commands write them; "
          "replace: those that are there.\nlive: in real time, as it is flown; a sink that is slow "
          "misses frames.\nautopilot, guide, record: of live sessions, as of `kestrel fly`, also "
          "autopilot='sim:ardupilot' or 'sim:px4', a simulated one.\non_event: gets each message, "
          "as a warning, as a text.\nfollow: box (x, y, width, height, px) around what is to be "
          "followed in a recording, in the frame 'follow_at', its number or name.")
      .def("run", &Session::Run,
           "Runs to the end of the source, until stop() or Ctrl-C. Returns a summary in words. "
           "Raises InputError when the source fails, and what a sink raises: at once over a "
           "recording, after its end in a flight, which goes on without the sink.")
      .def("stop", &Session::Stop, "Ends the run after the present frame. Any thread may call it.")
      .def("__repr__", [](const Session& self) { return self.InWords(); });
}

}  // namespace kestrel::python
