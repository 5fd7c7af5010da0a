// ClipPlanes.h - the clip planes of a graph, and their effect on boxes. Layer: bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/bridge/common/SceneExtent.h"
#include "osgRayTrace/bridge/common/StateStack.h"

#include <osg/ClipNode>
#include <osg/ClipPlane>
#include <osg/Matrixd>

#include <array>
#include <vector>

namespace osgRayTrace::engine
{

/// Returns the clip planes whose modes are on, as bits.
inline uint64_t clipPlanesOn(const GraphState& state)
{
    return state.modesOn >> kClipPlaneBit & ((uint64_t(1) << kClipPlanes) - 1);
}

/// Returns the numbers of the planes of a node, as bits; those that are too large are left out.
inline uint64_t planeNumbers(const osg::ClipNode& node)
{
    uint64_t numbers = 0;
    for (const osg::ref_ptr<osg::ClipPlane>& plane : node.getClipPlaneList())
        if (plane && plane->getClipPlaneNum() < kClipPlanes)
            numbers |= uint64_t(1) << plane->getClipPlaneNum();
    return numbers;
}

/// Keeps clip planes as OpenGL does: by number, the last one set stays, wherever in the graph it
/// stands; a drawable is cut by the planes that its state has switched on. Planes that nobody has
/// set cut nothing.
class ClipPlanes
{
public:
    /// Returns false if the plane's number or its values are invalid.
    bool set(const osg::ClipPlane& plane, const osg::Matrixd& engineFromLocal);

    /// Divides lengths by unit from now on.
    void applyUnit(double unit);

    /// Takes over the planes of these numbers, as bits.
    void take(const ClipPlanes& other, uint64_t numbers);

    /// Returns the numbers, as bits, of the planes that differ.
    uint64_t differences(const ClipPlanes& other) const;

    /// Returns the planes of these numbers, as bits, that are set; in engine space each keeps
    /// (x, y, z, 1) . plane >= 0.
    std::vector<Vec4d> planesOf(uint64_t numbers) const;

private:
    std::array<Vec4d, kClipPlanes> _planes{}; // 0 0 0 0 keeps everything
};

enum class Clipping
{
    None,
    Partly,
    Wholly,
};

/// Returns how a box is clipped: Partly if in doubt or if the bounds are empty.
Clipping clippingOf(const VertexBounds& bounds, const osg::Matrixd& engineFromLocal,
                    const std::vector<Vec4d>& planes);

} // namespace osgRayTrace::engine
