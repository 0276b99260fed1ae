// SPDX-License-Identifier: BSD-3-Clause
// Recordings, images and videos as sources of frames and poses.
#include "recordings.h"

#include <cstddef>
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
#include "kestrel/event_source.h"
#include "kestrel/open_recording.h"
#include "option_values.h"
#include "value_class.h"

namespace kestrel::python {

std::vector<std::string> SourcesOf(const pybind11::object& source) {
  if (const auto path = PathOf(source)) return {*path};
  std::vector<std::string> sources;
  if (pybind11::isinstance<pybind11::sequence>(source)) {
    for (const auto& each : source) {
      const auto path = PathOf(pybind11::reinterpret_borrow<pybind11::object>(each));
      if (!path) break;
      sources.push_back(*path);
    }
  }
  if (sources.empty()) {
    throw pybind11::type_error("source: got " + std::string(pybind11::repr(source)) +
                               ", expected a path or a list of paths");
  }
  return sources;
}

RecordingChoice ChoiceOf(const pybind11::object& source, const pybind11::object& camera,
                         PixelFormat format) {
  RecordingChoice choice{.sources = SourcesOf(source), .format = format};
  if (!camera.is_none()) {
    const auto path = PathOf(camera);
    if (!path) throw pybind11::type_error("camera: expected the path of a calibration, or None");
    choice.camera = *path;
  }
  return choice;
}

OpenedSource OpenWithWarnings(RecordingChoice choice) {
  // The source keeps 'notify' and may call it later, where Python cannot be called.
  const auto reported = std::make_shared<std::vector<std::string>>();
  choice.bag.notify = [reported](const std::string& text) { reported->push_back(text); };
  OpenedSource opened = OpenRecording(choice);
  opened.source->set_on_broken({});
  for (const std::string& text : *reported) Warn(text);
  return opened;
}

namespace {

namespace py = pybind11;

// Turns the images that a source leaves out into Python's warnings, which need the interpreter's
// lock: the source is read without it.
class LeftOutImages {
 public:
  void Follow(FrameSource* source) {
    source->set_on_broken([this](const BrokenImage& broken) {
      const std::lock_guard lock(mutex_);
      faults_.emplace_back(broken.what());
    });
  }
  void Warn() {
    std::vector<std::string> faults;
    {
      const std::lock_guard lock(mutex_);
      faults.swap(faults_);
    }
    for (const std::string& fault : faults) python::Warn("an image is left out: " + fault);
  }

 private:
  std::mutex mutex_;
  std::vector<std::string> faults_;
};

// Frames of a source, one after the other. Threads that share them wait for each other.
class Frames {
 public:
  explicit Frames(std::unique_ptr<FrameSource> source) : source_(std::move(source)) {
    left_out_.Follow(source_.get());
  }

  Frame Next() {
    Frame frame;
    bool has_frame = false;
    {
      const py::gil_scoped_release release;
      const std::lock_guard lock(mutex_);
      has_frame = source_->Next(&frame);
    }
    left_out_.Warn();
    if (has_frame) return frame;
    throw py::stop_iteration();
  }

 private:
  std::mutex mutex_;
  LeftOutImages left_out_;
  std::unique_ptr<FrameSource> source_;
};

// Frames and poses in order of time, in the same way.
class Events {
 public:
  explicit Events(OpenedSource opened)
      : opened_(std::move(opened)),
        events_(opened_.source.get(), opened_.source->poses(),
                opened_.calibration.clock_offset.value_or(Duration::zero())) {
    left_out_.Follow(opened_.source.get());
  }

  std::variant<Frame, PoseSample> Next() {
    Event event;
    {
      const py::gil_scoped_release release;
      const std::lock_guard lock(mutex_);
      event = events_.Next();
    }
    left_out_.Warn();
    if (auto* frame = std::get_if<Frame>(&event)) return std::move(*frame);
    if (auto* pose = std::get_if<PoseSample>(&event)) return *pose;
    throw py::stop_iteration();
  }

