// SoftwareVertices.h - computes skinned and morphed geometry that only the GPU would compute.
// Layer: bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include <osg/Geometry>
#include <osg/NodeVisitor>

#include <map>
#include <vector>

namespace osgRayTrace::engine
{

/// Holds copies of those of osgAnimation's rigs and morphs whose own arrays do not show the pose.
/// Either the application has chosen the hardware transform, so that the arrays keep the pose in
/// which they were bound, or no update traversal has prepared the geometry yet. OSG's software
/// transforms compute the copies, which share all that does not move. The originals are not
/// changed.
class SoftwareVertices
{
public:
    void begin() { ++_round; }

    /// Returns the geometry to read in place of the last node of the path, or this node itself if
    /// its arrays are right. The reference is valid until end().
    const osg::Geometry& posed(osg::Geometry& geometry, const osg::NodePath& path);

    /// Forgets the copies that were not asked for.
    void end();

    /// Forgets the copies of geometries that nobody else holds.
    void dropUnshared();

    /// Returns whether the application leaves the geometry's vertices to a shader program.
    static bool isPosedByProgram(const osg::Geometry& geometry);

    /// Returns the weights of a morph's targets; empty for other geometry. Bones are nodes and are
    /// watched as such.
    static std::vector<float> weightsOf(const osg::Geometry& geometry);

private:
    struct Copy
    {
        osg::ref_ptr<osg::Geometry> original; // keeps the original's address unique
        osg::ref_ptr<osg::Geometry> posed;    // null: it cannot be posed
        unsigned int used = 0;
    };

    std::map<const osg::Geometry*, Copy> _copies;
    unsigned int _round = 0;
};

} // namespace osgRayTrace::engine
