// TextureUnits.cpp - converts texture environments, matrices and generated coordinates. Layer:
// bridge.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/bridge/appearance/textures/TextureUnits.h"

#include <osg/TexEnv>
#include <osg/TexEnvCombine>
#include <osg/TexMat>

#include <cmath>

namespace osgRayTrace::engine
{

namespace
{

/// Returns the enabled texture of a unit, by OpenGL's order of precedence; null: none is enabled.
const osg::Texture* enabledTexture(const GraphState& state, unsigned int unit)
{
    const auto* texture = state.attribute<osg::Texture>(unit, kTextureSlot);
    if (!texture) return nullptr;
    switch (texture->getTextureTarget())
    {
    case GL_TEXTURE_1D:
        return state.isOn(unit, kTexture1DBit) ? texture : nullptr;
    case GL_TEXTURE_2D:
        return state.isOn(unit, kTexture2DBit) ? texture : nullptr;
    case GL_TEXTURE_3D:
        return state.isOn(unit, kTexture3DBit) ? texture : nullptr;
    case GL_TEXTURE_CUBE_MAP:
        return state.isOn(unit, kCubeMapBit) ? texture : nullptr;
    case GL_TEXTURE_RECTANGLE:
        return state.isOn(unit, kRectangleBit) ? texture : nullptr;
    default:
        return nullptr;
    }
}

TextureEnvironment environmentOf(osg::TexEnv::Mode mode)
{
    switch (mode)
    {
    case osg::TexEnv::REPLACE:
        return TextureEnvironment::Replace;
    case osg::TexEnv::DECAL:
        return TextureEnvironment::Decal;
    case osg::TexEnv::BLEND:
        return TextureEnvironment::Blend;
    case osg::TexEnv::ADD:
        return TextureEnvironment::Add;
    default:
        return TextureEnvironment::Modulate;
    }
}

/// Converts a matrix. Each library stores the transposed matrix of the other's convention, so the
/// numbers stand in the same places.
Mat4 toMat4(const osg::Matrixd& m)
{
    Mat4 result;
    for (int i = 0; i < 4; ++i)
        for (int k = 0; k < 4; ++k)
            result[i][k] = static_cast<float>(m(i, k));
    return result;
}

/// Returns planes of the place's local space as a matrix for points of engine space.
osg::Matrixd linearGeneration(const osg::TexGen& source, const osg::Matrixd& engineFromLocal)
{
    osg::Matrixd planes;
    const osg::TexGen::Coord coordinates[] = {osg::TexGen::S, osg::TexGen::T, osg::TexGen::R,
                                              osg::TexGen::Q};
    for (int i = 0; i < 4; ++i)
        for (int k = 0; k < 4; ++k)
            planes(k, i) = source.getPlane(coordinates[i])[k];
    return osg::Matrixd::inverse(engineFromLocal) * planes;
}

/// Returns the matrix of a texture generation. Eye linear planes are taken to eye space by the
/// modelview matrix of their place, and vertices by the matrix of theirs: the view cancels out
/// [OpenGL21, sect. 2.11.4]. Both linear kinds are therefore planes of a place in the scene.
osg::Matrixd generation(const osg::TexGen& source, const osg::Matrixd& engineFromPlanes,
                        TextureMapping& mapping)
{
    switch (source.getMode())
    {
    case osg::TexGen::OBJECT_LINEAR:
    case osg::TexGen::EYE_LINEAR:
        mapping.coordinates = TextureCoordinates::Position;
        return linearGeneration(source, engineFromPlanes);
    case osg::TexGen::SPHERE_MAP:
        mapping.coordinates = TextureCoordinates::SphereMap;
        break;
    case osg::TexGen::REFLECTION_MAP:
        mapping.coordinates = TextureCoordinates::ReflectionMap;
        break;
    case osg::TexGen::NORMAL_MAP:
        mapping.coordinates = TextureCoordinates::NormalMap;
        break;
    }
    return osg::Matrixd();
}

class UnitConverter
{
public:
    UnitConverter(const GraphState& state, unsigned int unit, const SurfacePlacement& placement)
        : _state(state), _unit(unit), _placement(placement)
    {
    }

