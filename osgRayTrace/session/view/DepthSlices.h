// DepthSlices.h - passes that show one picture, each a slice of its depths. Layer: session.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/scene/View.h"

#include <optional>
#include <vector>

namespace osgRayTrace::engine
{

/// Large scenes are drawn in slices: cameras with the same rays and their own near and far planes,
/// the last one first, so that a depth buffer's steps suffice. One picture is right for all of
/// them.

/// True if all pixels have the same rays: views that differ in how depth is written, if at all.
bool sameRays(const View& a, const View& b);

/// True if depth is written the same way, too.
bool sameDepth(const View& a, const View& b);

/// The view with the depth rows of another one.
View withDepthOf(View view, const View& other);

/// The planes of a view whose depth depends on the distance v along -z alone, as it does but for
/// oblique near planes: depth from -1 to 1 is constant + factor / v, for orthographic views
/// constant + factor * v.
struct DepthPlanes
{
    bool orthographic = false;
    double constant = 0.0;
    double factor = 0.0;
    double near = 0.0;
    double far = 0.0; ///< may be infinite

    bool reversed() const { return orthographic ? factor < 0.0 : factor > 0.0; }
};

/// The planes of the view. Nothing for views of other kinds, whose pictures are not shared.
std::optional<DepthPlanes> depthPlanes(const View& view);

/// The view that is traced for slices: the rays begin at the nearest plane, and depth has the
/// relative precision of floats up to infinity, the nearest plane at 1; orthographic, from the
/// nearest plane at 0 to the last one at 1. slices: all of the same rays, with depthPlanes, not
/// empty.
View viewOfSlices(const std::vector<View>& slices);

/// Depths of the traced view become those of a pass by scale * depth + offset. Results that are not
/// from 0 to 1 belong to other slices.
struct DepthMap
{
    float scale = 1.0f;
    float offset = 0.0f;
    /// Depth of pixels that have none, right in front of the background; < 0: they are not drawn.
    float background = 0.0f;
};

/// The map for a pass that is the traced view itself.
DepthMap depthMap(const View& pass);

/// The map for a pass that is one of the slices.
DepthMap depthMap(const View& pass, const std::vector<View>& slices);

} // namespace osgRayTrace::engine
