// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/evaluation/hunt_result.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "kestrel/app/evaluation/object_results.h"
#include "kestrel/core/base/error.h"
#include "kestrel/core/base/read_file.h"
#include "kestrel/io/recording/tables/csv_columns.h"
#include "kestrel/io/recording/tables/csv_table.h"

namespace kestrel {
namespace {

// The columns that ParseObjectRows does not read.
class EllipseColumns {
 public:
  explicit EllipseColumns(const CsvTable& cells)
      : cells_(cells),
        u_(cells.Column("u_px")),
        semi_minor_(cells.Column("semi_minor_px")),
        angle_(cells.Column("angle_rad")),
        sigma_(cells.Column("sigma_m")),
        detect_(cells.Column("detect_ms")) {}

  bool IsObject(std::size_t row) const { return !cells_.IsEmpty(row, u_); }
  // An image that could not be read took no time.
  bool IsUnreadable(std::size_t row) const {
    return !IsObject(row) && DetectTime(row) == Duration::zero();
  }
  Duration DetectTime(std::size_t row) const {
    return DurationFromSeconds(1e-3 * cells_.OptionalNumber(row, detect_).value_or(0));
  }
  Ellipse EllipseOf(const ObjectRow& object, std::size_t row) const {
    return {object.center_px, object.semi_major_px, cells_.Number(row, semi_minor_),
            cells_.Number(row, angle_)};
  }
  std::optional<ObjectLocation> Location(const std::optional<Eigen::Vector3d>& position,
                                         std::size_t row) const {
    if (!position) return std::nullopt;
    const double sigma_m = cells_.OptionalNumber(row, sigma_).value_or(0);
    return ObjectLocation{*position, std::pow(sigma_m, 2) * Eigen::Matrix3d::Identity()};
  }

 private:
  const CsvTable& cells_;
  std::size_t u_, semi_minor_, angle_, sigma_, detect_;
};

}  // namespace

HuntResult::HuntResult(const std::string& table) : file_(table), text_(ReadFile(table)) {
  const ObjectRows rows = ParseObjectRows(text_, file_);
  const CsvTable cells(text_, file_);
  const EllipseColumns columns(cells);
  const std::vector<Time> times = ParseTimes(cells, "timestamp_ns", TimeOrder::kNotDecreasing);
  auto object = rows.objects.begin();
  for (std::size_t row = 0; row < times.size(); ++row) {
    if (columns.IsUnreadable(row)) continue;
    if (frames_.empty() || times[row] > frames_.back().time) {
      frames_.emplace_back().time = times[row];
      frames_.back().detect_time = columns.DetectTime(row);
    }
    if (!columns.IsObject(row)) continue;
    ObjectDetection& found = frames_.back().report.detections.emplace_back();
    found.class_index = ClassIndex(object->class_name);
    found.class_probability = object->class_probability;
    found.center_px = object->center_px;
    found.ellipse = columns.EllipseOf(*object, row);
    found.location = columns.Location(object->center_in_camera, row);
    frames_.back().in_world.push_back(columns.Location(object->center_in_world, row));
    ++object;
  }
}

std::size_t HuntResult::ClassIndex(const std::string& name) {
  std::vector<ObjectClass>& classes = model_.classes;
  const auto known = std::find_if(classes.begin(), classes.end(),
                                  [&](const ObjectClass& one) { return one.name == name; });
  const auto index = static_cast<std::size_t>(known - classes.begin());
  if (known == classes.end()) classes.emplace_back().name = name;
  return index;
}

HuntObservation HuntResult::Next(Time time,
                                 const std::optional<RigidTransform>& world_from_camera) {
  if (next_ == frames_.size() || frames_[next_].time != time) {
    throw InputError(fmt::format(
        "{}: has no row of the recording's frame at {} ns, expected the result of this recording",
        file_, ToNanoseconds(time)));
  }
  HuntObservation observation = frames_[next_++];
  observation.world_from_camera = world_from_camera;
  return observation;
}

void HuntResult::RequireEnd() const {
  if (next_ == frames_.size()) return;
  throw InputError(fmt::format("{}: has rows of {} frames, but the recording has {}", file_,
                               frames_.size(), next_));
}

std::string HuntResult::Found() const {
  std::size_t detections = 0;
  for (const HuntObservation& frame : frames_) detections += frame.report.detections.size();
  return fmt::format("{} detections", detections);
}

}  // namespace kestrel
