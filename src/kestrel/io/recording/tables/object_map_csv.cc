// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/io/recording/tables/object_map_csv.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "kestrel/io/recording/tables/csv_table.h"

namespace kestrel {
namespace {

constexpr char kHeader[] =
    "id,class,score,p_x_m,p_y_m,p_z_m,v_x_mps,v_y_mps,v_z_mps,sigma_m,detections,first_seen_ns,"
    "last_seen_ns,moving,shape,digit,digit_probability";

// 'seen': the cells first_seen_ns and last_seen_ns.
std::string Row(const MappedObject& object, const ObjectModel& model, const std::string& seen) {
  const auto index = ClassOf(object, model);
  const auto p = object.position();
  const auto v = object.velocity();
  const auto digit = object.digit();
  return fmt::format("{},{},{:g},{:.6f},{:.6f},{:.6f},{:.6f},{:.6f},{:.6f},{:.4f},{},{},{},{},{}",
                     object.id, index ? CsvCell(model.classes[*index].name) : "",
                     ScoreOf(object, model), p.x(), p.y(), p.z(), v.x(), v.y(), v.z(),
                     object.sigma_m(), object.detections, seen, object.moves ? 1 : 0,
                     ToString(object.shape),
                     digit ? fmt::format("{},{:.4f}", digit->digit, digit->probability) : ",");
}

}  // namespace

std::string ObjectMapCsv(const std::vector<MappedObject>& objects, const ObjectModel& model) {
  std::string text = fmt::format("{}\n", kHeader);
  for (const MappedObject& object : objects) {
    const std::string seen =
        fmt::format("{},{}", ToNanoseconds(object.first_seen), ToNanoseconds(object.last_seen));
    text += Row(object, model, seen) + '\n';
  }
  return text;
}

std::string TeamMapCsv(const std::vector<TeamObject>& objects, const ObjectModel& model) {
  std::string text = fmt::format("{},uavs,holder\n", kHeader);
  for (const auto& [object, uavs, holder] : objects) {
    text += fmt::format("{},{},{}\n", Row(object, model, ","), fmt::join(uavs, " "), holder);
  }
  return text;
}

}  // namespace kestrel
