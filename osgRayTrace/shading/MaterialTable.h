// MaterialTable.h - the constants of each material that shading needs, worked out once. Layer:
// shading.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/base/Assert.h"
#include "osgRayTrace/scene/Scene.h"
#include "osgRayTrace/shading/Bsdf.h"
#include "osgRayTrace/shading/TextureCoordinates.h"

#include <cmath>
#include <vector>

namespace osgRayTrace::engine
{

/// Holds the point of a surface at which the material is asked for.
struct MaterialPoint : TexturePoint
{
    Vec4 vertexColor{1.0f};
    bool front =
        true; ///< seen from the counter-clockwise side: decides inside and outside of glass
};

struct MaterialRecord
{
    const Material* material = nullptr;
    Bsdf front;           ///< seen from outside; exact if constant
    Bsdf back;            ///< seen from inside; differs for transmissive surfaces
    bool constant = true; ///< true: neither textures nor vertex colours
    bool sameLobes =
        true; ///< true: front and back have the lobes, though not the colours, of each point
    bool plainDiffuse = false; ///< true: constant, and nothing but a Lambert base
    bool fixedFunction = false;
    bool emits = false; ///< true: emission, or an unlit fixed-function colour
    bool generated =
        false; ///< true: texture coordinates need the point's position, normal and direction
    bool partial = false;   ///< true: some rays pass the surface: see opacity and Material::culling
    bool mipmapped = false; ///< true: looks textures with mips up: see setTextureWidths
    bool normalMap = false; ///< true: a texture decides on the shading normals
    bool pane = false;      ///< true: light may pass straight: see MaterialTable::pane
    bool interface = false; ///< true: nothing but the boundary of a medium: see isInterface
    bool subsurface = false;        ///< true: light enters the body: see hasSubsurface
    bool absorbs = false;           ///< true: the body below the surface absorbs light
    uint8_t uvSets = 0;             ///< bit n: a texture reads set n, from kFirstMoreUvs on
    Vec3 subsurfaceSigma{0.0f};     ///< extinction below the surface [1/engine unit]
    bool subsurfaceVaries = false;  ///< true: textures decide on what light below it meets
    bool radiusVaries = false;      ///< true: a texture decides on subsurfaceSigma
    bool baseShareVaries = false;   ///< true: a texture decides on Bsdf::baseShare
    float largestBaseShare = 1.0f;  ///< of all points
    float largestSubsurface = 0.0f; ///< of all points
    Vec3 largestBodyColor{0.0f};    ///< of all points: base colours
    Vec3 absorption{0.0f}; ///< coefficients of that [1/engine unit] [glTF20, KHR_materials_volume]
};

/// Returns what is left of light after a distance within the body [engine units].
inline Vec3 transmittanceOver(const MaterialRecord& material, float distance)
{
    return glm::exp(-material.absorption * distance);
}

/// Holds the texture units of a fixed-function material, looked up at a point.
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

/// Holds a record for each material, by its index. The table is built once for a scene; thread
/// safe.
class MaterialTable
{
public:
    explicit MaterialTable(const Scene& scene);

    const MaterialRecord& operator[](uint32_t material) const
    {
        OSGRAYTRACE_ASSERT(material < _records.size());
        return _records[material];
    }

    /// Returns the physical surface model at a point. For fixed-function materials diffuse is the
    /// Lambert base and the highlight a GGX reflection of alpha = sqrt(2/(shininess+2)) [Walter07,
    /// sect. 5.2], textured as OpenGL does. A sphere that is lit from the eye is on average as
    /// bright with that reflection as with OpenGL's highlight, so that the reflectance is about
    /// specular * 8/(shininess+2). No more light leaves than comes: the highlight is limited to
    /// what the largest component of diffuse leaves of 1, but not to less than the 0.04 of an
    /// interface of index 1.5. If both together are above 1 even so, diffuse is scaled down to what
    /// the highlight leaves.
    Bsdf bsdf(uint32_t material, const MaterialPoint& point) const;

    /// Returns the extinction below a point of a surface with subsurface [1/engine unit].
    Vec3 subsurfaceSigma(uint32_t material, const MaterialPoint& point) const;

    /// Returns the share of the light that comes to a point of a diffuse boundary from below and
    /// leaves there, in [0, 1]: Bsdf::baseShare over the largest of the material. Metal, and what
    /// is clear or diffuses light through, keeps the rest below.
    float leavingShare(uint32_t material, const MaterialPoint& point) const;

