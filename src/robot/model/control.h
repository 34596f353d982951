#pragma once

#include "robot/model/world.h"

/// Says what controllers make of terms.
namespace rondo::robot {

/// Returns the term with what a controller sets at all times in the place of these inputs; the term itself if the controller
/// acts in periods. Laws may read what others set, eight of them behind one another.
TermId Determined(Arena& arena, const Control& control, TermId term);

}  // namespace rondo::robot
