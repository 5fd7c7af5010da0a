// Material.h - how a surface reflects and emits: physical and fixed-function model. Layer: scene.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/base/Math.h"
#include "osgRayTrace/scene/Fog.h"
#include "osgRayTrace/scene/Medium.h"
#include "osgRayTrace/scene/Mesh.h"
#include "osgRayTrace/scene/TextureMapping.h"

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace osgRayTrace::engine
{

enum class MaterialModel : uint8_t
{
    FixedFunction, ///< OpenGL's model: ambient, diffuse, specular, shininess
    Physical,      ///< glTF 2.0's model: base colour, metallic, roughness; and transmission, ior
};

/// Tells which colour the vertex colour replaces (osg::Material::ColorMode; AmbientAndDiffuse
/// without an osg::Material).
enum class VertexColorUse : uint8_t
{
    None,
    Ambient,
    Diffuse,
    Specular,
    Emission,
    AmbientAndDiffuse,
};

/// Tells how a texture unit changes the colour that comes from lighting or from the unit before.
enum class TextureEnvironment : uint8_t
{
    Modulate,
    Replace,
    Decal,
    Blend,
    Add,
};

/// Holds texture unit 1, which is applied to the result of unit 0.
struct SecondTexture
{
    uint32_t texture = kInvalid;
    TextureEnvironment environment = TextureEnvironment::Modulate;
    Vec4 environmentColor{0.0f};
    TextureMapping mapping;
};

/// Tells by which comparison with a reference an alpha passes.
enum class AlphaTest : uint8_t
{
    Never,
    Less,
    Equal,
    LessOrEqual,
    Greater,
    NotEqual,
    GreaterOrEqual,
    Always,
};

/// Tells which faces camera rays pass by. Shadow, mirror and light rays meet culled faces all the
/// same, unless Material::cullsAllRays says otherwise: a room whose walls are culled so that one
/// can look in stays a closed room.
enum class FaceCulling : uint8_t
{
    None,
    Back,
    Front,
    FrontAndBack,
};

/// Holds the colours of the face that the lights see.
struct FaceColors
{
    Vec3 ambient{0.2f};
    Vec3 diffuse{0.8f};
    Vec3 specular{0.0f};
    Vec3 emission{0.0f};
    float shininess = 0.0f;
    float alpha = 1.0f;
};

/// Names the textures of a physical material, in the order of PhysicalMaterial::TextureUse.
enum TextureRole : uint32_t
{
    kBaseColorRole,
    kMetallicRoughnessRole,
    kTransmissionRole,
    kEmissionRole,
    kNormalRole,              ///< 2 RGB - 1 along s, along t and the normal; linear
    kSpecularRole,            ///< specular in A; linear
    kSpecularColorRole,       ///< multiplies specularColor
    kClearcoatRole,           ///< clearcoat in R; linear
    kClearcoatRoughnessRole,  ///< clearcoatRoughness in G; linear
    kSheenColorRole,          ///< multiplies sheenColor
    kSheenRoughnessRole,      ///< sheenRoughness in A; linear
    kAnisotropyRole,          ///< 2 RG - 1 along tangent and bitangent, anisotropy in B; linear
    kDiffuseTransmissionRole, ///< diffuseTransmission in A; linear
    kDiffuseTransmissionColorRole, ///< multiplies diffuseTransmissionColor
    kIridescenceRole,              ///< iridescence in R; linear
    kIridescenceThicknessRole,     ///< from the least to the largest thickness in G; linear
    kClearcoatNormalRole,          ///< as kNormalRole, of the clear coat
    kSubsurfaceRole,               ///< subsurface in R; linear
    kSubsurfaceRadiusRole,         ///< multiplies subsurfaceRadius; linear
    kTextureRoles,
};

/// Tells where a physical texture is looked up: at offset + u x + v y for coordinates (x, y).
struct TexturePlace
{
    uint32_t set = 0; ///< below kUvSets: see uvsOfSet
    Vec2 u{1.0f, 0.0f}, v{0.0f, 1.0f}, offset{0.0f};
};

/// Holds the parameters of a physical material that most surfaces do not have.
struct MaterialDetail
{
    bool vertexColors = false; ///< base colour and alpha are multiplied with Mesh::colors
    bool thinWalled = false;   ///< light passes without being bent: KHR_materials_transmission
    Medium interior;           ///< fills the body that the surface encloses
    float specular = 1.0f;     ///< KHR_materials_specular
    Vec3 specularColor{1.0f};
    float clearcoat = 0.0f; ///< KHR_materials_clearcoat
    float clearcoatRoughness = 0.0f;
    float clearcoatNormalScale = 1.0f;
    Vec3 sheenColor{0.0f}; ///< KHR_materials_sheen
    float sheenRoughness = 0.0f;
    float anisotropy = 0.0f;          ///< KHR_materials_anisotropy
    float anisotropyRotation = 0.0f;  ///< [radians] from the tangent to the bitangent
    float diffuseTransmission = 0.0f; ///< KHR_materials_diffuse_transmission
    Vec3 diffuseTransmissionColor{1.0f};
    float iridescence = 0.0f; ///< KHR_materials_iridescence
    float iridescenceIor = 1.3f;
    Vec2 iridescenceThickness{100.0f, 400.0f}; ///< [nm] where the texture is 0 and 1
    float normalScale = 1.0f;
    float subsurface = 0.0f;     ///< share of the diffuse base whose light enters the body
    Vec3 subsurfaceRadius{1.0f}; ///< mean way between collisions below it [length of the scene]

    /// Textures by role, indices into Scene::textures or kInvalid. Those of the first four roles
    /// are members of Material.
    std::array<uint32_t, kTextureRoles> textures = noTextures();
    std::array<TexturePlace, kTextureRoles> places;

    static constexpr std::array<uint32_t, kTextureRoles> noTextures()
    {
        std::array<uint32_t, kTextureRoles> none{};
        for (uint32_t& texture : none)
            texture = kInvalid;
        return none;
    }

    bool absorbs() const { return !thinWalled && interior.absorbs(); }
    bool fillsBody() const { return !thinWalled && !interior.isClear(); }
};

/// All colours are linear if the scene is, and display-referred otherwise (Scene::displayReferred).
struct Material
{
    std::string name;
    MaterialModel model = MaterialModel::FixedFunction;

    // Fixed function [OpenGL21, eq. 2.1-2.4]: MaterialTable makes the physical equivalent of these
    // members.
    Vec3 ambient{0.2f};
    Vec3 diffuse{0.8f};
    Vec3 specular{0.0f};
    float shininess = 0.0f;           ///< 0 to 128
    bool lit = true;                  ///< GL_LIGHTING; false: the colour is shown as it is
    bool twoSidedLighting = false;    ///< the normal is turned to the viewer before lighting
    uint32_t lightMask = 0xffffffffu; ///< bit n: osg::Light number n is enabled here
    std::vector<uint32_t>
        moreLights; ///< bit n of word k: number 32 (k + 1) + n; the last word is not 0
    VertexColorUse vertexColorUse = VertexColorUse::None;
    TextureEnvironment textureEnvironment = TextureEnvironment::Modulate; ///< unit 0
    Vec4 environmentColor{0.0f}; ///< for TextureEnvironment::Blend
    TextureMapping mapping;      ///< unit 0
    SecondTexture second;
    bool separateSpecular = false; ///< true: highlights are added after the textures
    bool localViewer = false; ///< true: highlights look to the viewer's place, not along its axis
    bool hasBack = false;     ///< true: two-sided lighting with other colours on the back
    FaceColors back;

    // The members of the physical model are defined in [glTF20, sect. 3.9] and in
    // KHR_materials_transmission and KHR_materials_ior.
    Vec3 baseColor{1.0f};
    float metallic = 0.0f;
    float roughness = 1.0f;    ///< perceptual; alpha = roughness^2
    float transmission = 0.0f; ///< share of the dielectric base that is clear
    float ior = 1.5f;

    std::shared_ptr<const MaterialDetail> detail; ///< null: the defaults

    Vec3 emission{0.0f}; ///< Physical: radiance [W/(m^2 sr)]; FixedFunction: GL emission

    // MaterialTable::opacity tells how these members make the surface's opacity.
    float alpha = 1.0f;
    bool blended = false; ///< true: alpha is the opacity; false: alpha is only tested
    AlphaTest alphaTest = AlphaTest::Always;
    float alphaReference = 0.0f;
    FaceCulling culling = FaceCulling::None;
    bool cullsAllRays =
        false; ///< all rays from the eye pass them by the culled side; light the other way
    bool clockwise = false; ///< true: OpenGL's front is the mesh's clockwise side
    Fog fog;

    // Textures are indices into Scene::textures or kInvalid.
    uint32_t baseColorTexture = kInvalid; ///< FixedFunction: unit 0; Physical: multiplies baseColor
    uint32_t metallicRoughnessTexture = kInvalid; ///< glTF: roughness in G, metallic in B; linear
    uint32_t transmissionTexture = kInvalid;      ///< transmission in R; linear
    uint32_t emissionTexture = kInvalid;          ///< multiplies emission

    Stamp changed = 0;
};

/// Returns the texture of a role, kInvalid if there is none.
inline uint32_t textureOf(const Material& m, TextureRole role)
{
    switch (role)
    {
    case kBaseColorRole:
        return m.baseColorTexture;
    case kMetallicRoughnessRole:
        return m.metallicRoughnessTexture;
    case kTransmissionRole:
        return m.transmissionTexture;
    case kEmissionRole:
        return m.emissionTexture;
    default:
        return m.detail ? m.detail->textures[role] : kInvalid;
    }
}

/// Returns the set of texture coordinates that decides on the emission.
inline uint32_t emissionUvSet(const Material& m)
{
    return m.detail ? m.detail->places[kEmissionRole].set : 0;
}

/// Returns whether the textures of a role are normal maps.
inline bool isNormalRole(uint32_t role)
{
    return role == kNormalRole || role == kClearcoatNormalRole;
}

/// Returns whether some texture of the material decides on colours or lobes.
inline bool isTextured(const Material& m)
{
    if (m.second.texture != kInvalid) return true;
    for (uint32_t role = 0; role < kTextureRoles; ++role)
        if (!isNormalRole(role) && textureOf(m, static_cast<TextureRole>(role)) != kInvalid)
            return true;
    return false;
}

/// Returns whether a texture decides on the shading normals.
inline bool hasNormalMap(const Material& m)
{
    return m.detail && m.detail->textures[kNormalRole] != kInvalid && m.detail->normalScale != 0.0f;
}

/// Returns whether the clear coat has other normals than the surface below it: those of its own
/// map, or those of the mesh over a base with a normal map. The coat of a thin wall has the wall's.
inline bool hasCoatNormals(const Material& m)
{
    if (!m.detail || !(m.detail->clearcoat > 0.0f)) return false;
    if (m.detail->thinWalled && m.transmission > 0.0f) return false;
    const bool own = m.detail->textures[kClearcoatNormalRole] != kInvalid &&
                     m.detail->clearcoatNormalScale != 0.0f;
    return own || hasNormalMap(m);
}

/// The number of a light that no mode switches: it is enabled everywhere.
constexpr uint32_t kNoLightNumber = kInvalid;

/// Returns whether the osg::Light of a number is enabled on the surface.
inline bool isLightEnabled(const Material& m, uint32_t number)
{
    if (number < 32) return (m.lightMask >> number & 1u) != 0;
    if (number == kNoLightNumber) return true;
    const std::size_t word = number / 32 - 1;
    return word < m.moreLights.size() && (m.moreLights[word] >> number % 32 & 1u) != 0;
}

/// Returns 1 for an index that is so close to 1 that its refraction cannot be seen and its
/// microfacet normals drown in rounding, else the index.
inline float usableIor(float ior)
{
    return ior > 1.0f - 1e-4f && ior < 1.0f + 1e-4f ? 1.0f : ior;
}

/// Returns true if light passes the surface as if nothing were there, for all that is known without
/// its textures. Such a surface is not traced: rays towards lights without area would have to be
/// bent by nothing.
inline bool isInvisible(const Material& m)
{
    return m.model == MaterialModel::Physical && m.transmission >= 1.0f && m.metallic <= 0.0f &&
           usableIor(m.ior) == 1.0f && m.baseColor == Vec3(1.0f) && m.emission == Vec3(0.0f) &&
           m.baseColorTexture == kInvalid && m.transmissionTexture == kInvalid && !m.detail;
}

/// Returns true if all of a physical surface is metal; texels may be none, whatever the factor.
inline bool isMetal(const Material& m)
{
    return m.metallic >= 1.0f && m.metallicRoughnessTexture == kInvalid;
}

/// Returns true if the surface is nothing but the boundary of a medium: light passes it unbent, and
/// shadow rays are not blocked.
inline bool isInterface(const Material& m)
{
    if (m.model != MaterialModel::Physical || !m.detail || !m.detail->fillsBody()) return false;
    const MaterialDetail& d = *m.detail;
    return m.transmission >= 1.0f && m.metallic <= 0.0f && usableIor(m.ior) == 1.0f &&
           m.baseColor == Vec3(1.0f) && m.emission == Vec3(0.0f) && !m.blended &&
           m.alphaTest == AlphaTest::Always && m.baseColorTexture == kInvalid &&
           m.transmissionTexture == kInvalid && !d.vertexColors && d.clearcoat <= 0.0f &&
           d.sheenColor == Vec3(0.0f) && d.diffuseTransmission <= 0.0f && d.iridescence <= 0.0f;
}

/// Returns true if light enters the body below a diffuse boundary of the surface: see
/// SubsurfaceWalk.h.
inline bool hasSubsurface(const Material& m)
{
    if (m.model != MaterialModel::Physical || !m.detail || m.detail->thinWalled) return false;
    return m.detail->subsurface > 0.0f && m.detail->subsurfaceRadius != Vec3(0.0f) && !isMetal(m) &&
           (m.transmission < 1.0f || m.transmissionTexture != kInvalid) &&
           m.baseColor != Vec3(0.0f);
}

/// Returns true if camera rays pass both sides of the surface, which other rays meet.
inline bool isHiddenFromCamera(const Material& m)
{
    return m.culling == FaceCulling::FrontAndBack && !m.cullsAllRays;
}

enum class TextureWrap : uint8_t
{
    Repeat,
    ClampToEdge,
    Mirror,
    Clamp, ///< OpenGL's first clamping: half of the filter's last step is border
    ClampToBorder,
};

/// Holds a decoded image in RGBA, row 0 at the bottom. Exactly one of the arrays bytes and floats
/// is filled.
struct Texture
{
    std::string name;
    int width = 0;
    int depth = 0;        ///< slices of a 3-D image, one after the other; 0: a 2-D image
    int height = 0;       ///< for a cube map 6*width: its faces in OpenGL's order, +x at the bottom
    bool cube = false;    ///< true: looked up by a direction; wrap modes do not matter
    bool hasColor = true; ///< false: alpha only, colours pass unchanged
    bool hasAlpha = true; ///< false: alpha passes unchanged
    bool opaque = false;  ///< true: all alpha is 1
    Vec4 border{0.0f};    ///< in the texture's own encoding
    std::vector<uint8_t> bytes; ///< width*height*4 for each slice
    std::vector<float> floats;  ///< width*height*4 for each slice, always linear
    bool decodeSrgb = false;    ///< bytes only: RGB is sRGB encoded and has to be decoded to linear
    bool linearFilter = true;   ///< false: nearest
    TextureWrap wrapS = TextureWrap::Repeat;
    TextureWrap wrapT = TextureWrap::Repeat;
    TextureWrap wrapR = TextureWrap::Repeat; ///< 3-D images only
    /// The image in half the width and height, in a quarter, and so on down to one texel, with the
    /// filter of minified images; empty: footprints are not filtered. Only of 2-D images.
    std::vector<Texture> mips;
    bool blendsMips = true; ///< false: a look-up reads one of the mips alone
    Stamp changed = 0;
};

} // namespace osgRayTrace::engine
