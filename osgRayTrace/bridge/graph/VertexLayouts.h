// VertexLayouts.h - geometries whose arrays stand in other places than those that are read. Layer:
// bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/bridge/appearance/materials/ShaderRule.h"

#include <osg/Geometry>

#include <map>
#include <tuple>

namespace osgRayTrace::engine
{

/// Keeps stand-ins for geometries, which share their arrays and primitives, between conversions, as
/// long as they are asked for. The originals are not changed.
class VertexLayouts
{
public:
    void begin() { ++_round; }

    /// Returns a geometry with these vertex attributes in the place of the fixed arrays, and with
    /// the texture coordinates of a unit in the place of those of unit 0. An array that is not
    /// there leaves the fixed one. Returns the geometry itself if nothing differs. The reference is
    /// valid until end().
    const osg::Geometry& laidOut(const osg::Geometry& geometry, const VertexAttributes& attributes,
                                 unsigned int unit);

    /// Forgets the stand-ins that nobody has asked for since begin().
    void end();

private:
    /// The original, and the arrays of the stand-in.
    using Key = std::tuple<const osg::Geometry*, int, int, int, unsigned int>;

    struct StandIn
    {
        osg::ref_ptr<const osg::Geometry> original; // keeps its address unique
        osg::ref_ptr<osg::Geometry> geometry;
        unsigned int used = 0;
    };

    std::map<Key, StandIn> _standIns;
    unsigned int _round = 0;
};

} // namespace osgRayTrace::engine
