#include "robot/contact/contact.h"

#include <fcl/narrowphase/collision.h>
#include <fcl/narrowphase/distance.h>

#include <algorithm>
#include <limits>

#include "robot/separation/set.h"

namespace rondo::robot {
namespace {

using Object = fcl::CollisionObjectd;

class Scene {
 public:
  Scene(Arena& arena, const expr::Numeric::Point& state) : arena_(arena), numeric_(arena, state) {}

  // False if FCL cannot tell such a shape.
  bool Add(const Shape& shape, std::vector<Object>& objects) {
    if (shape.kind == ShapeKind::kUnion)
      return std::ranges::all_of(shape.parts, [&](const Shape& p) { return Add(p, objects); });
    fcl::Transform3d pose = fcl::Transform3d::Identity();
    for (int i = 0; i < 3; ++i) {
      const auto row = static_cast<size_t>(i);
      for (int j = 0; j < 3; ++j)
        pose.linear()(i, j) = numeric_(shape.frame.rotation[row][static_cast<size_t>(j)]);
      pose.translation()(i) = numeric_(shape.frame.origin[row]);
    }
    std::vector<double> s;
    for (const TermId t : shape.sizes) s.push_back(numeric_(t));
    const auto add = [&](const std::shared_ptr<fcl::CollisionGeometryd>& geometry,
                         const fcl::Vector3d& middle) {
      fcl::Transform3d at = pose;
      at.translation() += pose.linear() * middle;
      objects.emplace_back(geometry, at);
      return true;
    };
    switch (shape.kind) {
      case ShapeKind::kSphere:
        return add(std::make_shared<fcl::Sphered>(s[0]), fcl::Vector3d::Zero());
      case ShapeKind::kCylinder:
        return add(std::make_shared<fcl::Cylinderd>(s[0], s[2] - s[1]), {0, 0, (s[1] + s[2]) / 2});
      case ShapeKind::kCapsule:
        return add(std::make_shared<fcl::Capsuled>(s[0], s[2] - s[1]), {0, 0, (s[1] + s[2]) / 2});
      case ShapeKind::kBox:
        return add(std::make_shared<fcl::Boxd>(s[1] - s[0], s[3] - s[2], s[5] - s[4]),
                   {(s[0] + s[1]) / 2, (s[2] + s[3]) / 2, (s[4] + s[5]) / 2});
      case ShapeKind::kPrism:
        return Prism(shape, s, add);
      case ShapeKind::kHalfSpace: {
        const Face& f = shape.faces[0];
        const fcl::Vector3d n(numeric_(f.normal[0]), numeric_(f.normal[1]), numeric_(f.normal[2]));
        return add(std::make_shared<fcl::Halfspaced>(n, numeric_(f.offset)), fcl::Vector3d::Zero());
      }
      case ShapeKind::kHalfSphere:
      case ShapeKind::kUnion:
      case ShapeKind::kIntersection:
        break;
    }
    return false;
  }

 private:
  template <typename AddGeometry>
  bool Prism(const Shape& shape, const std::vector<double>& s, const AddGeometry& add) {
    const auto corners = Corners(arena_, shape);
    if (!corners) return false;
    const auto n = static_cast<int>(corners->size());
    auto vertices = std::make_shared<std::vector<fcl::Vector3d>>();
    for (const double z : {s[0], s[1]}) {
      for (const auto& c : *corners) vertices->emplace_back(numeric_(c[0]), numeric_(c[1]), z);
    }
    // Bottom, top and sides: the number of corners, then these, counterclockwise from outside.
    auto faces = std::make_shared<std::vector<int>>();
    faces->push_back(n);
    for (int i = n; i-- > 0;) faces->push_back(i);
    faces->push_back(n);
    for (int i = 0; i < n; ++i) faces->push_back(n + i);
    for (int i = 0; i < n; ++i) {
      const int next = (i + 1) % n;
      faces->insert(faces->end(), {4, i, next, n + next, n + i});
    }
    return add(std::make_shared<fcl::Convexd>(vertices, n + 2, faces), fcl::Vector3d::Zero());
  }

  Arena& arena_;
  expr::Numeric numeric_;
};

}  // namespace

std::optional<Contact> FindContact(Arena& arena, const Shape& a, const Shape& b,
                                   const expr::Numeric::Point& state) {
  Scene scene(arena, state);
  std::vector<Object> first, second;
  if (!scene.Add(a, first) || !scene.Add(b, second)) return std::nullopt;
  Contact contact{false, std::numeric_limits<double>::infinity()};
  const auto is_plane = [](const Object& o) { return o.getNodeType() == fcl::GEOM_HALFSPACE; };
  for (const Object& x : first) {
    for (const Object& y : second) {
      fcl::CollisionResultd collision;
      fcl::collide(&x, &y, fcl::CollisionRequestd(), collision);
      if (collision.isCollision()) return Contact{true, 0};
      if (is_plane(x) || is_plane(y)) return std::nullopt;  // FCL has no distances from half-spaces
      fcl::DistanceRequestd request;
      fcl::DistanceResultd result;
      const double distance = fcl::distance(&x, &y, request, result);
      contact.distance = std::min(contact.distance, std::max(distance, 0.0));
    }
  }
  return contact;
}

}  // namespace rondo::robot
