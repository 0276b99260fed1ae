// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/evaluation/landing_results.h"

#include "kestrel/io/recording/tables/csv_columns.h"

namespace kestrel {
namespace {

class DetectionColumns {
 public:
  explicit DetectionColumns(const CsvTable& table)
      : table_(&table),
        detected_(table.Column("detected")),
        u_(table.Column("u_px")),
        v_(table.Column("v_px")),
        in_camera_(table, "p_CP_C_", "_m"),
        in_world_(table, "p_WP_W_", "_m"),
        sigma_(table, "sigma_", "_m"),
        yaw_(table.Column("yaw_WP_rad")),
        id_(table.FindColumn("target_id")) {}

  std::optional<DetectionRow::Pattern> Parse(std::size_t row) const {
    if (table_->Integer(row, detected_) == 0) return std::nullopt;
    DetectionRow::Pattern pattern;
    pattern.center_px = {table_->Number(row, u_), table_->Number(row, v_)};
    pattern.center_in_camera = in_camera_.Parse(row);
    pattern.sigma_in_camera = sigma_.Parse(row);
    if (!(pattern.sigma_in_camera.minCoeff() > 0)) {
      table_->Fail(row, "a sigma is not positive, expected standard deviations");
    }
    if (!in_world_.IsEmpty(row)) pattern.center_in_world = in_world_.Parse(row);
    pattern.yaw_in_world = table_->OptionalNumber(row, yaw_);
    pattern.has_id = id_ && table_->OptionalNumber(row, *id_).has_value();
    return pattern;
  }

 private:
  const CsvTable* table_;
  std::size_t detected_, u_, v_;
  VectorColumns in_camera_, in_world_, sigma_;
  std::size_t yaw_;
  std::optional<std::size_t> id_;  // not in outputs of older versions
};

}  // namespace

std::vector<DetectionRow> ParseDetectionRows(std::string_view text, const std::string& file) {
  const CsvTable table(text, file);
  const std::vector<Time> times = ParseTimes(table, "timestamp_ns");
  const DetectionColumns columns(table);
  std::vector<DetectionRow> rows;
  for (std::size_t row = 0; row < table.row_count(); ++row) {
    rows.push_back({times[row], columns.Parse(row)});
  }
  return rows;
}

std::vector<TrackRow> ParseTrackRows(std::string_view text, const std::string& file) {
  const CsvTable table(text, file);
  const std::vector<Time> times = ParseTimes(table, "timestamp_ns", TimeOrder::kNotDecreasing);
  const std::size_t state = table.Column("state");
  const VectorColumns position(table, "p_", "_m");
  const VectorColumns velocity(table, "v_", "_mps");
  const std::size_t position_sigma = table.Column("sigma_p_m");
  const std::size_t velocity_sigma = table.Column("sigma_v_mps");
  std::vector<TrackRow> rows;
  for (std::size_t row = 0; row < table.row_count(); ++row) {
    if (position.IsEmpty(row)) continue;
    rows.push_back({times[row], std::string(table.Text(row, state)), position.Parse(row),
                    velocity.Parse(row), table.Number(row, position_sigma),
                    table.Number(row, velocity_sigma)});
  }
  return rows;
}

std::vector<PredictionRow> ParsePredictionRows(std::string_view text, const std::string& file) {
  const CsvTable table(text, file);
  const std::vector<Time> times = ParseTimes(table, "timestamp_ns", TimeOrder::kNotDecreasing);
  const std::size_t horizon = table.Column("horizon_s");
  const VectorColumns position(table, "p_", "_m");
  std::vector<PredictionRow> rows;
  for (std::size_t row = 0; row < table.row_count(); ++row) {
    const double horizon_s = table.Number(row, horizon);
    if (horizon_s < 0 || horizon_s > 1e6) table.Fail(row, "horizon_s is out of range");
    rows.push_back({times[row], DurationFromSeconds(horizon_s), position.Parse(row)});
  }
  return rows;
}

}  // namespace kestrel
