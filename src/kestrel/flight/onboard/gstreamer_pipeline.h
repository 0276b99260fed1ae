// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "kestrel/core/base/time.h"
#include "kestrel/io/recording/frame.h"
#include "kestrel/io/recording/gstreamer.h"

namespace kestrel {

// "element.property" of a pipeline that sets the exposure.
class GstExposureProperty {
 public:
  // 'unit_s': of the property. Throws InputError when the pipeline has no such element or property.
  GstExposureProperty(GstElement* pipeline, const std::string& name, double unit_s);

  // What is outside of the property's range goes to its end. By any thread.
  void Set(double exposure_s);

 private:
  GstElementPointer element_;
  GParamSpec* property_ = nullptr;
  double unit_s_;
};

// A pipeline of GStreamer that ends in an appsink, of which the newest frame is to be had, with
// times on the clock of Now(). Faults name 'camera'.
class GstreamerPipeline {
 public:
  // Throws InputError when 'text' is no pipeline with an appsink.
  GstreamerPipeline(const std::string& text, const std::string& camera, PixelFormat format);
  ~GstreamerPipeline();
  GstreamerPipeline(const GstreamerPipeline&) = delete;
  GstreamerPipeline& operator=(const GstreamerPipeline&) = delete;

  // See GstExposureProperty.
  void UseExposureProperty(const std::string& name, double unit_s);

  // Throws InputError when it does not start.
  void Start();

  // The newest frame that was not yet given out; null when none comes within 'timeout'.
  GstSamplePointer Pull(Duration timeout);

  // When the driver had the frame; nothing when the buffer has no time.
  std::optional<Time> DriverTime(GstSample* sample) const;

  // Frames between this one and the last that never came here: by the source's numbers, else by the
  // times.
  std::uint64_t MissedBefore(GstSample* sample);

  // What went wrong, in one line; empty as long as nothing did.
  std::string Fault();
  bool HasEnded() const;
  bool is_live() const { return is_live_; }

  // False without a property for it. By any thread.
  bool SetExposure(double exposure_s);

 private:
  void SetUpSink(PixelFormat format);
  void UseMonotonicClock();

  std::string camera_;
  GstElementPointer pipeline_;
  GstElementPointer sink_;
  GstWatch watch_;
  std::optional<GstExposureProperty> exposure_;
  bool is_live_ = true;
  guint64 last_number_ = GST_BUFFER_OFFSET_NONE;
  GstClockTime last_pts_ = GST_CLOCK_TIME_NONE;
};

}  // namespace kestrel
