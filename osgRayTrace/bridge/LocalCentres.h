// LocalCentres.h - where the vertices of shared geometries are, found without OSG. Layer: bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include <osg/Geometry>
#include <osg/Vec3d>

#include <map>

namespace osgRayTrace::engine
{

/// The origin that suits a geometry's instances. osg::Geometry knows its own bound, but finds it
/// through the indices, and reads memory that is not its own where one is out of range.
class LocalCentres
{
public:
    /// Forgets what was not asked for since the last call.
    void begin();

    /// The centre of the vertices if they are far from the local origin, else that origin. Kept
    /// while the vertex array and its modified count stay.
    osg::Vec3d of(const osg::Geometry& geometry);

private:
    struct Entry
    {
        osg::ref_ptr<const osg::Array> vertices;
        unsigned int modified = 0;
        osg::Vec3d centre;
    };
    using Entries = std::map<const osg::Geometry*, Entry>;

    Entries _current, _previous;
};

} // namespace osgRayTrace::engine
