// ClipPlanes.h - the clip planes of a graph, and what they cross. Layer: bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/bridge/common/SceneExtent.h"
#include "osgRayTrace/bridge/common/StateStack.h"

#include <osg/ClipPlane>
#include <osg/Matrixd>

#include <array>
#include <vector>

namespace osgRayTrace::engine
{

/// Those whose modes are on, as bits.
inline uint64_t clipPlanesOn(const GraphState& state)
{
    return state.modesOn >> kClipPlaneBit & ((uint64_t(1) << kClipPlanes) - 1);
}

/// As OpenGL keeps them: by number, the last one set stays, wherever in the graph it stands; a
/// drawable is cut by those that its state has switched on. Planes that nobody has set cut nothing.
class ClipPlanes
{
public:
    /// False if its number or its values are none.
    bool set(const osg::ClipPlane& plane, const osg::Matrixd& engineFromLocal);

    /// Lengths are divided by unit from now on.
    void applyUnit(double unit);

    /// What (x, y, z, 1) . plane >= 0 leaves in engine space.
    std::vector<Vec4d> planesOn(const GraphState& state) const;

private:
    std::array<Vec4d, kClipPlanes> _planes{}; // 0 0 0 0 keeps everything
};

enum class Clipping
{
    None,
    Partly,
    Wholly,
};

/// Of a box; Partly if in doubt. Empty bounds: Partly.
Clipping clippingOf(const VertexBounds& bounds, const osg::Matrixd& engineFromLocal,
                    const std::vector<Vec4d>& planes);

} // namespace osgRayTrace::engine
