// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <thread>
#include <variant>
#include <vector>

#include "kestrel/core/base/bounded_queue.h"
#include "kestrel/core/base/folder_lock.h"
#include "kestrel/core/base/limits.h"
#include "kestrel/core/base/thread_setup.h"
#include "kestrel/core/base/time.h"
#include "kestrel/core/camera/calibration.h"
#include "kestrel/core/codec/jpeg_codec.h"
#include "kestrel/core/poses/pose_history.h"
#include "kestrel/flight/session/flight_report.h"
#include "kestrel/io/recording/euroc/euroc_writer.h"
#include "kestrel/io/recording/euroc/truth_rows.h"
#include "kestrel/io/recording/frame.h"

namespace kestrel {

struct FlightRecorderOptions {
  std::string compression = "png";
  int png_level = 1;
  int jpg_quality = 95;
  int queue_frames = 32;  // that may wait for the disk; further frames are dropped
  double free_space_mb = 200;
  double commit_period_s = 1;  // after which what is written outlives a loss of power

  static void Visit(auto& self, auto&& visit) {
    visit("compression", self.compression, OneOf{{"png", "jpg"}},
          "format of the images; jpg needs a fifth of the size and work, and moves edges by "
          "hundredths of a pixel");
    visit("png_level", self.png_level, Range{0, 9},
          "compression of PNG; 0: none and fast, 9: smallest and slow");
    visit("jpg_quality", self.jpg_quality, Range{1, 100}, "quality of JPEG");
    visit("free_space_mb", self.free_space_mb, AtLeast(0),
          "free space on the disk below which no images are written");
    visit.Gone({"queue_frames", "commit_period_s", "thread"});
  }
};

// Writes a flight as a recording in the EuRoC layout (docs/recording.md) that `kestrel land`,
// `hunt`, `calibrate` and `evaluate` read. It has threads of its own: no caller waits, and data
// that the disk is too slow for are dropped. Every listed image is complete, whatever happens: it
// is written under another name, and listed once it is on the disk.
//
//   mav0/cam0/data.csv, data/*.png, sensor.yaml   images, as they were given out by the camera
//   mav0/cam0/exposure.csv                        timestamp, exposure (s) from that image on
//   mav0/cam0/dropped.csv                         timestamp, reason: images that are not there
//   mav0/cam1/                                    the same of the next camera, without exposures
//   mav0/nav0/data.csv                            poses as the autopilot reported them
//   mav0/gimbal0/data.csv, sensor.yaml            reports of the gimbal on which the camera is
//   mav0/state_groundtruth_estimate0/data.csv     true poses, where a simulation has them
//   mav0/landing_pattern0/data.csv                the pattern's truth, of images that are there
//   mavlink.tlog                                  sent and received packets (us of UTC, bytes)
class FlightRecorder {
 public:
  // Receives messages for the user: the disk is full for images, and writing goes on. Called by a
  // thread of the recorder.
  using Notify = std::function<void(const std::string&)>;

  // Throws InputError when 'folder' has something else in it (or a recording, unless 'replace'),
  // cannot be written or is in use by another writer, or the options are not valid. 'rate_hz': rate
  // of the images. A calibration of width 0 (none is known) is not written.
  // 'further': calibrations of the cameras after the first one, which become cam1, cam2 and so on.
  FlightRecorder(const std::filesystem::path& folder, bool replace,
                 const CameraCalibration& calibration, double rate_hz,
                 const FlightRecorderOptions& options, Notify notify,
                 const std::vector<CameraCalibration>& further = {});
  // Writes all data that it has received.
  ~FlightRecorder();
  FlightRecorder(const FlightRecorder&) = delete;
  FlightRecorder& operator=(const FlightRecorder&) = delete;

  // Any thread may call these; they do not wait, throw or allocate. Each kind must come in order of
  // time: data not later than the last of the same kind are left out. 'truth': the true pattern at
  // the frame's time. Nobody may write into the frame's pixels any more.
  void AddFrame(const Frame& frame, const std::optional<TruePattern>& truth = std::nullopt);
  void AddPose(const PoseSample& pose);
  void AddGimbal(const GimbalSample& report);
  void AddZoom(const ZoomSample& report);
  void AddTruePose(const PoseSample& pose);
  void AddExposure(Time from, double exposure_s);
  // Takes a MAVLink packet as it was on the wire; longer ones than 280 bytes are left out.
  void AddPacket(Time time, std::span<const std::uint8_t> bytes);

  RecorderCounters counters() const;
  const std::filesystem::path& folder() const { return folder_; }
  bool is_recording_images() const { return !are_images_stopped_; }

 private:
  // Kinds of records; those of one kind, and of one camera, must come in order of time.
  enum Kind : std::size_t { kExposures, kPoses, kGimbal, kZoom, kTruePoses, kKindCount };
  struct RecordedImage {
    Frame frame;
    std::optional<TruePattern> truth;
  };
  struct TruePose {
    PoseSample pose;
  };
  struct Exposure {
    Time from;
    double exposure_s;
  };
  struct Dropped {
    Time time;
    const char* reason;
    std::size_t camera;
  };
  struct Packet {
    static constexpr std::size_t kMaxSize = 280;
    Time time;
    std::size_t size;
    std::array<std::uint8_t, kMaxSize> bytes;
  };
  using Record =
      std::variant<PoseSample, GimbalSample, ZoomSample, TruePose, Exposure, Dropped, Packet>;

  void RunWriter();
  void RunCommitter();
  void Report(const std::string& text) const;

  void Write(const RecordedImage& image);
  void Drop(const Frame& frame, const char* reason);
  bool HasRoom();
  void Encode(const cv::Mat& image);
  bool WriteImage(const Frame& frame);
  void StopImages(const std::string& reason);

  void WriteRecords();
  static bool IsNext(Time time, std::optional<Time>* last);
  bool IsNext(Kind kind, Time time) { return IsNext(time, &last_times_[kind]); }
  void WriteRecord(const PoseSample& pose);
  void WriteRecord(const GimbalSample& report);
  void WriteRecord(const ZoomSample& report);
  void WriteRecord(const TruePose& truth);
  void WriteRecord(const Exposure& exposure);
  void WriteRecord(const Dropped& dropped);
  void WriteRecord(const Packet& packet);

  FlightRecorderOptions options_;
  std::filesystem::path folder_;
  FolderLock lock_;
  Notify notify_;
  std::optional<JpegEncoder> jpeg_encoder_;  // for images that are not PNG
  Duration utc_offset_;                      // UTC minus Now()
  std::optional<GimbalMount> gimbal_;        // as the calibration has it
  std::optional<ZoomLens> zoom_;             // as the calibration has it
  EurocWriter writer_;
  BoundedQueue<RecordedImage> images_;
  BoundedQueue<Record> records_;

  // Used by the writer's thread only.
  std::array<std::optional<Time>, kKindCount> last_times_;
  std::vector<std::optional<Time>> last_images_;  // one for each camera
  std::optional<YawFrame> yaw_frame_;             // in which the recorded reports are
  std::string encoded_;
  Time next_attempt_;  // when writing is tried again after a failure

  std::atomic<bool> are_images_stopped_{false};
  std::atomic<std::uint64_t> image_count_{0};
  std::atomic<std::uint64_t> drop_count_{0};
  std::atomic<std::uint64_t> byte_count_{0};
  std::atomic<std::uint64_t> lost_count_{0};

  std::mutex stop_mutex_;
  std::condition_variable stop_;
  bool is_stopping_ = false;
  std::atomic<bool> is_closing_{false};
  std::thread write_thread_;
  std::thread commit_thread_;
};

}  // namespace kestrel
