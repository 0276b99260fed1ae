// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/evaluation/land_result.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <limits>
#include <system_error>
#include <utility>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "kestrel/core/base/error.h"
#include "kestrel/core/base/read_file.h"
#include "kestrel/core/geometry/angles.h"
#include "kestrel/io/recording/tables/csv_table.h"
#include "kestrel/io/recording/tables/landing_csv.h"

namespace kestrel {
namespace {

namespace fs = std::filesystem;

// Returns the value whose name is in the cell.
template <class Kinds>
auto KindIn(const CsvTable& table, std::size_t row, std::size_t column, const Kinds& kinds) {
  for (const auto kind : kinds) {
    if (table.Text(row, column) == ToString(kind)) return kind;
  }
  table.Fail(row, fmt::format("'{}' is none that `kestrel land` writes", table.Text(row, column)));
}

TargetDetection DetectionOf(const DetectionRow::Pattern& pattern,
                            const std::optional<RigidTransform>& world_from_camera) {
  TargetDetection detection{};
  detection.center_px = pattern.center_px;
  // The pattern is level and has the yaw of the table, or none if the table has none.
  detection.camera_from_target = {
      Eigen::Quaterniond(Eigen::AngleAxisd(kPi, Eigen::Vector3d::UnitX())),
      pattern.center_in_camera};
  if (world_from_camera && pattern.yaw_in_world) {
    detection.camera_from_target.rotation =
        world_from_camera->rotation.conjugate() *
        Eigen::AngleAxisd(*pattern.yaw_in_world, Eigen::Vector3d::UnitZ());
  }
  detection.covariance.setZero();
  detection.covariance.diagonal().head<3>() = pattern.sigma_in_camera.cwiseAbs2();
  return detection;
}

TargetEstimate TargetOf(const TrackRow& row) {
  TargetEstimate target{row.time, {}};
  target.motion.mean.head<3>() = row.position_in_world;
  target.motion.mean.segment<3>(TurnState::kVelocity) = row.velocity_in_world;
  target.motion.covariance.diagonal().head<3>().setConstant(std::pow(row.position_sigma_m, 2));
  target.motion.covariance.diagonal().segment<3>(3).setConstant(
      std::pow(row.velocity_sigma_mps, 2));
  return target;
}

}  // namespace

LandResult::LandResult(const std::string& table) : file_(table), text_(ReadFile(table)) {
  const CsvTable cells(text_, file_);
  const std::size_t method = cells.Column("method"), quality = cells.Column("quality"),
                    rejected = cells.Column("rejected_at"), time = cells.Column("detect_ms");
  // Not in older tables.
  const std::optional<std::size_t> misfit = cells.FindColumn("misfit_px"),
                                   id = cells.FindColumn("target_id");
  std::size_t next = 0;
  for (DetectionRow& detection : ParseDetectionRows(text_, file_)) {
    const std::size_t index = next++;
    if (!detection.pattern && cells.Text(index, rejected) == kUnreadable) continue;
    Row& row = rows_.emplace_back();
    row.detect_time = DurationFromSeconds(1e-3 * cells.OptionalNumber(index, time).value_or(0));
    if (misfit) row.misfit_px = cells.OptionalNumber(index, *misfit).value_or(0);
    if (detection.pattern) {
      row.method = KindIn(cells, index, method, kDetectionMethods);
      row.quality = cells.Number(index, quality);
      if (id && !cells.IsEmpty(index, *id)) {
        row.id = static_cast<std::int32_t>(cells.Integer(index, *id));
      }
    } else {
      row.reached =
          KindIn(cells, index, rejected,
                 std::array{LandingStage::kBinarize, LandingStage::kAreas, LandingStage::kRing,
                            LandingStage::kCross, LandingStage::kMatch, LandingStage::kLocate});
    }
    row.detection = std::move(detection);
  }
  const fs::path track = fs::path(table).parent_path() / "landing_track.csv";
  std::error_code ignored;
  if (fs::exists(track, ignored)) track_ = ParseTrackRows(ReadFile(track.string()), track.string());
}

LandingObservation LandResult::Next(Time time,
                                    const std::optional<RigidTransform>& world_from_camera) {
  if (next_ == rows_.size() || rows_[next_].detection.time != time) {
    throw InputError(
        fmt::format("{}: row {} is not of the recording's frame at {} ns, expected the result of "
                    "this recording",
                    file_, next_ + 1, ToNanoseconds(time)));
  }
  const Row& row = rows_[next_++];
  LandingObservation observation;
  observation.time = time;
  observation.world_from_camera = world_from_camera;
  observation.detect_time = row.detect_time;
  observation.report.reached = row.reached;
  if (const auto& pattern = row.detection.pattern) {
    TargetDetection& detection =
        observation.report.detection.emplace(DetectionOf(*pattern, world_from_camera));
    detection.method = row.method;
    detection.quality = row.quality;
    detection.diagnostics.misfit_px = row.misfit_px;
    detection.id = row.id;
    // The table does not have the bound of the misfit.
    detection.diagnostics.misfit_bound_px = std::numeric_limits<double>::infinity();
    observation.center_in_world = pattern->center_in_world;
    observation.yaw_in_world = pattern->yaw_in_world;
  } else {
    observation.report.reason = "why is not in the table";
  }
  AddTrack(&observation);
  return observation;
}

void LandResult::AddTrack(LandingObservation* observation) {
  while (next_track_ < track_.size() && track_[next_track_].time < observation->time) ++next_track_;
  if (next_track_ == track_.size() || track_[next_track_].time != observation->time) return;
  const TrackRow& row = track_[next_track_];
  for (const TrackState state : {TrackState::kSearching, TrackState::kTracking,
                                 TrackState::kPredicting, TrackState::kLost}) {
    if (row.state == ToString(state)) observation->track_state = state;
  }
  observation->target = TargetOf(row);
}

void LandResult::RequireEnd() const {
  if (next_ == rows_.size()) return;
  throw InputError(
      fmt::format("{}: has {} rows, but the recording {} frames", file_, rows_.size(), next_));
}

std::string LandResult::Found() const {
  const auto found = std::count_if(
      rows_.begin(), rows_.end(), [](const Row& row) { return row.detection.pattern.has_value(); });
  return fmt::format("pattern found in {}", found);
}

}  // namespace kestrel
