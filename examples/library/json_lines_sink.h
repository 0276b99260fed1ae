// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ostream>
#include <variant>

#include "kestrel/observation_sink.h"

// Writes each frame with a detection of the landing pattern as one line of JSON: name and time of
// the frame, centre of the pattern in the camera frame (m) and, with poses, in the world (m).
class JsonLinesSink : public kestrel::ObservationSink {
 public:
  explicit JsonLinesSink(std::ostream* out) : out_(out) {}

  void Take(const kestrel::Observation& observation) override {
    const auto* seen = std::get_if<kestrel::LandingObservation>(&observation.seen);
    if (seen == nullptr || !seen->report.detection) return;
    *out_ << R"({"frame": ")" << observation.frame.name << R"(", "timestamp_ns": )"
          << kestrel::ToNanoseconds(seen->time);
    Write("center_in_camera", seen->report.detection->camera_from_target.translation);
    if (seen->center_in_world) Write("center_in_world", *seen->center_in_world);
    *out_ << "}\n";
    ++lines_;
  }
  void Finish() override { out_->flush(); }

  int lines() const { return lines_; }

 private:
  void Write(const char* name, const Eigen::Vector3d& p) {
    *out_ << ", \"" << name << "\": [" << p.x() << ", " << p.y() << ", " << p.z() << "]";
  }

  std::ostream* out_;
  int lines_ = 0;
};
