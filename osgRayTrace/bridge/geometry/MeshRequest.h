// MeshRequest.h - what a mesh depends on beside the arrays of its geometry. Layer: bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/base/Math.h"
#include "osgRayTrace/bridge/geometry/TriangleList.h"

#include <osg/Matrixd>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace osgRayTrace::engine
{

/// What a mesh depends on beside the geometry's own arrays.
struct MeshRequest
{
    /// Applied to positions in double, and to normals; nothing: identity, then arrays may be
    /// shared.
    std::optional<osg::Matrixd> transform;
    bool decodeColors = false; ///< vertex colours from sRGB to linear
    float depthBias = 0.0f;    ///< layers that the faces are raised by: see depthBias
    bool copies = false;       ///< shares no arrays: they will change
    PrimitiveRestart restart;
    std::vector<Vec4d> clipPlanes; ///< after the transform; see clip

    bool operator==(const MeshRequest& other) const
    {
        return transform == other.transform && decodeColors == other.decodeColors &&
               depthBias == other.depthBias && copies == other.copies && restart == other.restart &&
               clipPlanes == other.clipPlanes;
    }
};

} // namespace osgRayTrace::engine
