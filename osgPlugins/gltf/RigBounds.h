// RigBounds.h - bounds of skinned meshes that hold for all of their animations. Layer: osgPlugins.
// SPDX-License-Identifier: MIT
#pragma once

#include <osg/Group>
#include <osgAnimation/BasicAnimationManager>

namespace osgRayTrace::gltf
{

/// Sets the bound of each rig below a node: what its vertices fill in poses of all animations.
/// OSG's own bound would be twice the size of the first pose. manager: may be null; the skeleton is
/// left in the pose in which its first animation begins.
void setRigBounds(osg::Group& scene, osgAnimation::BasicAnimationManager* manager);

} // namespace osgRayTrace::gltf