    /// Returns the share of the light that passes a point of a pane straight, for a direction with
    /// this cosine to the shading normal. Panes are thin walls with smooth faces.
    Vec3 pane(uint32_t material, const MaterialPoint& point, float cosTheta) const;

    /// Returns the normal of a normal map at a point: along s, along t and the surface's normal; of
    /// any length. role: of the surface or of its clear coat.
    Vec3 mappedNormal(const Material& material, TextureRole role, const MaterialPoint& point) const;

    /// Returns the radiance that leaves the surface by itself: emission, or the colour of unlit
    /// fixed-function materials.
    Vec3 emission(uint32_t material, const MaterialPoint& point) const;

    /// Returns the texture units of a fixed-function material, looked up at a point.
    TextureTerms textures(const Material& material, const MaterialPoint& point) const;

    /// Returns the share of the light that the surface stops at a point, in [0, 1]: 0 if the alpha
    /// test fails, alpha if the material is blended (straight alpha, source alpha and one minus
    /// it), else 1.
    float opacity(uint32_t material, const MaterialPoint& point) const;

private:
    bool isPartial(const Material& material) const;
    float fixedFunctionAlpha(const Material& material, const MaterialPoint& point) const;
    Vec4 baseTexture(const Material& material, const MaterialPoint& point) const;
    Vec4 textureOr(const Material& material, TextureRole role, const MaterialPoint& point) const;
    Bsdf physical(const Material& material, const MaterialPoint& point) const;
    void addAnisotropy(const Material& material, const MaterialPoint& point, Bsdf& bsdf) const;
    void addDiffuseTransmission(const Material& material, const MaterialPoint& point,
                                Bsdf& bsdf) const;
    float baseShare(const Material& material, const MaterialPoint& point) const;
    void addSubsurface(const Material& material, const MaterialPoint& point, Bsdf& bsdf) const;
    void setSubsurface(const Material& material, MaterialRecord& record) const;
    void addFilm(const Material& material, const MaterialPoint& point, Bsdf& bsdf) const;
    void addLayers(const Material& material, const MaterialPoint& point, Bsdf& bsdf) const;
    Bsdf fixedFunction(const Material& material, const MaterialPoint& point) const;
    void prepareClearcoat(const Material& material);
    void setDetail(const Material& material, MaterialRecord& record) const;

    const Scene* _scene;
    std::vector<MaterialRecord> _records;
    struct Coat
    {
        float average; ///< of a smooth coat
        std::shared_ptr<CoatAlbedo>
            rough; ///< null unless the coat may be rough and lies over a base
    };
    Coat coatOf(const Material& material, float eta) const;
    std::vector<std::array<Coat, 2>> _coats; ///< a material: from outside, from inside
    std::shared_ptr<CoatAlbedo> _clearcoat;  ///< null unless some clear coat is rough
};

/// Returns where a texture of a physical material is looked up.
inline Vec2 placedUv(const TexturePlace& place, const TexturePoint& point)
{
    const Vec2 uv = point.uvOfSet(place.set);
    return place.offset + place.u * uv.x + place.v * uv.y;
}

/// Returns the width of the footprint where a texture of a physical material is looked up.
inline float placedWidth(const TexturePlace& place, const TexturePoint& point)
{
    const float width = point.widthOfSet(place.set);
    return width * std::sqrt(std::fabs(place.u.x * place.v.y - place.u.y * place.v.x));
}

/// Returns the colours of the seen face after the vertex colour has replaced those that
/// Material::vertexColorUse names.
FaceColors fixedFunctionColors(const Material& material, const Vec4& vertexColor,
                               bool front = true);

/// Returns whether OpenGL takes a side for the front if lighting has two sides.
inline bool isFrontFace(const Material& material, bool counterClockwise)
{
    return counterClockwise != material.clockwise;
}

/// Returns whether Material::culling takes that side of the face away.
bool isCulled(const Material& material, bool front);

/// Returns a lit colour after one texture environment [OpenGL21, table 3.22 and 3.23].
Vec4 applyTextureEnvironment(const TextureTerms::Term& texture, Vec4 lit);

/// Returns a lit colour after all texture units, one after the other.
Vec4 applyTextures(const TextureTerms& textures, Vec4 lit);

} // namespace osgRayTrace::engine
