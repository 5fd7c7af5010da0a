// ViewFromMatrices.h - the engine's view from OpenSceneGraph's matrices. Layer: bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/scene/View.h"

#include <osg/Matrixd>

#include <glm/gtc/type_ptr.hpp>

namespace osgRayTrace::engine
{

/// Converts a matrix. OSG multiplies row vectors from the left and stores rows; glm multiplies
/// column vectors from the right and stores columns. The sixteen numbers of a matrix therefore
/// stand in the same order in both.
inline Mat4d matrixFromOsg(const osg::Matrixd& matrix)
{
    return glm::make_mat4(matrix.ptr());
}

/// Returns the view of a pass. Width and height are in pixels.
inline View viewFromMatrices(const osg::Matrixd& viewMatrix, const osg::Matrixd& projectionMatrix,
                             int width, int height)
{
    View view;
    view.viewFromWorld = matrixFromOsg(viewMatrix);
    view.clipFromView = matrixFromOsg(projectionMatrix);
    view.width = width;
    view.height = height;
    return view;
}

} // namespace osgRayTrace::engine
