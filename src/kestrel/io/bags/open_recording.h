// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "kestrel/core/base/time.h"
#include "kestrel/core/camera/calibration.h"
#include "kestrel/io/bags/bag_choice.h"
#include "kestrel/io/recording/frame_source.h"

namespace kestrel {

// A recording to be read, and how.
struct RecordingChoice {
  std::vector<std::string> sources;  // as OpenSourceOrBag takes them
  PixelFormat format = PixelFormat::kGray;
  // All cameras of a recording that have a calibration; else its first.
  bool all_cameras = false;
  BagChoice bag = {};
  // File with the calibration; empty: the source's own. Of several cameras, as Kalibr's chain.
  std::string camera = {};
  std::optional<Duration> clock_offset = {};  // in place of the calibration's
  // The lens where there is no calibration: of this field of view (degrees); or any, for results
  // that are only in the image.
  std::optional<double> fov_deg = {};
  bool may_assume_lens = false;
};

// A recording and the calibration of its camera.
struct OpenedSource {
  std::unique_ptr<FrameSource> source;
  CameraCalibration calibration;
  // Those of the further cameras: of frames with the indices 1, 2, ... All have their names then.
  std::vector<CameraCalibration> further = {};
  // Nothing is known of the lens: what is found has a place in the image, but none before the
  // camera.
  bool is_lens_unknown = false;

  // The image whose size an assumed lens has; empty where there is a calibration.
  std::string first_image = {};

  // Throws ImageSizeError when the image does not have the size of the calibration, or of the first
  // image.
  void RequireSize(const Frame& frame) const;
  // True when frames can be placed in the world, by poses and the camera's mount.
  bool has_world() const { return calibration.body_from_camera && !source->poses().empty(); }
};

// Opens a recording without looking for its calibration. Reports to 'bag.notify' the first images
// that cannot be read, unless the source's set_on_broken is changed. Throws InputError as
// OpenSourceOrBag does.
std::unique_ptr<FrameSource> OpenFrames(const RecordingChoice& choice);

// Returns the poses of the UAV in a recording. Throws InputError when there are none. 'name': of
// the recording, for the error.
std::vector<PoseSample> RequirePoses(const FrameSource& source, const std::string& name);

// Opens a recording with the calibration of the file, its own, or an assumed one. A calibration
// without a mount gets the source's, and its clock offset. Reports to 'bag.notify' which lens is
// assumed, and when there are poses but no mount. Throws InputError when there is no calibration,
// or when source or calibration are not valid.
OpenedSource OpenRecording(const RecordingChoice& choice);

}  // namespace kestrel
