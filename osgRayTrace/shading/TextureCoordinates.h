// TextureCoordinates.h - where in its texture a unit looks, at a point of a surface. Layer:
// shading.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/scene/Material.h"

namespace osgRayTrace::engine
{

/// A point on a surface as texture generation sees it. All in engine space.
struct TexturePoint
{
    Vec2 uv{0.0f};
    Vec2 uv1{0.0f};
    float r = 0.0f, r1 = 0.0f; ///< the third ones

    // Unset unless the mapping is generated.
    Vec3 position{0.0f};
    Vec3 normal{0.0f, 0.0f, 1.0f};     ///< unit, as the mesh has it
    Vec3 direction{0.0f, 0.0f, -1.0f}; ///< unit, of the ray that hit
    Mat3 eyeFromEngine{1.0f};          ///< rotation into the view's axes; identity for photons
};

inline bool isGenerated(const TextureMapping& mapping)
{
    return mapping.coordinates >= TextureCoordinates::Position;
}

/// True if coordinates depend on who looks.
inline bool dependsOnEye(const TextureMapping& mapping)
{
    return mapping.coordinates >= TextureCoordinates::SphereMap;
}

/// (s, t, r, q) [OpenGL21, eq. 2.9 and sect. 2.11.4]. OpenGL takes the direction from the eye to
/// the vertex, at each vertex; here it is that of the ray that hit, at each point. For camera rays
/// these are the same. In a mirror the picture that a chrome thing shows is then that of its mirror
/// image, with the view's own axes as the axes of the map: what one would see from behind the
/// mirror.
Vec4 textureCoordinates(const TextureMapping& mapping, const TexturePoint& point);

} // namespace osgRayTrace::engine
