#pragma once

#include <map>
#include <optional>
#include <string>

#include "ros/geometry_msgs.h"
#include "ros/tf2_msgs.h"

namespace rondo::platform {

/// Remembers how frames lie in each other, as `/tf` and `/tf_static` say: the latest of each. Not thread-safe.
class Frames {
 public:
  /// Takes in what a message says; transforms that are none (not finite, no rotation) are left out.
  void Hear(const ros::tf2_msgs::TFMessage& message);

  /// Returns how frame `from` lies in frame `to`: what takes its points there. Nothing if nobody said so. A frame lies in
  /// itself as it is; names may have a `/` in front, as in older versions.
  std::optional<ros::geometry_msgs::Transform> Lookup(const std::string& to, const std::string& from) const;

 private:
  struct Place {
    std::string parent;
    ros::geometry_msgs::Transform transform;
  };
  std::map<std::string, Place> places_;  // by child
};

/// Returns a pose as it is seen from the frame that the transform leads to.
ros::geometry_msgs::Pose Applied(const ros::geometry_msgs::Transform& transform,
                                 const ros::geometry_msgs::Pose& pose);
/// Returns a vector turned by a unit quaternion.
ros::geometry_msgs::Vector3 Rotated(const ros::geometry_msgs::Quaternion& q,
                                    const ros::geometry_msgs::Vector3& v);

}  // namespace rondo::platform
