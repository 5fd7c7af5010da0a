// MaterialTable.h - what shading needs of each material, with everything constant worked out.
// Layer: shading.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/scene/Scene.h"
#include "osgRayTrace/shading/Bsdf.h"

#include <vector>

namespace osgRayTrace::engine
{

/// Where on a surface the material is asked for.
struct MaterialPoint
{
    Vec2 uv{0.0f};
    Vec4 vertexColor{1.0f};
    bool front = true; ///< seen from the counter-clockwise side: decides inside and outside of glass
};

struct MaterialRecord
{
    const Material* material = nullptr;
    Bsdf front;               ///< seen from outside; exact if constant
    Bsdf back;                ///< seen from inside; differs for transmissive surfaces
    bool constant = true;     ///< neither textures nor vertex colours
    bool plainDiffuse = false; ///< constant, and nothing but a Lambert base
    bool fixedFunction = false;
    bool emits = false;       ///< emission, or an unlit fixed-function colour
};

/// Indexed by material. Built once for a scene; thread safe.
class MaterialTable
{
public:
    explicit MaterialTable(const Scene& scene);

    const MaterialRecord& operator[](uint32_t material) const { return _records[material]; }

    /// The physical surface model at a point. Fixed-function materials: diffuse is the Lambert base, the
    /// highlight a GGX reflection of alpha = sqrt(2/(shininess+2)) [Walter07, sect. 5.2] whose reflectance
    /// is specular * 8/(shininess+2), at most specular: what a normalised highlight of equal peak has.
    Bsdf bsdf(uint32_t material, const MaterialPoint& point) const;

    /// Radiance that leaves the surface by itself: emission, or the colour of unlit fixed-function ones.
    Vec3 emission(uint32_t material, const MaterialPoint& point) const;

    /// Unit 0 or base colour texture at a point; white without one.
    Vec4 baseTexture(const Material& material, Vec2 uv) const;

private:
    Vec4 textureOr(uint32_t texture, Vec2 uv, Vec4 otherwise) const;
    Bsdf physical(const Material& material, const MaterialPoint& point) const;
    Bsdf fixedFunction(const Material& material, const MaterialPoint& point) const;

    const Scene* _scene;
    std::vector<MaterialRecord> _records;
    struct Coat
    {
        float average; ///< of a smooth one
        std::shared_ptr<CoatAlbedo> rough; ///< if it may be, over a base
    };
    Coat coatOf(const Material& material, float eta) const;
    std::vector<std::array<Coat, 2>> _coats; ///< a material: from outside, from inside
};

/// Ambient, diffuse, specular and emission after the vertex colour has replaced what it replaces.
struct FixedFunctionColors
{
    Vec3 ambient, diffuse, specular, emission;
    float alpha;
};
FixedFunctionColors fixedFunctionColors(const Material& material, const Vec4& vertexColor);

/// The texture environment of unit 0 applied to a lit colour [OpenGL21, table 3.23].
Vec4 applyTextureEnvironment(TextureEnvironment environment, Vec4 lit, Vec4 texture);

} // namespace osgRayTrace::engine
