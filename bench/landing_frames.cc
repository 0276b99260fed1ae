// SPDX-License-Identifier: BSD-3-Clause
#include "landing_frames.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <numbers>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "kestrel/core/base/error.h"
#include "kestrel/core/base/read_file.h"
#include "kestrel/core/camera/calibration_reader.h"
#include "kestrel/core/camera/paper_camera.h"
#include "kestrel/io/recording/euroc/euroc_recording.h"
#include "kestrel/io/recording/media/image_file.h"
#include "kestrel/io/recording/tables/csv_table.h"

namespace kestrel {
namespace {

namespace fs = std::filesystem;
using Eigen::Vector2d;
using Eigen::Vector3d;

// The camera of the sequences has no published calibration; its focal length and principal point
// were measured in its frames.
const CameraIntrinsics kSequenceCamera{.width_px = 640,
                                       .height_px = 360,
                                       .fx_px = 370,
                                       .fy_px = 370,
                                       .cx_px = 319.5,
                                       .cy_px = 179.5,
                                       .distortion = {}};

PatternTruth TruthOfQuality(std::string_view quality) {
  if (quality == "good" || quality == "fair" || quality == "hand") return PatternTruth::kWhole;
  if (quality == "partial") return PatternTruth::kPartial;
  if (quality == "negative") return PatternTruth::kNone;
  return PatternTruth::kUnknown;
}

class AnnotationReader {
 public:
  explicit AnnotationReader(const CsvTable& table) : table_(table) {}

  LandingFrame Read(std::size_t row) const {
    LandingFrame frame;
    frame.name = table_.Text(row, table_.Column("file"));
    frame.group = fs::path(frame.name).parent_path().string();
    if (frame.group.empty()) frame.group = frame.name;
    frame.truth = TruthOfQuality(table_.Text(row, table_.Column("quality")));
    if (frame.truth == PatternTruth::kWhole) {
      frame.center_px = {Number(row, "centre_u"), Number(row, "centre_v")};
    }
    if (frame.truth == PatternTruth::kWhole || frame.truth == PatternTruth::kPartial) {
      frame.outer = Ellipse{{Number(row, "outer_cx"), Number(row, "outer_cy")},
                            Number(row, "outer_semi_major"),
                            Number(row, "outer_semi_minor"),
                            Number(row, "outer_angle_deg") * std::numbers::pi / 180};
      frame.ring_radius_px = frame.outer->semi_major;
    }
    return frame;
  }

