#include "robot/contact/solid.h"

#include <fcl/narrowphase/collision.h>
#include <fcl/narrowphase/distance.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "reach/problem/numeric.h"
#include "robot/separation/set.h"
#include "robot/values/value.h"

namespace rondo::robot {
namespace {

using Geometry = std::shared_ptr<fcl::CollisionGeometryd>;

/// Is one convex part: twelve numbers say where its frame is, the others what it is like.
struct Part {
  ShapeKind kind = ShapeKind::kSphere;
  size_t first = 0, count = 0;                   // of its numbers among all
  std::vector<double> made;                      // of which numbers the geometry was made
  fcl::Vector3d middle = fcl::Vector3d::Zero();  // of the geometry, in the frame of the shape
  std::optional<fcl::CollisionObjectd> object;
};

constexpr size_t kFrame = 12;

// A convex solid over corners that go around counterclockwise, from one height to another.
Geometry Prism(std::span<const double> n) {
  const auto corners = static_cast<int>((n.size() - 2) / 2);
  auto vertices = std::make_shared<std::vector<fcl::Vector3d>>();
  for (const double z : {n[0], n[1]}) {
    for (size_t i = 2; i + 1 < n.size(); i += 2) vertices->emplace_back(n[i], n[i + 1], z);
  }
  // Bottom, top and sides: the number of corners, then these, counterclockwise from outside.
  auto faces = std::make_shared<std::vector<int>>();
  faces->push_back(corners);
  for (int i = corners; i-- > 0;) faces->push_back(i);
  faces->push_back(corners);
  for (int i = 0; i < corners; ++i) faces->push_back(corners + i);
  for (int i = 0; i < corners; ++i) {
    const int next = (i + 1) % corners;
    faces->insert(faces->end(), {4, i, next, corners + next, corners + i});
  }
  return std::make_shared<fcl::Convexd>(vertices, corners + 2, faces);
}

Geometry Make(ShapeKind kind, std::span<const double> n, fcl::Vector3d& middle) {
  middle = fcl::Vector3d::Zero();
  switch (kind) {
    case ShapeKind::kSphere:
      return std::make_shared<fcl::Sphered>(n[0]);
    case ShapeKind::kCylinder:
    case ShapeKind::kCapsule:
      middle[2] = (n[1] + n[2]) / 2;
      if (kind == ShapeKind::kCylinder) return std::make_shared<fcl::Cylinderd>(n[0], n[2] - n[1]);
      return std::make_shared<fcl::Capsuled>(n[0], n[2] - n[1]);
    case ShapeKind::kBox:
      middle = {(n[0] + n[1]) / 2, (n[2] + n[3]) / 2, (n[4] + n[5]) / 2};
      return std::make_shared<fcl::Boxd>(n[1] - n[0], n[3] - n[2], n[5] - n[4]);
    case ShapeKind::kPrism:
      return Prism(n);
    case ShapeKind::kHalfSpace:
      return std::make_shared<fcl::Halfspaced>(fcl::Vector3d(n[0], n[1], n[2]), n[3]);
    case ShapeKind::kHalfSphere:
    case ShapeKind::kUnion:
    case ShapeKind::kIntersection:
      break;
  }
  return nullptr;
}

// Collects the convex parts and their numbers as terms; false if there is no such shape.
bool Collect(Arena& arena, const Shape& shape, std::vector<Part>& parts, std::vector<TermId>& numbers) {
  if (shape.kind == ShapeKind::kUnion)
    return std::ranges::all_of(shape.parts,
                               [&](const Shape& p) { return Collect(arena, p, parts, numbers); });
  if (shape.kind == ShapeKind::kHalfSphere || shape.kind == ShapeKind::kIntersection) return false;
  Part part;
  part.kind = shape.kind;
  part.first = numbers.size();
  for (const Vector& row : shape.frame.rotation) numbers.insert(numbers.end(), row.begin(), row.end());
  numbers.insert(numbers.end(), shape.frame.origin.begin(), shape.frame.origin.end());
  numbers.insert(numbers.end(), shape.sizes.begin(), shape.sizes.end());
  if (shape.kind == ShapeKind::kHalfSpace) {
    const Face& f = shape.faces[0];
    numbers.insert(numbers.end(), f.normal.begin(), f.normal.end());
    numbers.push_back(f.offset);
  }
  if (shape.kind == ShapeKind::kPrism) {
    const auto corners = Corners(arena, shape);
    if (!corners) return false;
    for (const auto& c : *corners) numbers.insert(numbers.end(), c.begin(), c.end());
  }
  part.count = numbers.size() - part.first;
  parts.push_back(std::move(part));
  return true;
}

}  // namespace

std::vector<TermId> VariablesOf(Arena& arena, const Shape& shape) {
  std::vector<Part> parts;
  std::vector<TermId> numbers;
  Collect(arena, shape, parts, numbers);
  const auto variables = VariablesOf(arena, numbers);
  return {variables.begin(), variables.end()};
}

struct Solid::Parts {
  explicit Parts(reach::Program code)
      : program(std::move(code)), evaluate(program), numbers(program.outputs.size()) {}

