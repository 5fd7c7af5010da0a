// TracedRoot.h - a node of somebody else's graph, put under ray tracing and taken out again. Layer:
// plugins.
// SPDX-License-Identifier: MIT
#pragma once

#include "RoomLights.h"

#include <osgRayTrace/RayTracedScene>

namespace osgRayTrace::calvr
{

/// While it is on there is a RayTracedScene between the node and its parents; off, the graph is as
/// it was: parents, their order and the places among their children. What was converted is kept, so
/// that switching to and fro converts nothing. Update thread.
class TracedRoot
{
public:
    explicit TracedRoot(RayTraceSettings* settings);
    ~TracedRoot();
    TracedRoot(const TracedRoot&) = delete;
    TracedRoot& operator=(const TracedRoot&) = delete;

    /// Without effect if it is on, or if root is null or has no parents.
    void switchOn(osg::Group* root);
    void switchOff();
    bool isOn() const { return _root.valid(); }

    /// See RoomLights; without effect when off.
    void updateLights(const osg::Group& room, const osg::Matrixd& rootFromRoom);

    /// The one that is put between. Never null.
    RayTracedScene& scene() { return *_scene; }

private:
    osg::ref_ptr<RayTracedScene> _scene;
    osg::ref_ptr<osg::Group> _root; ///< null: off
    RoomLights _lights;
};

} // namespace osgRayTrace::calvr
