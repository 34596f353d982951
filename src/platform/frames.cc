#include "platform/frames.h"

#include <cmath>
#include <utility>
#include <vector>

namespace rondo::platform {

using ros::geometry_msgs::Pose;
using ros::geometry_msgs::Quaternion;
using ros::geometry_msgs::Transform;
using ros::geometry_msgs::Vector3;

namespace {

constexpr size_t kMostFrames = 10'000;
constexpr size_t kMostSteps = 64;  // from a frame to the root: more are a circle

std::string Plain(const std::string& name) { return name.starts_with('/') ? name.substr(1) : name; }

Quaternion Product(const Quaternion& a, const Quaternion& b) {
  Quaternion q;
  q.w = a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z;
  q.x = a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y;
  q.y = a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x;
  q.z = a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w;
  return q;
}

Quaternion Opposite(Quaternion q) {
  q.x = -q.x;
  q.y = -q.y;
  q.z = -q.z;
  return q;
}

// First `inner`, then `outer`.
Transform Chained(const Transform& outer, const Transform& inner) {
  Transform t;
  const Vector3 v = Rotated(outer.rotation, inner.translation);
  t.translation.x = outer.translation.x + v.x;
  t.translation.y = outer.translation.y + v.y;
  t.translation.z = outer.translation.z + v.z;
  t.rotation = Product(outer.rotation, inner.rotation);
  return t;
}

Transform Inverse(const Transform& t) {
  Transform back;
  back.rotation = Opposite(t.rotation);
  const Vector3 v = Rotated(back.rotation, t.translation);
  back.translation.x = -v.x;
  back.translation.y = -v.y;
  back.translation.z = -v.z;
  return back;
}

Transform Identity() {
  Transform t;
  t.rotation.w = 1;
  return t;
}

}  // namespace

Vector3 Rotated(const Quaternion& q, const Vector3& v) {
  Quaternion p;
  p.x = v.x;
  p.y = v.y;
  p.z = v.z;
  const Quaternion r = Product(Product(q, p), Opposite(q));
  Vector3 out;
  out.x = r.x;
  out.y = r.y;
  out.z = r.z;
  return out;
}

Pose Applied(const Transform& transform, const Pose& pose) {
  Vector3 v;
  v.x = pose.position.x;
  v.y = pose.position.y;
  v.z = pose.position.z;
  v = Rotated(transform.rotation, v);
  Pose out;
  out.position.x = transform.translation.x + v.x;
  out.position.y = transform.translation.y + v.y;
  out.position.z = transform.translation.z + v.z;
  out.orientation = Product(transform.rotation, pose.orientation);
  return out;
}

void Frames::Hear(const ros::tf2_msgs::TFMessage& message) {
  for (const auto& stamped : message.transforms) {
    Transform t = stamped.transform;
    Quaternion& q = t.rotation;
    const double length = std::sqrt(q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w);
    const double sum = t.translation.x + t.translation.y + t.translation.z + length;
    const std::string child = Plain(stamped.child_frame_id), parent = Plain(stamped.header.frame_id);
    if (!std::isfinite(sum) || std::fabs(length - 1) > 0.1 || child == parent) continue;
    for (double* x : {&q.x, &q.y, &q.z, &q.w}) *x /= length;
    if (places_.size() < kMostFrames || places_.contains(child)) places_[child] = {parent, t};
  }
}

std::optional<Transform> Frames::Lookup(const std::string& to, const std::string& from) const {
  // From both up to the root, as far as somebody said.
  const auto up = [this](std::string frame) {
    std::vector<std::pair<std::string, Transform>> chain{{frame, Identity()}};
    while (chain.size() < kMostSteps) {
      const auto place = places_.find(frame);
      if (place == places_.end()) break;
      frame = place->second.parent;
      chain.emplace_back(frame, Chained(place->second.transform, chain.back().second));
    }
    return chain;
  };
  const auto a = up(Plain(from)), b = up(Plain(to));
  for (const auto& [frame, there] : a) {
    for (const auto& [other, back] : b) {
      if (frame == other) return Chained(Inverse(back), there);
    }
  }
  return std::nullopt;
}

}  // namespace rondo::platform
