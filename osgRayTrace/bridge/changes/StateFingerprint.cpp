// StateFingerprint.cpp - which values of OSG's attributes matter. Layer: bridge.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/bridge/changes/StateFingerprint.h"

#include "osgRayTrace/bridge/appearance/textures/TextureConverter.h"
#include "osgRayTrace/bridge/appearance/textures/TextureFormats.h"

#include <osgRayTrace/PhysicalMaterial>

#include <osg/AlphaFunc>
#include <osg/BlendFunc>
#include <osg/ClipPlane>
#include <osg/ColorMask>
#include <osg/CullFace>
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

namespace osgRayTrace::engine
{

namespace
{

void addMaterial(Digest& digest, const osg::Material& material)
{
    digest.add(material.getColorMode());
    for (const auto face : {osg::Material::FRONT, osg::Material::BACK})
        digest.add(material.getAmbient(face), material.getDiffuse(face), material.getSpecular(face),
                   material.getEmission(face), material.getShininess(face));
}

void addPhysicalMaterial(Digest& digest, const PhysicalMaterial& material)
{
    digest.add(material.getBaseColor(), material.getMetallic(), material.getRoughness(),
               material.getTransmission(), material.getIor(), material.getEmission());
    for (const osg::Texture2D* texture :
         {material.getBaseColorTexture(), material.getMetallicRoughnessTexture(),
          material.getTransmissionTexture(), material.getEmissionTexture()})
    {
        digest.addObject(texture);
        if (texture) addTexture(digest, *texture);
    }
}

/// Of the frame, not of the scene; osgViewer has its own in each frame, in a state set of no node.
bool isOfTheFrame(const osg::StateAttribute& attribute, bool ofNode)
{
    return attribute.getType() == osg::StateAttribute::VIEWPORT ||
           (attribute.getType() == osg::StateAttribute::COLORMASK && !ofNode);
}

void addAttribute(Digest& digest, const osg::StateAttribute& attribute)
{
    digest.addObject(&attribute);
    if (const auto* material = dynamic_cast<const osg::Material*>(&attribute))
        addMaterial(digest, *material);
    else if (const osg::Texture* texture = attribute.asTexture())
        addTexture(digest, *texture);
    else if (const auto* physical = dynamic_cast<const PhysicalMaterial*>(&attribute))
        addPhysicalMaterial(digest, *physical);
    else if (const auto* light = dynamic_cast<const osg::Light*>(&attribute))
        addLight(digest, *light);
    else if (const auto* model = dynamic_cast<const osg::LightModel*>(&attribute))
        digest.add(model->getAmbientIntensity(), model->getTwoSided(), model->getLocalViewer(),
                   model->getColorControl());
    else if (const auto* environment = dynamic_cast<const osg::TexEnv*>(&attribute))
        digest.add(environment->getMode(), environment->getColor());
    else if (const auto* textureMatrix = dynamic_cast<const osg::TexMat*>(&attribute))
    {
        digest.addMatrix(textureMatrix->getMatrix());
        digest.add(textureMatrix->getScaleByTextureRectangleSize());
    }
    else if (const auto* alpha = dynamic_cast<const osg::AlphaFunc*>(&attribute))
        digest.add(alpha->getFunction(), alpha->getReferenceValue());
    else if (const auto* blend = dynamic_cast<const osg::BlendFunc*>(&attribute))
        digest.add(blend->getSource(), blend->getDestination());
    else if (const auto* cull = dynamic_cast<const osg::CullFace*>(&attribute))
        digest.add(cull->getMode());
    else if (const auto* polygons = dynamic_cast<const osg::PolygonMode*>(&attribute))
        digest.add(polygons->getMode(osg::PolygonMode::FRONT),
                   polygons->getMode(osg::PolygonMode::BACK));
    else if (const auto* program = dynamic_cast<const osg::Program*>(&attribute))
        digest.add(program->getNumShaders());
    else if (const auto* texGen = dynamic_cast<const osg::TexGen*>(&attribute))
        addTexGen(digest, *texGen);
    else if (const auto* offset = dynamic_cast<const osg::PolygonOffset*>(&attribute))
        digest.add(offset->getFactor(), offset->getUnits());
    else if (const auto* restart = dynamic_cast<const osg::PrimitiveRestartIndex*>(&attribute))
        digest.add(restart->getRestartIndex());
    else if (const auto* plane = dynamic_cast<const osg::ClipPlane*>(&attribute))
        digest.add(plane->getClipPlaneNum(), plane->getClipPlane());
    else if (const auto* front = dynamic_cast<const osg::FrontFace*>(&attribute))
        digest.add(front->getMode());
    else if (const auto* mask = dynamic_cast<const osg::ColorMask*>(&attribute))
        digest.add(mask->getRedMask(), mask->getGreenMask(), mask->getBlueMask());
}

void addAttributes(Digest& digest, const osg::StateSet::AttributeList& attributes, bool ofNode)
{
    for (const auto& item : attributes)
    {
        if (isOfTheFrame(*item.second.first, ofNode)) continue;
        digest.add(item.second.second);
        addAttribute(digest, *item.second.first);
    }
}

void addModes(Digest& digest, const osg::StateSet::ModeList& modes)
{
    for (const auto& [mode, value] : modes)
        digest.add(mode, value);
}

} // namespace

void addImage(Digest& digest, const osg::Image* image)
{
    digest.addObject(image);
    if (!image) return;
    digest.add(image->getModifiedCount());
    digest.addData(image->data());
}

void addTexture(Digest& digest, const osg::Texture& texture)
{
    digest.add(texture.getWrap(osg::Texture::WRAP_S), texture.getWrap(osg::Texture::WRAP_T),
               texture.getFilter(osg::Texture::MAG_FILTER), internalFormatOf(texture, nullptr),
               texture.getInternalFormatMode());
    digest.add(texture.getWrap(osg::Texture::WRAP_R), isOnlyInOpenGL(texture));
    for (int c = 0; c < 4; ++c)
        digest.add(texture.getBorderColor()[c]);
    for (unsigned int i = 0; i < texture.getNumImages(); ++i)
        addImage(digest, texture.getImage(i));
}

void addLight(Digest& digest, const osg::Light& light)
{
    digest.add(light.getLightNum(), light.getAmbient(), light.getDiffuse(), light.getSpecular(),
               light.getPosition(), light.getDirection(), light.getConstantAttenuation(),
               light.getLinearAttenuation(), light.getQuadraticAttenuation(),
               light.getSpotExponent(), light.getSpotCutoff());
}

void addTexGen(Digest& digest, const osg::TexGen& texGen)
{
    digest.add(texGen.getMode());
    for (const auto coordinate : {osg::TexGen::S, osg::TexGen::T, osg::TexGen::R, osg::TexGen::Q})
        for (int k = 0; k < 4; ++k)
            digest.add(texGen.getPlane(coordinate)[k]);
}

void addStateSet(Digest& digest, const osg::StateSet& stateSet)
{
    const bool ofNode = stateSet.getNumParents() > 0;
    addModes(digest, stateSet.getModeList());
    addAttributes(digest, stateSet.getAttributeList(), ofNode);
    for (const auto& modes : stateSet.getTextureModeList())
        addModes(digest, modes);
    for (const auto& attributes : stateSet.getTextureAttributeList())
        addAttributes(digest, attributes, ofNode);
}

} // namespace osgRayTrace::engine
