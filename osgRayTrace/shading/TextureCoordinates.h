// TextureCoordinates.h - the place in its texture that a unit reads at a point. Layer: shading.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/scene/Material.h"

#include <array>

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

    // The following members are unset unless the material reads such sets: MaterialRecord::uvSets.
    std::array<Vec2, kUvSets - kFirstMoreUvs> moreUvs;     ///< sets from kFirstMoreUvs on
    std::array<float, kUvSets - kFirstMoreUvs> moreWidths; ///< widths in them

    Vec2 uvOfSet(uint32_t set) const
    {
        return set == 0 ? uv : set == 1 ? uv1 : moreUvs[set - kFirstMoreUvs];
    }
    float widthOfSet(uint32_t set) const
    {
        return set == 0 ? uvWidth : set == 1 ? uv1Width : moreWidths[set - kFirstMoreUvs];
    }

    /// Sets the coordinates of a set, and the width there.
    void setUv(uint32_t set, Vec2 value, float width = 0.0f)
    {
        (set == 0 ? uv : set == 1 ? uv1 : moreUvs[set - kFirstMoreUvs]) = value;
        (set == 0 ? uvWidth : set == 1 ? uv1Width : moreWidths[set - kFirstMoreUvs]) = width;
    }
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
