// MeshRequest.h - the inputs of a mesh beside the arrays of its geometry. Layer: bridge.
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

/// Holds all inputs of a mesh beside the geometry's own arrays.
struct MeshRequest
{
    /// Transform of positions, in double, and of normals; nothing: identity, so that arrays may be
    /// shared.
    std::optional<osg::Matrixd> transform;
    bool decodeColors = false; ///< true: vertex colours are converted from sRGB to linear
    float depthBias = 0.0f;    ///< number of layers by which the faces are raised: see depthBias
    bool copies = false;       ///< true: no arrays are shared, as they will change
    PrimitiveRestart restart;
    unsigned int uvSets = 0;       ///< bit n: texture unit n is read, from kFirstMoreUvs on
    float pointRadius = 0.0f;      ///< radius of points and lines, see PointSolids.h; 0: left out
    std::vector<Vec4d> clipPlanes; ///< planes that cut after the transform; see clip

    bool operator==(const MeshRequest& other) const
    {
        return transform == other.transform && decodeColors == other.decodeColors &&
               depthBias == other.depthBias && copies == other.copies && restart == other.restart &&
               uvSets == other.uvSets && pointRadius == other.pointRadius &&
               clipPlanes == other.clipPlanes;
    }
};

} // namespace osgRayTrace::engine
