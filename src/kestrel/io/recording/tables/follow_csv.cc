// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/io/recording/tables/follow_csv.h"

#include <optional>

#include <fmt/format.h>

#include "kestrel/io/recording/tables/csv_table.h"
#include "kestrel/io/recording/tables/landing_csv.h"
#include "kestrel/io/recording/tables/track_csv.h"

namespace kestrel {
namespace {

std::string RegionCells(const std::optional<RegionReport>& region) {
  if (!region) return ",,,,,";
  const cv::Rect2d& box = region->box_px;
  return fmt::format("{},{:.2f},{:.2f},{:.2f},{:.2f},{:.3f}", ToString(region->state), box.x, box.y,
                     box.width, box.height, region->probability);
}

std::string PlaceCells(const std::optional<PlaceOnGround>& place) {
  if (!place) return ",,,,,";
  return VectorCells(place->position) + "," + VectorCells(place->covariance.diagonal().cwiseSqrt());
}

}  // namespace

std::string FollowCsvHeader() {
  return fmt::format(
      "frame,timestamp_ns,state,x_px,y_px,width_px,height_px,probability,bearing_x,bearing_y,"
      "bearing_z,p_WP_W_x_m,p_WP_W_y_m,p_WP_W_z_m,sigma_x_m,sigma_y_m,sigma_z_m,track_state,{},"
      "detect_ms\n",
      kTargetColumns);
}

std::string FollowCsvRow(const std::string& frame_name, const FollowObservation& observation) {
  return fmt::format("{},{},{},{},{},{},{},{:.4f}\n", CsvCell(frame_name),
                     ToNanoseconds(observation.time), RegionCells(observation.region),
                     observation.bearing ? VectorCells(*observation.bearing) : ",,",
                     PlaceCells(observation.place), ToString(observation.track_state),
                     TargetCells(observation.target), 1e3 * ToSeconds(observation.detect_time));
}

std::string UnreadableFollowCsvRow(const std::string& frame_name, Time time) {
  return fmt::format("{},{},{}{:,>26}\n", CsvCell(frame_name), ToNanoseconds(time), kUnreadable,
                     "");
}

}  // namespace kestrel