  reach::Program program;
  reach::Evaluator evaluate;
  std::vector<double> numbers;
  std::vector<Part> parts;
};

Solid::Solid(std::unique_ptr<Parts> parts) : parts_(std::move(parts)) {}
Solid::~Solid() = default;
Solid::Solid(Solid&&) noexcept = default;
Solid& Solid::operator=(Solid&&) noexcept = default;

std::optional<Solid> Solid::Of(Arena& arena, const Shape& shape, std::vector<TermId> variables) {
  std::vector<Part> parts;
  std::vector<TermId> numbers;
  if (!Collect(arena, shape, parts, numbers)) return std::nullopt;
  auto program = reach::Compile(arena, std::move(variables), numbers);
  if (!program.ok()) return std::nullopt;
  auto all = std::make_unique<Parts>(std::move(program).value());
  all->parts = std::move(parts);
  return Solid(std::move(all));
}

bool Solid::Place(std::span<const double> values) {
  parts_->evaluate(values, parts_->numbers);
  if (!std::ranges::all_of(parts_->numbers, [](double n) { return std::isfinite(n); })) return false;
  for (Part& part : parts_->parts) {
    const auto n = std::span<const double>(parts_->numbers).subspan(part.first, part.count);
    const auto sizes = n.subspan(kFrame);
    if (!part.object || !std::ranges::equal(part.made, sizes)) {
      part.made.assign(sizes.begin(), sizes.end());
      part.object.emplace(Make(part.kind, sizes, part.middle));
    }
    fcl::Transform3d pose = fcl::Transform3d::Identity();
    for (size_t i = 0; i < 3; ++i) {
      const auto row = static_cast<Eigen::Index>(i);
      for (size_t j = 0; j < 3; ++j) pose.linear()(row, static_cast<Eigen::Index>(j)) = n[3 * i + j];
      pose.translation()(row) = n[9 + i];
    }
    pose.translation() += pose.linear() * part.middle;
    part.object->setTransform(pose);
    part.object->computeAABB();
  }
  return true;
}

std::optional<Contact> Solid::With(const Solid& other, double interesting) const {
  Contact contact{false, std::numeric_limits<double>::infinity()};
  const auto is_plane = [](const fcl::CollisionObjectd& o) { return o.getNodeType() == fcl::GEOM_HALFSPACE; };
  for (const Part& a : parts_->parts) {
    for (const Part& b : other.parts_->parts) {
      const fcl::CollisionObjectd &x = *a.object, &y = *b.object;
      const bool plane = is_plane(x) || is_plane(y);
      const double boxes = plane ? 0 : x.getAABB().distance(y.getAABB());
      if (boxes > 0 && boxes >= std::min(interesting, contact.distance)) {
        contact.distance = std::min(contact.distance, boxes);
        continue;
      }
      fcl::CollisionResultd collision;
      fcl::collide(&x, &y, fcl::CollisionRequestd(), collision);
      if (collision.isCollision()) return Contact{true, 0};
      if (plane) return std::nullopt;  // FCL has no distances from half-spaces
      fcl::DistanceResultd result;
      const double distance = fcl::distance(&x, &y, fcl::DistanceRequestd(), result);
      contact.distance = std::min(contact.distance, std::max(distance, 0.0));
    }
  }
  return contact;
}

std::vector<SolidPart> Solid::Standing() const {
  std::vector<SolidPart> standing;
  for (const Part& part : parts_->parts) {
    const auto n = std::span<const double>(parts_->numbers).subspan(part.first, part.count);
    SolidPart& one = standing.emplace_back();
    one.kind = part.kind;
    std::ranges::copy(n.first(kFrame), one.frame.begin());
    one.sizes.assign(n.begin() + kFrame, n.end());
  }
  return standing;
}

}  // namespace rondo::robot
