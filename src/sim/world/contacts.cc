#include <fcl/broadphase/broadphase_dynamic_AABB_tree.h>
#include <fcl/fcl.h>

#include <algorithm>
#include <limits>

#include "sim/world/world.h"

namespace rondo::sim {

struct Contacts::Impl {
  std::vector<std::unique_ptr<fcl::CollisionObjectd>> obstacles;
  std::vector<std::unique_ptr<fcl::CollisionObjectd>> robots;
  std::vector<double> radii;
  std::vector<Point> positions;
  fcl::DynamicAABBTreeCollisionManagerd still;
  fcl::DynamicAABBTreeCollisionManagerd moving;

  // Who an object is: a robot, or -1 - obstacle.
  static void* Tag(int who) { return reinterpret_cast<void*>(static_cast<intptr_t>(who)); }  // NOLINT
  static int Who(const fcl::CollisionObjectd* o) {
    return static_cast<int>(reinterpret_cast<intptr_t>(o->getUserData()));  // NOLINT
  }
};

Contacts::Contacts(const World& world, const std::vector<double>& radii) : impl_(std::make_unique<Impl>()) {
  int number = 0;
  const auto add = [&](const std::shared_ptr<fcl::CollisionGeometryd>& shape, const Point& at) {
    auto object = std::make_unique<fcl::CollisionObjectd>(shape);
    object->setTranslation(fcl::Vector3d(at[0], at[1], at[2]));
    object->computeAABB();
    object->setUserData(Impl::Tag(-1 - number++));
    impl_->still.registerObject(object.get());
    impl_->obstacles.push_back(std::move(object));
  };
  for (const Box& b : world.boxes)
    add(std::make_shared<fcl::Boxd>(b.size[0], b.size[1], b.size[2]), b.centre);
  for (const Cylinder& c : world.cylinders)
    add(std::make_shared<fcl::Cylinderd>(c.radius, c.height), c.centre);
  impl_->still.setup();
  impl_->radii = radii;
  for (size_t r = 0; r < radii.size(); ++r) {
    auto object = std::make_unique<fcl::CollisionObjectd>(std::make_shared<fcl::Sphered>(radii[r]));
    object->setUserData(Impl::Tag(static_cast<int>(r)));
    object->computeAABB();
    impl_->moving.registerObject(object.get());
    impl_->robots.push_back(std::move(object));
  }
  impl_->moving.setup();
}

Contacts::~Contacts() = default;

void Contacts::Move(const std::vector<Point>& positions) {
  impl_->positions = positions;
  for (size_t r = 0; r < positions.size(); ++r) {
    impl_->robots[r]->setTranslation(fcl::Vector3d(positions[r][0], positions[r][1], positions[r][2]));
    impl_->robots[r]->computeAABB();
  }
  impl_->moving.update();
}

std::vector<std::pair<int, int>> Contacts::Touching() const {
  std::vector<std::pair<int, int>> pairs;
  const auto near = [](fcl::CollisionObjectd* a, fcl::CollisionObjectd* b, void* data) {
    const fcl::CollisionRequestd request;
    fcl::CollisionResultd result;
    if (fcl::collide(a, b, request, result) > 0) {
      int x = Impl::Who(a);
      int y = Impl::Who(b);
      if (x < 0 || (y >= 0 && y < x)) std::swap(x, y);
      static_cast<std::vector<std::pair<int, int>>*>(data)->emplace_back(x, y);
    }
    return false;
  };
  impl_->moving.collide(&pairs, near);
  impl_->moving.collide(&impl_->still, &pairs, near);
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

namespace {

// For the managers: keeps the least distance.
bool Nearer(fcl::CollisionObjectd* a, fcl::CollisionObjectd* b, void* data, double& least) {
  auto& best = *static_cast<double*>(data);
  const fcl::DistanceRequestd request;
  fcl::DistanceResultd result;
  fcl::distance(a, b, request, result);
  // Negative: they touch.
  best = std::min(best, std::max(0.0, result.min_distance));
  least = best;
  return false;
}

}  // namespace

double Contacts::LeastBetweenRobots() const {
  double best = std::numeric_limits<double>::infinity();
  impl_->moving.distance(&best, Nearer);
  return best;
}

double Contacts::LeastToObstacles() const {
  double best = std::numeric_limits<double>::infinity();
  if (!impl_->obstacles.empty()) impl_->moving.distance(&impl_->still, &best, Nearer);
  return best;
}

}  // namespace rondo::sim
