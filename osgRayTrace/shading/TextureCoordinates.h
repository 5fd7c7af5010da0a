// TextureCoordinates.h - the place in its texture that a unit reads at a point. Layer: shading.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/scene/Material.h"

namespace osgRayTrace::engine
{

/// Describes a point on a surface as texture generation sees it. All members are in engine space.
struct TexturePoint
{
    Vec2 uv{0.0f};
    Vec2 uv1{0.0f};
    float r = 0.0f, r1 = 0.0f; ///< third coordinates of uv and uv1

    // The footprint is a square with the area that the pixel sees; 0: a point.
    float footprint = 0.0f;                ///< width [engine units]
    float uvWidth = 0.0f, uv1Width = 0.0f; ///< widths in uv and uv1

    // The following members are unset unless the mapping is generated.
    Vec3 position{0.0f};
    Vec3 normal{0.0f, 0.0f, 1.0f};     ///< unit, the normal of the mesh
    Vec3 direction{0.0f, 0.0f, -1.0f}; ///< unit, direction of the ray that hit
    Mat3 eyeFromEngine{1.0f};          ///< rotation into the view's axes; identity for photons
};

inline bool isGenerated(const TextureMapping& mapping)
{
    return mapping.coordinates >= TextureCoordinates::Position;
}

/// Returns true if coordinates depend on the place of the eye.
inline bool dependsOnEye(const TextureMapping& mapping)
{
    return mapping.coordinates >= TextureCoordinates::SphereMap;
}

/// Returns (s, t, r, q) [OpenGL21, eq. 2.9 and sect. 2.11.4]. OpenGL takes the direction from the
/// eye to the vertex, at each vertex; this function takes the direction of the ray that hit, at
/// each point. For camera rays these are the same. A mirror then shows a chrome object with the
/// picture of its mirror image, with the view's own axes as the axes of the map: what one would see
/// from behind the mirror.
Vec4 textureCoordinates(const TextureMapping& mapping, const TexturePoint& point);

/// Returns the width of the footprint in the mapping's (s, t), a square with the same area. The
/// width is 0, that of a point, if it would have to follow q, a direction to the eye or a sum of
/// generated coordinates and the mesh's.
float textureWidth(const TextureMapping& mapping, const TexturePoint& point);

} // namespace osgRayTrace::engine
