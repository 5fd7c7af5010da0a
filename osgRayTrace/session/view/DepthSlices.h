// DepthSlices.h - passes that show one picture, each a slice of its depths. Layer: session.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/scene/View.h"

#include <optional>
#include <vector>

namespace osgRayTrace::engine
{

/// Large scenes are drawn in slices: cameras with the same rays and with near and far planes of
/// their own, the last slice first, so that a depth buffer's steps suffice. One picture is right
/// for all slices.

/// Returns true if all pixels have the same rays: such views differ in how depth is written, if at
/// all.
bool sameRays(const View& a, const View& b);

/// Returns true if both views write depth the same way and have the same rays.
bool sameDepth(const View& a, const View& b);

/// Returns the view with the depth rows of another one.
View withDepthOf(View view, const View& other);

/// The planes of a view whose depth depends on the distance v along -z alone, which is so unless
/// the near plane is oblique. Depth from -1 to 1 is constant + factor / v, for orthographic views
/// constant + factor * v.
struct DepthPlanes
{
    bool orthographic = false;
    double constant = 0.0;
    double factor = 0.0;
    double near = 0.0;
    double far = 0.0; ///< the far distance, which may be infinite

    bool reversed() const { return orthographic ? factor < 0.0 : factor > 0.0; }
};

/// Returns the planes of the view, or nothing for views of other kinds, whose pictures are not
/// shared.
std::optional<DepthPlanes> depthPlanes(const View& view);

/// Returns the view that is traced for slices: the rays begin at the nearest plane. Depth has the
/// relative precision of floats up to infinity, with 1 at the nearest plane; orthographic depth
/// grows from 0 at the nearest plane to 1 at the last one. slices is not empty, and all slices have
/// the same rays and depthPlanes.
View viewOfSlices(const std::vector<View>& slices);

/// Depths of the traced view become those of a pass by scale * depth + offset. Results that are not
/// from 0 to 1 belong to other slices.
struct DepthMap
{
    float scale = 1.0f;
    float offset = 0.0f;
    /// Depth of pixels that have none, right in front of the background. If it is below 0, such
    /// pixels are not drawn.
    float background = 0.0f;
};

/// Returns the map for a pass that is the traced view itself.
DepthMap depthMap(const View& pass);

/// Returns the map for a pass that is one of the slices.
DepthMap depthMap(const View& pass, const std::vector<View>& slices);

} // namespace osgRayTrace::engine
