// TracedRoot.h - puts a node of a foreign graph under ray tracing and back. Layer: plugins.
// SPDX-License-Identifier: MIT
#pragma once

#include "RoomLights.h"

#include <osgRayTrace/RayTracedScene>

namespace osgRayTrace::calvr
{

/// Puts a RayTracedScene between a node and its parents while it is on. Off, the graph is as it
/// was: parents, their order and the places among their children. The converted scene is kept, so
/// that switching to and fro converts nothing. Its functions are for the update thread.
class TracedRoot
{
public:
    explicit TracedRoot(RayTraceSettings* settings);
    ~TracedRoot();
    TracedRoot(const TracedRoot&) = delete;
    TracedRoot& operator=(const TracedRoot&) = delete;

    /// Puts the scene above root; without effect if it is on, or if root is null or has no parents.
    void switchOn(osg::Group* root);
    void switchOff();
    bool isOn() const { return _root.valid(); }

    /// Updates the lights: see RoomLights; without effect if it is off.
    void updateLights(const osg::Group& room, const osg::Matrixd& rootFromRoom);

    /// Returns the scene that is put between; never null.
    RayTracedScene& scene() { return *_scene; }

private:
    osg::ref_ptr<RayTracedScene> _scene;
    osg::ref_ptr<osg::Group> _root; ///< null: switched off
    RoomLights _lights;
};

} // namespace osgRayTrace::calvr
