// TextureMapping.h - where a texture unit finds its place in the texture. Layer: scene.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/base/Math.h"

#include <cstdint>

namespace osgRayTrace::engine
{

/// Sets of texture coordinates that a mesh may have. Fixed-function units read sets 0 and 1, and
/// textures of physical materials any.
constexpr uint32_t kUvSets = 8;

/// First set of those that few meshes have: Mesh::moreUvs.
constexpr uint32_t kFirstMoreUvs = 2;

/// Tells from what a unit's texture coordinates are made [OpenGL21, sect. 2.11.4].
enum class TextureCoordinates : uint8_t
{
    Uv0,           ///< (u, v, r, 1) of Mesh::uvs and rs
    Uv1,           ///< (u, v, r, 1) of Mesh::uvs1 and rs1
    Position,      ///< (p, 1) in engine space; the converter puts object and eye linear into matrix
    SphereMap,     ///< (s, t, 0, 1); depends on the eye, as the next two do: see textureCoordinates
    ReflectionMap, ///< (r, 1)
    NormalMap,     ///< (n, 1)
};

/// Tells how a unit finds its place in the texture: (s, t, r, q) = matrix * the vector that
/// coordinates names.
struct TextureMapping
{
    TextureCoordinates coordinates = TextureCoordinates::Uv0;
    bool transformed = false; ///< false: matrix is the identity and is not read
    Mat4 matrix{1.0f};
    /// True if some coordinates are generated and others are the mesh's: ownMatrix * the vector
    /// that own names is then added.
    bool partly = false;
    TextureCoordinates own = TextureCoordinates::Uv0;
    Mat4 ownMatrix{0.0f};
};

} // namespace osgRayTrace::engine
