// MaterialTable.h - what shading needs of each material, with everything constant worked out.
// Layer: shading.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/base/Assert.h"
#include "osgRayTrace/scene/Scene.h"
#include "osgRayTrace/shading/Bsdf.h"
#include "osgRayTrace/shading/TextureCoordinates.h"

#include <vector>

namespace osgRayTrace::engine
{

/// Where on a surface the material is asked for.
struct MaterialPoint : TexturePoint
{
    Vec4 vertexColor{1.0f};
    bool front =
        true; ///< seen from the counter-clockwise side: decides inside and outside of glass
};

struct MaterialRecord
{
    const Material* material = nullptr;
    Bsdf front;                ///< seen from outside; exact if constant
    Bsdf back;                 ///< seen from inside; differs for transmissive surfaces
    bool constant = true;      ///< neither textures nor vertex colours
    bool sameLobes = true;     ///< lobes, not colours, are those of front and back at each point
    bool plainDiffuse = false; ///< constant, and nothing but a Lambert base
    bool fixedFunction = false;
    bool emits = false;     ///< emission, or an unlit fixed-function colour
    bool generated = false; ///< texture coordinates need the point's position, normal and direction
    bool partial = false;   ///< some rays pass it: see opacity and Material::culling
};

/// The texture units of a fixed-function material, looked up at a point.
struct TextureTerms
{
    struct Term
    {
        TextureEnvironment environment = TextureEnvironment::Modulate;
        bool hasColor = true, hasAlpha = true;
        Vec4 value{1.0f}, environmentColor{0.0f};
    };
    Term units[2];
    int count = 0;
};

/// Indexed by material. Built once for a scene; thread safe.
class MaterialTable
{
public:
    explicit MaterialTable(const Scene& scene);

    const MaterialRecord& operator[](uint32_t material) const
    {
        OSGRAYTRACE_ASSERT(material < _records.size());
        return _records[material];
    }

    /// The physical surface model at a point. Fixed-function materials: diffuse is the Lambert
    /// base, the highlight a GGX reflection of alpha = sqrt(2/(shininess+2)) [Walter07, sect. 5.2],
    /// textured as OpenGL does. A sphere that is lit from the eye is on average as bright by it as
    /// by OpenGL's highlight, so its reflectance is about specular * 8/(shininess+2). No more light
    /// leaves than comes: the highlight is limited to what the largest component of diffuse leaves
    /// of 1, but not to less than the 0.04 of an interface of index 1.5; where they do not go
    /// together diffuse is scaled down by as much.
    Bsdf bsdf(uint32_t material, const MaterialPoint& point) const;

    /// Radiance that leaves the surface by itself: emission, or the colour of unlit fixed-function
    /// ones.
    Vec3 emission(uint32_t material, const MaterialPoint& point) const;

    /// Those of a fixed-function material at a point.
    TextureTerms textures(const Material& material, const MaterialPoint& point) const;

    /// Share of the light that the surface stops at a point: 0 where the alpha test fails, alpha if
    /// the material is blended (straight alpha, source alpha and one minus it), else 1. In [0, 1].
    float opacity(uint32_t material, const MaterialPoint& point) const;

private:
    bool isPartial(const Material& material) const;
    float fixedFunctionAlpha(const Material& material, const MaterialPoint& point) const;
    Vec4 baseTexture(const Material& material, const MaterialPoint& point) const;
    Vec4 textureOr(uint32_t texture, Vec2 uv, Vec4 otherwise) const;
    Bsdf physical(const Material& material, const MaterialPoint& point) const;
    Bsdf fixedFunction(const Material& material, const MaterialPoint& point) const;

    const Scene* _scene;
    std::vector<MaterialRecord> _records;
    struct Coat
    {
        float average;                     ///< of a smooth one
        std::shared_ptr<CoatAlbedo> rough; ///< if it may be, over a base
    };
    Coat coatOf(const Material& material, float eta) const;
    std::vector<std::array<Coat, 2>> _coats; ///< a material: from outside, from inside
};

/// Those of the seen face after the vertex colour has replaced what it replaces.
FaceColors fixedFunctionColors(const Material& material, const Vec4& vertexColor,
                               bool front = true);

/// OpenGL's idea of the front, where lighting has two sides.
inline bool isFrontFace(const Material& material, bool counterClockwise)
{
    return counterClockwise != material.clockwise;
}

/// Whether FaceCulling takes that side of the face away.
bool isCulled(const Material& material, bool front);

/// A texture environment applied to a lit colour [OpenGL21, table 3.22 and 3.23].
Vec4 applyTextureEnvironment(const TextureTerms::Term& texture, Vec4 lit);

/// All units, one after the other.
Vec4 applyTextures(const TextureTerms& textures, Vec4 lit);

} // namespace osgRayTrace::engine
