// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <variant>
#include <vector>

#include <Eigen/Core>

namespace kestrel {

// A shape in a plane: rings, discs, bars and polygons that are added and erased in order. It is
// stored by the signed distance to its edge instead of by pixels, and can be painted at any scale
// with exact edges. Lengths are metres in general; any unit when the whole drawing uses the same.
class Drawing {
 public:
  struct Ring {
    Eigen::Vector2d center;
    double outer_radius;
    double inner_radius = 0;  // 0: a disc
  };
  // A rectangle: 'half_length' to both sides of 'center' along the unit vector 'axis'.
  struct Bar {
    Eigen::Vector2d center;
    Eigen::Vector2d axis;
    double half_length;
    double half_width;
  };
  // The area within closed lines: outlines and holes in them. The last corner of each line is
  // joined to the first.
  struct Polygon {
    std::vector<std::vector<Eigen::Vector2d>> loops;
  };
  using Shape = std::variant<Ring, Bar, Polygon>;

  struct Edge {
    double distance;         // to the edge, negative inside; never larger than the true distance
    Eigen::Vector2d normal;  // unit vector in which the distance increases
  };

  Drawing& Add(const Shape& shape);
  Drawing& Erase(const Shape& shape);

  bool empty() const { return steps_.empty(); }

  // Returns the edge nearest to 'point'; for a point far outside (farther than the size of the
  // drawing) a circle around all of it. An empty drawing has its edge at infinity.
  Edge NearestEdge(const Eigen::Vector2d& point) const;

 private:
  struct Step {
    Step(const Shape& what, bool is_erased) : shape(what), erase(is_erased) {}
    Shape shape;
    bool erase;
  };

  void Bound(const Eigen::Vector2d& center, double radius);

  std::vector<Step> steps_;
  // Circle around everything that was added.
  Eigen::Vector2d bound_center_ = Eigen::Vector2d::Zero();
  double bound_radius_ = -1;
};

// Returns the part of a box of width 'width' that lies inside of a straight edge. The box is around
// a point at 'distance' outside of the edge.
double Coverage(double distance, double width);

}  // namespace kestrel
