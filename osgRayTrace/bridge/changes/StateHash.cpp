// StateHash.cpp - selects the values of OSG's attributes that matter. Layer: bridge.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/bridge/changes/StateHash.h"

#include "osgRayTrace/bridge/appearance/lights/LightConverter.h"
#include "osgRayTrace/bridge/appearance/textures/TextureConverter.h"
#include "osgRayTrace/bridge/appearance/textures/TextureFormats.h"

#include <osgRayTrace/PhysicalMaterial>

#include <osg/AlphaFunc>
#include <osg/BlendFunc>
#include <osg/ClipPlane>
#include <osg/ColorMask>
#include <osg/CullFace>
#include <osg/Depth>
#include <osg/Fog>
#include <osg/FrontFace>
#include <osg/LightModel>
#include <osg/Material>
#include <osg/PolygonMode>
#include <osg/PolygonOffset>
#include <osg/PrimitiveRestartIndex>
#include <osg/Program>
#include <osg/TexEnv>
#include <osg/TexMat>
#include <osg/Texture>
#include <osg/UserDataContainer>

#include <cmath>

namespace osgRayTrace::engine
{

namespace
{

void addMaterial(Hasher& hasher, const osg::Material& material)
{
    hasher.add(material.getColorMode());
    for (const auto face : {osg::Material::FRONT, osg::Material::BACK})
        hasher.add(material.getAmbient(face), material.getDiffuse(face), material.getSpecular(face),
                   material.getEmission(face), material.getShininess(face));
}

void addPhysicalMaterial(Hasher& hasher, const PhysicalMaterial& material)
{
    hasher.add(material.getBaseColor(), material.getMetallic(), material.getRoughness(),
               material.getTransmission(), material.getIor(), material.getEmission());
    hasher.add(material.getAlpha(), material.getVertexColors(), material.getNormalScale(),
               material.getThinWalled(), material.getAttenuationColor(),
               material.getAttenuationDistance(), material.getSpecular(),
               material.getSpecularColor(), material.getClearcoat(),
               material.getClearcoatRoughness(), material.getClearcoatNormalScale(),
               material.getSheenColor(), material.getSheenRoughness());
    hasher.add(material.getAnisotropy(), material.getAnisotropyRotation(),
               material.getDiffuseTransmission(), material.getDiffuseTransmissionColor(),
               material.getIridescence(), material.getIridescenceIor(),
               material.getIridescenceThicknessMinimum(), material.getIridescenceThicknessMaximum(),
               material.getSubsurface(), material.getSubsurfaceRadius());
    addMedium(hasher, material.getInterior());
    for (int i = 0; i < PhysicalMaterial::NUMBER_OF_TEXTURES; ++i)
    {
        const auto use = static_cast<PhysicalMaterial::TextureUse>(i);
        const osg::Texture2D* texture = material.getTexture(use);
        hasher.addObject(texture);
        if (!texture) continue;
        addTexture(hasher, *texture);
        const PhysicalMaterial::TexturePlace& place = material.getTexturePlace(use);
        hasher.add(place.unit, place.offset.x(), place.offset.y(), place.rotation, place.scale.x(),
                   place.scale.y());
    }
}

/// Returns whether an attribute belongs to the frame and not to the scene; osgViewer has such
/// attributes in each frame, in a state set of no node.
bool isOfTheFrame(const osg::StateAttribute& attribute, bool ofNode)
{
    return attribute.getType() == osg::StateAttribute::VIEWPORT ||
           (attribute.getType() == osg::StateAttribute::COLORMASK && !ofNode);
}

/// Adds a number that changes by steps of 1/1024 of a value, or of 1.
void addStep(Hasher& hasher, double value)
{
    hasher.add(std::floor(1024.0 * value));
}

/// Adds the values of fog. Colours and densities that drift from frame to frame, as by the time of
/// day, count in steps that nobody sees.
void addFog(Hasher& hasher, const osg::Fog& fog)
{
    hasher.add(fog.getMode(), fog.getStart(), fog.getEnd(), fog.getUseRadialFog(),
               fog.getFogCoordinateSource(), fog.getDensity() > 0.0f);
    if (fog.getDensity() > 0.0f) addStep(hasher, std::log(double(fog.getDensity())));
    for (int c = 0; c < 4; ++c)
        addStep(hasher, fog.getColor()[c]);
}

void addAttribute(Hasher& hasher, const osg::StateAttribute& attribute, bool looks)
{
    hasher.addObject(&attribute);
    const bool isLook = dynamic_cast<const osg::Material*>(&attribute) ||
                        attribute.getType() == osg::StateAttribute::FOG;
    if (isLook && !looks) return;
    if (const auto* material = dynamic_cast<const osg::Material*>(&attribute))
        addMaterial(hasher, *material);
    else if (const osg::Texture* texture = attribute.asTexture())
        addTexture(hasher, *texture);
    else if (const auto* physical = dynamic_cast<const PhysicalMaterial*>(&attribute))
        addPhysicalMaterial(hasher, *physical);
    else if (const auto* light = dynamic_cast<const osg::Light*>(&attribute))
        addLight(hasher, *light);
    else if (const auto* model = dynamic_cast<const osg::LightModel*>(&attribute))
        hasher.add(model->getAmbientIntensity(), model->getTwoSided(), model->getLocalViewer(),
                   model->getColorControl());
    else if (const auto* environment = dynamic_cast<const osg::TexEnv*>(&attribute))
        hasher.add(environment->getMode(), environment->getColor());
    else if (const auto* textureMatrix = dynamic_cast<const osg::TexMat*>(&attribute))
    {
        hasher.addMatrix(textureMatrix->getMatrix());
        hasher.add(textureMatrix->getScaleByTextureRectangleSize());
    }
    else if (const auto* alpha = dynamic_cast<const osg::AlphaFunc*>(&attribute))
        hasher.add(alpha->getFunction(), alpha->getReferenceValue());
    else if (const auto* blend = dynamic_cast<const osg::BlendFunc*>(&attribute))
        hasher.add(blend->getSource(), blend->getDestination());
    else if (const auto* cull = dynamic_cast<const osg::CullFace*>(&attribute))
        hasher.add(cull->getMode());
    else if (const auto* polygons = dynamic_cast<const osg::PolygonMode*>(&attribute))
        hasher.add(polygons->getMode(osg::PolygonMode::FRONT),
                   polygons->getMode(osg::PolygonMode::BACK));
    else if (const auto* program = dynamic_cast<const osg::Program*>(&attribute))
        hasher.add(program->getNumShaders());
    else if (const auto* texGen = dynamic_cast<const osg::TexGen*>(&attribute))
        addTexGen(hasher, *texGen);
    else if (const auto* offset = dynamic_cast<const osg::PolygonOffset*>(&attribute))
        hasher.add(offset->getFactor(), offset->getUnits());
    else if (const auto* restart = dynamic_cast<const osg::PrimitiveRestartIndex*>(&attribute))
        hasher.add(restart->getRestartIndex());
    else if (const auto* plane = dynamic_cast<const osg::ClipPlane*>(&attribute))
        hasher.add(plane->getClipPlaneNum(), plane->getClipPlane());
    else if (const auto* fog = dynamic_cast<const osg::Fog*>(&attribute))
        addFog(hasher, *fog);
    else if (const auto* front = dynamic_cast<const osg::FrontFace*>(&attribute))
        hasher.add(front->getMode());
    else if (const auto* mask = dynamic_cast<const osg::ColorMask*>(&attribute))
        hasher.add(mask->getRedMask(), mask->getGreenMask(), mask->getBlueMask());
    else if (const auto* depth = dynamic_cast<const osg::Depth*>(&attribute))
        hasher.add(depth->getFunction(), depth->getZNear(), depth->getZFar(),
                   depth->getWriteMask());
}

void addAttributes(Hasher& hasher, const osg::StateSet::AttributeList& attributes, bool ofNode,
                   bool looks)
{
    for (const auto& item : attributes)
    {
        if (isOfTheFrame(*item.second.first, ofNode)) continue;
        hasher.add(item.second.second);
        addAttribute(hasher, *item.second.first, looks);
    }
}

void addModes(Hasher& hasher, const osg::StateSet::ModeList& modes)
{
    for (const auto& [mode, value] : modes)
        hasher.add(mode, value);
}

void addUserValues(Hasher& hasher, const osg::UserDataContainer& container)
{
    for (unsigned int i = 0; i < container.getNumUserObjects(); ++i)
    {
        const osg::Object* object = container.getUserObject(i);
        hasher.addObject(object);
        if (!object) continue;
        for (const double value : userValuesOf(*object))
            hasher.add(value);
    }
}

/// Adds what the rules of a material file read of a state set beside its attributes. Programs often
/// get uniforms of the frame, such as its time, which no rule reads: their values are left out.
void addRead(Hasher& hasher, const osg::StateSet& stateSet, const ShaderReads& reads)
{
    for (const auto& [name, pair] : stateSet.getUniformList())
    {
        hasher.addObject(pair.first.get());
        hasher.add(pair.second);
        if (!pair.first || !reads.reads(*pair.first)) continue;
        for (const double value : valuesOf(*pair.first))
            hasher.add(value);
    }
    if (reads.userValues && stateSet.getUserDataContainer())
        addUserValues(hasher, *stateSet.getUserDataContainer());
}

} // namespace

void addMedium(Hasher& hasher, const osgRayTrace::Medium* medium)
{
    hasher.addObject(medium);
    if (!medium) return;
    hasher.add(medium->getAbsorption(), medium->getScattering(), medium->getEmission(),
               medium->getAnisotropy(), medium->getPhase(), medium->getDropletSize(),
               medium->getPriority());
}

void addImage(Hasher& hasher, const osg::Image* image)
{
    hasher.addObject(image);
    if (!image) return;
    hasher.add(image->getModifiedCount());
    hasher.addData(image->data());
}

void addTexture(Hasher& hasher, const osg::Texture& texture)
{
    hasher.add(texture.getWrap(osg::Texture::WRAP_S), texture.getWrap(osg::Texture::WRAP_T),
               texture.getFilter(osg::Texture::MAG_FILTER),
               texture.getFilter(osg::Texture::MIN_FILTER), internalFormatOf(texture, nullptr),
               texture.getInternalFormatMode());
    hasher.add(texture.getWrap(osg::Texture::WRAP_R), isOnlyInOpenGL(texture));
    for (int c = 0; c < 4; ++c)
        hasher.add(texture.getBorderColor()[c]);
    for (unsigned int i = 0; i < texture.getNumImages(); ++i)
        addImage(hasher, texture.getImage(i));
}

void addLight(Hasher& hasher, const osg::Light& light)
{
    hasher.add(light.getLightNum(), light.getAmbient(), light.getDiffuse(), light.getSpecular(),
               light.getPosition(), light.getDirection(), light.getConstantAttenuation(),
               light.getLinearAttenuation(), light.getQuadraticAttenuation(),
               light.getSpotExponent(), light.getSpotCutoff(), rangeOf(light),
               isTracedLight(light));
}

void addTexGen(Hasher& hasher, const osg::TexGen& texGen)
{
    hasher.add(texGen.getMode());
    for (const auto coordinate : {osg::TexGen::S, osg::TexGen::T, osg::TexGen::R, osg::TexGen::Q})
        for (int k = 0; k < 4; ++k)
            hasher.add(texGen.getPlane(coordinate)[k]);
}

void addStateSet(Hasher& hasher, const osg::StateSet& stateSet, const ShaderReads* reads,
                 bool looks)
{
    if (reads) addRead(hasher, stateSet, *reads);
    const bool ofNode = stateSet.getNumParents() > 0;
    if (stateSet.useRenderBinDetails()) hasher.add(stateSet.getBinNumber());
    addModes(hasher, stateSet.getModeList());
    addAttributes(hasher, stateSet.getAttributeList(), ofNode, looks);
    for (const auto& modes : stateSet.getTextureModeList())
        addModes(hasher, modes);
    for (const auto& attributes : stateSet.getTextureAttributeList())
        addAttributes(hasher, attributes, ofNode, looks);
}

} // namespace osgRayTrace::engine
