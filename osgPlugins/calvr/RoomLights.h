// RoomLights.h - lights beside a traced node, copied to its coordinates. Layer: plugins.
// SPDX-License-Identifier: MIT
#pragma once

#include <osg/Group>
#include <osg/LightSource>
#include <osg/Matrixd>

#include <utility>
#include <vector>

namespace osgRayTrace::calvr
{

/// Copies lights below a RayTracedScene, which knows only the lights below it. OpenGL's lights
/// light all of the graph, and CalVR has its own lights beside the objects root, not above it. A
/// copy keeps the number of its light: when OSG draws, the original is set later and wins.
class RoomLights
{
public:
    /// Keeps copies, as children of below, of the light sources that are children of room.
    /// belowFromRoom: takes places in room to places in below. Nothing is touched if nothing has
    /// changed. Called by the update thread.
    void update(const osg::Group& room, const osg::Matrixd& belowFromRoom, osg::Group& below);

    /// Removes the copies.
    void clear(osg::Group& below);

private:
    using Pair = std::pair<osg::ref_ptr<const osg::LightSource>, osg::ref_ptr<osg::LightSource>>;

    bool sameSources(const std::vector<const osg::LightSource*>& sources) const;

    std::vector<Pair> _copies; ///< original and copy
};

/// Returns the light in other coordinates: place, direction, and how it weakens with distance.
osg::ref_ptr<osg::Light> placedLight(const osg::Light& light, const osg::Matrixd& hereFromThere);

} // namespace osgRayTrace::calvr
