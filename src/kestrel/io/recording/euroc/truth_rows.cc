// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/io/recording/euroc/truth_rows.h"

#include <fmt/format.h>

#include "kestrel/io/recording/euroc/euroc_text.h"

namespace kestrel {

std::string TrueStateHeader() {
  return EurocPoseColumns("RS") + ",v_RS_R_x [m s^-1],v_RS_R_y [m s^-1],v_RS_R_z [m s^-1]\n";
}

std::string TrueStateRow(Time time, const RigidTransform& world_from_body,
                         const Eigen::Vector3d& velocity) {
  return fmt::format("{},{:.6f},{:.6f},{:.6f}\n", EurocPoseCells(time, world_from_body),
                     velocity.x(), velocity.y(), velocity.z());
}

std::string LandingTruthHeader() {
  return "#timestamp [ns],p_WP_W_x [m],p_WP_W_y [m],p_WP_W_z [m],"
         "q_WP_w [],q_WP_x [],q_WP_y [],q_WP_z [],"
         "v_WP_W_x [m s^-1],v_WP_W_y [m s^-1],v_WP_W_z [m s^-1],"
         "u [px],v [px],altitude [m],visible_fraction []\n";
}

std::string LandingTruthRow(const TruePattern& pattern) {
  const Eigen::Vector3d& v = pattern.velocity_in_world;
  return fmt::format("{},{:.6f},{:.6f},{:.6f},{:.4f},{:.4f},{:.6f},{:.4f}\n",
                     EurocPoseCells(pattern.time, pattern.world_from_pattern), v.x(), v.y(), v.z(),
                     pattern.center_px.x(), pattern.center_px.y(), pattern.altitude_m,
                     pattern.visible_fraction);
}

std::string RegionTruthFile(std::size_t index) { return fmt::format("region{}/data.csv", index); }

std::string RegionTruthHeader() {
  return "#timestamp [ns],x [px],y [px],width [px],height [px],"
         "p_WR_W_x [m],p_WR_W_y [m],p_WR_W_z [m],"
         "v_WR_W_x [m s^-1],v_WR_W_y [m s^-1],v_WR_W_z [m s^-1],visible_fraction []\n";
}

std::string RegionTruthRow(const TrueRegion& region) {
  const Eigen::Vector3d& p = region.place_in_world;
  const Eigen::Vector3d& v = region.velocity_in_world;
  const cv::Rect2d& box = region.box_px;
  return fmt::format(
      "{},{:.2f},{:.2f},{:.2f},{:.2f},{:.6f},{:.6f},{:.6f},{:.6f},{:.6f},{:.6f},{:.4f}\n",
      ToNanoseconds(region.time), box.x, box.y, box.width, box.height, p.x(), p.y(), p.z(), v.x(),
      v.y(), v.z(), region.visible_fraction);
}

}  // namespace kestrel
