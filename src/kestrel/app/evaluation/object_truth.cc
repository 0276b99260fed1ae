// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/evaluation/object_truth.h"

#include <chrono>
#include <filesystem>

#include <fmt/format.h>

#include "kestrel/core/base/read_file.h"
#include "kestrel/io/recording/tables/csv_columns.h"

namespace kestrel {

TrueObjects ParseTrueObjects(std::string_view text, const std::string& file) {
  const CsvTable table(text, file);
  const std::size_t id = table.Column("id []");
  const std::size_t class_name = table.Column("class []");
  const std::size_t diameter = table.Column("diameter [m]");
  const std::size_t shape = table.Column("shape []");
  TrueObjects objects;
  for (std::size_t row = 0; row < table.row_count(); ++row) {
    const TrueObject object{std::string(table.Text(row, class_name)),
                            table.Number(row, diameter),
                            std::string(table.Text(row, shape)),
                            {}};
    if (!(object.diameter_m > 0)) table.Fail(row, "diameter [m] is not positive");
    if (!objects.emplace(table.Integer(row, id), object).second) {
      table.Fail(row, fmt::format("id {} is there twice", table.Integer(row, id)));
    }
  }
  return objects;
}

void ParseTrueDigits(std::string_view text, const std::string& file, TrueObjects* objects) {
  const CsvTable table(text, file);
  const std::size_t id = table.Column("id []");
  const std::size_t digit = table.Column("digit []");
  for (std::size_t row = 0; row < table.row_count(); ++row) {
    const auto object = objects->find(static_cast<int>(table.Integer(row, id)));
    if (object == objects->end()) {
      table.Fail(row, fmt::format("id {}, expected one of objects.csv", table.Integer(row, id)));
    }
    object->second.digit = static_cast<int>(table.Integer(row, digit));
  }
}

std::vector<TrueSighting> ParseTrueSightings(std::string_view text, const std::string& file,
                                             const TrueObjects& objects) {
  const CsvTable table(text, file);
  const std::vector<Time> times = ParseTimes(table, "timestamp [ns]", TimeOrder::kNotDecreasing);
  const std::size_t id = table.Column("id []");
  const VectorColumns position(table, "p_WO_W_", " [m]");
  const VectorColumns velocity(table, "v_WO_W_", " [m s^-1]");
  const std::size_t u = table.Column("u [px]");
  const std::size_t v = table.Column("v [px]");
  const std::size_t visible = table.Column("visible_fraction []");
  std::vector<TrueSighting> sightings;
  for (std::size_t row = 0; row < table.row_count(); ++row) {
    sightings.push_back({times[row],
                         static_cast<int>(table.Integer(row, id)),
                         position.Parse(row),
                         velocity.Parse(row),
                         {table.Number(row, u), table.Number(row, v)},
                         table.Number(row, visible)});
    if (!objects.contains(sightings.back().id)) {
      table.Fail(row, fmt::format("id {}, expected one of objects.csv", sightings.back().id));
    }
  }
  return sightings;
}

ObjectTruth ReadObjectTruth(const std::string& root) {
  namespace fs = std::filesystem;
  const fs::path folder = fs::path(root) / "objects0";
  const std::string objects = (folder / "objects.csv").string();
  const std::string sightings = (folder / "data.csv").string();
  const std::string digits = (folder / "digits.csv").string();
  ObjectTruth truth;
  truth.objects = ParseTrueObjects(ReadFile(objects), objects);
  if (fs::exists(digits)) ParseTrueDigits(ReadFile(digits), digits, &truth.objects);
  truth.sightings = ParseTrueSightings(ReadFile(sightings), sightings, truth.objects);
  return truth;
}

const TrueSighting* NearestSighting(const std::vector<TrueSighting>& sightings, int id, Time time) {
  const TrueSighting* nearest = nullptr;
  for (const TrueSighting& sighting : sightings) {
    if (sighting.id != id) continue;
    if (!nearest ||
        std::chrono::abs(sighting.time - time) < std::chrono::abs(nearest->time - time)) {
      nearest = &sighting;
    }
  }
  return nearest;
}

Eigen::Vector3d PositionAt(const TrueSighting& sighting, Time time) {
  return sighting.position_in_world + ToSeconds(time - sighting.time) * sighting.velocity_in_world;
}

}  // namespace kestrel