    /// Sets the way to the coordinates. Returns false if generated coordinates are enabled and no
    /// texture generation is set. A geometry without coordinates has those that OpenGL begins with,
    /// (0, 0, 0, 1), at all vertices: a mesh without coordinates is equivalent.
    bool setMapping(const osg::Texture& texture, TextureMapping& mapping) const
    {
        osg::Matrixd matrix, own;
        mapping.own = _unit == 0 ? TextureCoordinates::Uv0 : TextureCoordinates::Uv1;
        mapping.coordinates = mapping.own;
        if (_state.generated[_unit] != 0)
        {
            const auto* set = _state.attribute<osg::TexGen>(_unit, kTexGenSlot);
            if (set)
                matrix = generation(*set, _placement.engineFromLocal, mapping);
            else if (_placement.texGens && (*_placement.texGens)[_unit].texGen)
                matrix = placedGeneration((*_placement.texGens)[_unit], mapping);
            else
                return false;
            mapping.partly = keepGenerated(texture, matrix, own);
        }

        osg::Matrixd after;
        const auto* transform = _state.attribute<osg::TexMat>(_unit, kTextureMatrixSlot);
        if (transform) after = transform->getMatrix();
        const osg::Image* image = texture.getImage(0);
        if (texture.getTextureTarget() == GL_TEXTURE_RECTANGLE && image && image->s() > 0 &&
            image->t() > 0)
        {
            // OSG scales the coordinates, and so takes the matrix for one of texels.
            if (transform && transform->getScaleByTextureRectangleSize())
                after.preMultScale(osg::Vec3d(image->s(), image->t(), 1.0));
            after.postMultScale(osg::Vec3d(1.0 / image->s(), 1.0 / image->t(), 1.0));
        }
        matrix.postMult(after);
        if (!matrix.valid()) return false;
        mapping.transformed = mapping.partly || !matrix.isIdentity();
        mapping.matrix = toMat4(matrix);
        if (mapping.partly) mapping.ownMatrix = toMat4(own * after);
        return true;
    }

private:
    /// Moves the coordinates that are not generated from matrix to own, which is applied to the
    /// mesh's coordinates. Returns false if all coordinates that the texture uses are generated. q
    /// is 1 if it is not generated.
    bool keepGenerated(const osg::Texture& texture, osg::Matrixd& matrix, osg::Matrixd& own) const
    {
        const GLenum target = texture.getTextureTarget();
        const bool usesThree = target == GL_TEXTURE_3D || target == GL_TEXTURE_CUBE_MAP;
        const unsigned int used = target == GL_TEXTURE_1D ? 1 : usesThree ? 3 : 2;
        bool partly = false;
        own.makeScale(0.0, 0.0, 0.0);
        own(3, 3) = 0.0;
        for (unsigned int c = 0; c < kTextureCoordinates; ++c)
        {
            const bool isQ = c + 1 == kTextureCoordinates;
            if (_state.generates(_unit, c) || (!isQ && c >= used)) continue;
            const int column = static_cast<int>(c);
            for (int k = 0; k < 4; ++k)
                matrix(k, column) = isQ && k == 3 ? 1.0 : 0.0;
            if (isQ) continue;
            own(column, column) = 1.0;
            partly = true;
        }
        return partly;
    }

    /// Returns the matrix of a placed texture generation. Object linear planes belong to the
    /// object, whichever node set them.
    osg::Matrixd placedGeneration(const PlacedTexGen& placed, TextureMapping& mapping) const
    {
        const bool ofObject = placed.texGen->getMode() == osg::TexGen::OBJECT_LINEAR;
        return generation(*placed.texGen,
                          ofObject ? _placement.engineFromLocal : placed.engineFromLocal, mapping);
    }

    const GraphState& _state;
    unsigned int _unit;
    const SurfacePlacement& _placement;
};

void setEnvironment(const GraphState& state, unsigned int unit, TextureEnvironment& environment,
                    Vec4& color, ConversionReport& report)
{
    if (state.attribute<osg::TexEnvCombine>(unit, kTextureEnvironmentSlot))
        report.count("approximated.texture-environment");
    const auto* source = state.attribute<osg::TexEnv>(unit, kTextureEnvironmentSlot);
    if (!source) return;
    environment = environmentOf(source->getMode());
    for (int c = 0; c < 4; ++c)
        color[c] = std::isfinite(source->getColor()[c]) ? source->getColor()[c] : 0.0f;
}

} // namespace

bool looksIntoOpenGL(const GraphState& state, const TextureConverter& textures)
{
    for (unsigned int unit = 0; unit < kUnits; ++unit)
    {
        const osg::Texture* texture = enabledTexture(state, unit);
        if (texture && isOnlyInOpenGL(*texture) && !textures.knows(*texture)) return true;
    }
    return false;
}

bool combinesTextures(const GraphState& state)
{
    for (unsigned int unit = 0; unit < kUnits; ++unit)
        if (enabledTexture(state, unit) &&
            state.attribute<osg::TexEnvCombine>(unit, kTextureEnvironmentSlot))
            return true;
    return false;
}

void applyTextureUnits(Material& material, const GraphState& state,
                       const SurfacePlacement& placement, TextureConverter& textures,
                       ConversionReport& report)
{
    uint32_t* const indices[kUnits] = {&material.baseColorTexture, &material.second.texture};
    TextureMapping* const mappings[kUnits] = {&material.mapping, &material.second.mapping};
    TextureEnvironment* const environments[kUnits] = {&material.textureEnvironment,
                                                      &material.second.environment};
    Vec4* const colors[kUnits] = {&material.environmentColor, &material.second.environmentColor};
    for (unsigned int unit = 0; unit < kUnits; ++unit)
    {
        const osg::Texture* texture = enabledTexture(state, unit);
        if (!texture) continue;
        TextureMapping mapping;
        if (!UnitConverter(state, unit, placement).setMapping(*texture, mapping))
        {
            report.count("approximated.no-texture-coordinates");
            continue;
        }
        *indices[unit] = textures.index(texture, TextureContent::Color, report);
        *mappings[unit] = mapping;
        setEnvironment(state, unit, *environments[unit], *colors[unit], report);
    }
}

} // namespace osgRayTrace::engine
