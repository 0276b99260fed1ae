// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/onboard/look_pictures.h"

#include <chrono>
#include <utility>

#include <fmt/format.h>

#include "kestrel/core/base/write_file.h"
#include "kestrel/core/codec/image_codec.h"
#include "kestrel/flight/session/asynchronous_sink.h"

namespace kestrel {
namespace {

constexpr Duration kPicturePeriod = std::chrono::milliseconds(500);

class LookWriter : public SinkWriter {
 public:
  LookWriter(std::filesystem::path folder, std::function<void(const std::string&)> notify)
      : folder_(std::move(folder)), notify_(std::move(notify)) {}

  void Write(const FlightReport& report) override {
    is_there_ = report.autopilot && report.autopilot->guidance == GuidancePhase::kAct;
  }

  void Write(const Observation& observation, std::size_t /*waiting*/) override {
    const Frame& frame = observation.frame;
    if (!is_there_ || frame.time < due_) return;
    due_ = frame.time + kPicturePeriod;
    if (count_ == 0) {
      std::filesystem::create_directories(folder_);
      notify_("pictures are kept in " + folder_.string());
    }
    const std::string name = fmt::format("{}.png", ToNanoseconds(frame.time));
    WriteImage((folder_ / name).string(), frame.image);
    places_ += PlaceRow(name, observation);
    WriteFile((folder_ / "places.csv").string(), places_);
    ++count_;
  }

 private:
  static std::string PlaceRow(const std::string& name, const Observation& observation) {
    const auto camera = WorldFromCamera(observation);
    std::string row = fmt::format("{},{}", name, ToNanoseconds(observation.frame.time));
    if (!camera) return row + ",,,,,,,\n";
    const Eigen::Vector3d& place = camera->translation;
    const Eigen::Quaterniond& turn = camera->rotation;
    return row + fmt::format(",{:.4f},{:.4f},{:.4f},{:.6f},{:.6f},{:.6f},{:.6f}\n", place.x(),
                             place.y(), place.z(), turn.w(), turn.x(), turn.y(), turn.z());
  }

  std::filesystem::path folder_;
  std::function<void(const std::string&)> notify_;
  bool is_there_ = false;
  Time due_{};
  int count_ = 0;
  std::string places_ =
      "image,timestamp_ns,p_WC_W_x_m,p_WC_W_y_m,p_WC_W_z_m,q_WC_w,q_WC_x,q_WC_y,q_WC_z\n";
};

}  // namespace

std::unique_ptr<ObservationSink> MakeLookPictures(std::filesystem::path folder,
                                                  std::function<void(const std::string&)> notify) {
  constexpr int kNiceness = 5;
  auto writer = std::make_unique<LookWriter>(std::move(folder), notify);
  return std::make_unique<AsynchronousSink>(
      AsynchronousSinkOptions{
          .thread_name = "pictures", .frames = 2, .niceness = kNiceness, .notify = notify},
      std::move(writer));
}

}  // namespace kestrel
