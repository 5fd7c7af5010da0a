// SoftwareVertices.h - skinned and morphed geometry that only the GPU would compute. Layer: bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include <osg/Geometry>
#include <osg/NodeVisitor>

#include <map>
#include <vector>

namespace osgRayTrace::engine
{

/// Copies of osgAnimation's rigs and morphs of which the application has chosen the hardware
/// transform, so that their own arrays keep the pose that they were bound in, and of those that no
/// update traversal has prepared yet. The copies are computed by OSG's software transforms; they
/// share all that does not move. The originals are not changed.
class SoftwareVertices
{
public:
    void begin() { ++_round; }

    /// What to read in place of the last node of the path: itself if its arrays are right. Valid
    /// until end().
    const osg::Geometry& posed(osg::Geometry& geometry, const osg::NodePath& path);

    /// Forgets the copies that were not asked for.
    void end();

    /// Whether the application leaves its vertices to a shader program.
    static bool isPosedByProgram(const osg::Geometry& geometry);

    /// Of a morph's targets; empty: it is none. Bones are nodes and need no such look.
    static std::vector<float> weightsOf(const osg::Geometry& geometry);

private:
    struct Copy
    {
        osg::ref_ptr<osg::Geometry> original; // keeps its address its own
        osg::ref_ptr<osg::Geometry> posed;    // null: it cannot be posed
        unsigned int used = 0;
    };

    std::map<const osg::Geometry*, Copy> _copies;
    unsigned int _round = 0;
};

} // namespace osgRayTrace::engine