 private:
  double Number(std::size_t row, std::string_view column) const {
    return table_.Number(row, table_.Column(column));
  }
  const CsvTable& table_;
};

// Half of the largest width of the ring's image, as if the image had no border.
double RingRadiusPx(const CameraModel& camera, const RigidTransform& camera_from_target,
                    double radius_m) {
  constexpr int kPoints = 64;
  std::vector<Vector2d> pixels;
  for (int i = 0; i < kPoints; ++i) {
    const double angle = 2 * std::numbers::pi * i / kPoints;
    const Vector3d point(radius_m * std::cos(angle), radius_m * std::sin(angle), 0);
    Vector2d pixel;
    if (camera.Project(camera_from_target * point, &pixel) != ProjectionStatus::kOutsideModel) {
      pixels.push_back(pixel);
    }
  }
  double width = 0;
  for (const Vector2d& a : pixels) {
    for (const Vector2d& b : pixels) width = std::max(width, (a - b).norm());
  }
  return 0.5 * width;
}

// Rows of landing_pattern0/data.csv by time.
struct PatternRow {
  RigidTransform world_from_pattern;
  Vector2d center_px;
  double altitude_m;
  double visible_fraction;
};

std::map<std::int64_t, PatternRow> ReadPatternRows(const std::string& file) {
  const std::string text = ReadFile(file);
  const CsvTable table(text, file);
  std::map<std::int64_t, PatternRow> rows;
  for (std::size_t row = 0; row < table.row_count(); ++row) {
    const auto number = [&](const char* column) { return table.Number(row, table.Column(column)); };
    rows[table.Integer(row, table.Column("timestamp [ns]"))] = {
        {Eigen::Quaterniond(number("q_WP_w []"), number("q_WP_x []"), number("q_WP_y []"),
                            number("q_WP_z []"))
             .normalized(),
         {number("p_WP_W_x [m]"), number("p_WP_W_y [m]"), number("p_WP_W_z [m]")}},
        {number("u [px]"), number("v [px]")},
        number("altitude [m]"),
        number("visible_fraction []")};
  }
  return rows;
}

RigidTransform PoseAt(const std::vector<PoseSample>& poses, const Frame& frame) {
  const auto pose = std::find_if(poses.begin(), poses.end(),
                                 [&](const PoseSample& p) { return p.time == frame.time; });
  if (pose == poses.end()) {
    throw InputError(fmt::format("{}: nav0/data.csv has no row at its time", frame.name));
  }
  return pose->world_from_body;
}

const char* GroupOf(const LandingStill& still) {
  if (still.visible_fraction < 1) return kStillGroups[3];
  if (still.has_highlight) return kStillGroups[2];
  return kStillGroups[still.has_shadow ? 1 : 0];
}

LandingFrameSet ReadHardCondition(const fs::path& folder) {
  ImageSequence images = OpenEurocRecording(folder.string());
  const CameraCalibration calibration = ReadCalibration(images.calibration_file());
  if (!calibration.body_from_camera) {
    throw InputError(images.calibration_file() + ": has no mount, expected T_BS");
  }
  const CameraModel camera(calibration.intrinsics);
  const auto rows = ReadPatternRows((folder / "mav0/landing_pattern0/data.csv").string());
  LandingFrameSet set{folder.filename().string(), calibration.intrinsics, {}};
  const std::vector<PoseSample> poses = images.poses();
  for (Frame image; images.Next(&image);) {
    // The navigation of these recordings is exact: it is the truth and the hint.
    const RigidTransform camera_from_world =
        (PoseAt(poses, image) * *calibration.body_from_camera).Inverse();
    LandingFrame frame;
    frame.name = set.name + "/" + fs::path(image.name).filename().string();
    frame.group = set.name;
    frame.image = image.image.clone();
    frame.up_in_camera = camera_from_world.rotation * Vector3d::UnitZ();
    const auto row = rows.find(ToNanoseconds(image.time));
    frame.truth = row == rows.end() ? PatternTruth::kNone : PatternTruth::kWhole;
    if (row != rows.end()) {
      frame.camera_from_target = camera_from_world * row->second.world_from_pattern;
      frame.center_px = row->second.center_px;
      frame.altitude_m = row->second.altitude_m;
      frame.visible_fraction = row->second.visible_fraction;
      frame.ring_radius_px =
          RingRadiusPx(camera, *frame.camera_from_target, LandingPattern().outer_radius_m());
    }
    set.frames.push_back(std::move(frame));
  }
  return set;
}

}  // namespace

std::vector<LandingFrameSet> ReadLandingReal(const std::string& data_dir) {
  const fs::path folder = fs::path(data_dir) / "landing_real";
  std::vector<LandingFrameSet> sets;
  if (!fs::is_directory(folder)) return sets;
  const std::string file = (folder / "annotations.csv").string();
  const std::string text = ReadFile(file);
  const CsvTable table(text, file);
  const AnnotationReader reader(table);
  for (std::size_t row = 0; row < table.row_count(); ++row) {
    LandingFrame frame = reader.Read(row);
    frame.image = ReadGrayImage((folder / frame.name).string());
    if (sets.empty() || sets.back().name != frame.group) {
      const bool fisheye = frame.group == "fisheye_landing.jpg";
      sets.push_back({frame.group, fisheye ? PaperCamera() : kSequenceCamera, {}});
    }
    sets.back().frames.push_back(std::move(frame));
  }
  return sets;
}

std::vector<LandingFrameSet> ReadLandingHard(const std::string& data_dir) {
  const fs::path folder = fs::path(data_dir) / "landing_hard";
  std::vector<LandingFrameSet> sets;
  if (!fs::is_directory(folder)) return sets;
  std::vector<fs::path> conditions;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    if (entry.is_directory()) conditions.push_back(entry.path());
  }
  std::sort(conditions.begin(), conditions.end());
  for (const fs::path& condition : conditions) sets.push_back(ReadHardCondition(condition));
  return sets;
}

LandingFrame FrameFromStill(const LandingStillMaker& maker, const std::string& set,
                            std::uint64_t seed) {
  return FrameFromStill(maker.MakePattern(seed), set, seed);
}

LandingFrame FrameFromLookalikes(const LandingStillMaker& maker, const std::string& group,
                                 std::uint64_t seed) {
  return FrameFromLookalikes(maker.MakeLookalikes(seed), group, seed);
}

LandingFrame FrameFromStill(const LandingStill& still, const std::string& set, std::uint64_t seed) {
  LandingFrame frame;
  frame.name = fmt::format("{} seed {}", set, seed);
  frame.group = GroupOf(still);
  frame.image = still.image;
  frame.truth = PatternTruth::kWhole;
  frame.center_px = still.center_px;
  frame.ring_radius_px = 0.5 * still.ring_major_px;
  frame.camera_from_target = still.camera_from_target;
  frame.up_in_camera = still.up_in_camera;
  frame.altitude_m = still.altitude_m;
  frame.visible_fraction = still.visible_fraction;
  return frame;
}

LandingFrame FrameFromLookalikes(const LookalikeStill& still, const std::string& group,
                                 std::uint64_t seed) {
  LandingFrame frame;
  frame.name = fmt::format("{} seed {}: {}", group, seed, fmt::join(still.names, ", "));
  frame.group = group;
  frame.image = still.image;
  frame.truth = PatternTruth::kNone;
  frame.up_in_camera = still.up_in_camera;
  frame.altitude_m = still.altitude_m;
  return frame;
}

}  // namespace kestrel