 private:
  std::mutex mutex_;
  LeftOutImages left_out_;
  OpenedSource opened_;
  RecordingEvents events_;
};

void BindFrame(py::module_& module) {
  ValueClass<Frame>(module, "Frame", "An image of a source.")
      .Field("name", &Frame::name, "Path of the image, as given or relative to the source.")
      .Field("time_ns", &Frame::time, "Middle of the exposure, int, ns.")
      .Field("camera", &Frame::camera, "Index of the camera, int.")
      .Field(
          "image", [](const Frame& self) { return ArrayOf(self.image); },
          [](const py::handle& value, Frame* self) {
            const bool is_gray = py::cast<py::array>(value).ndim() == 2;
            self->image = (is_gray ? GrayImage(value) : ColorImage(value)).clone();
          },
          "uint8, gray or BGR, not writable; shares the pixels.")
      .Repr([](const Frame& self) {
        return fmt::format("<Frame {}: {} x {} px at {} ns>", self.name, self.image.cols,
                           self.image.rows, ToNanoseconds(self.time));
      });
}

template <class Source>
void BindIterator(py::module_& module, const char* name, const char* doc) {
  py::class_<Source>(module, name, doc)
      .def("__iter__", [](const py::object& self) { return self; })
      .def("__next__", &Source::Next);
}

}  // namespace

void BindRecordings(py::module_& module) {
  BindFrame(module);
  BindIterator<Frames>(module, "FrameIterator", "Iterates over frames.");
  BindIterator<Events>(module, "EventIterator", "Iterates over frames and poses.");
  py::class_<Recording>(module, "Recording", "A recording with the calibration of its camera.")
      .def_property_readonly(
          "calibration", [](const Recording& self) { return self.opened.calibration; },
          "CameraCalibration.")
      .def(
          "poses", [](const Recording& self) { return self.opened.source->poses(); },
          "Returns the poses of the navigation, a list of PoseSample; empty where it has none.")
      .def(
          "events", [](const Recording& self) { return std::make_unique<Events>(self.open()); },
          "Returns an iterator over PoseSample and Frame in order of time: each frame comes after "
          "the poses that it needs.")
      .def("__iter__",
           [](const Recording& self) {
             return std::make_unique<Frames>(std::move(self.open().source));
           })
      .def("__repr__", [](const Recording& self) {
        const auto frames = self.opened.source->frame_count();
        return fmt::format("<Recording {}: {} frames, {} poses>", self.name,
                           frames ? fmt::to_string(*frames) : "some",
                           self.opened.source->poses().size());
      });
  module.def(
      "open_recording",
      [](const py::object& source, const py::object& camera, PixelFormat format) {
        const RecordingChoice choice = ChoiceOf(source, camera, format);
        return Recording{choice.sources.front(), [choice] { return OpenRecording(choice); },
                         OpenWithWarnings(choice)};
      },
      py::arg("source"), py::arg("camera") = py::none(), py::arg("format") = PixelFormat::kGray,
      "Opens a recording (EuRoC), a bag, a video, a folder of images or image files.\n\nsource: a "
      "path, or a list of images.\ncamera: path of the calibration; None: the source's own.\n"
      "format: 'gray' or 'bgr'.\nReturns a Recording. Raises InputError that says what is wrong.");
  module.def(
      "read_images",
      [](const py::object& source, PixelFormat format) {
        return std::make_unique<Frames>(OpenFrames(ChoiceOf(source, py::none(), format)));
      },
      py::arg("source"), py::arg("format") = PixelFormat::kGray,
      "Returns an iterator over the Frames of a source, without a calibration.");
  module.def(
      "read_image",
      [](const py::object& path, PixelFormat format) {
        return ArrayOf(Frames(OpenFrames(ChoiceOf(path, py::none(), format))).Next().image);
      },
      py::arg("path"), py::arg("format") = PixelFormat::kGray,
      "Returns the pixels of an image file, uint8: gray (rows, columns), or BGR with "
      "format='bgr'.");
}

}  // namespace kestrel::python
