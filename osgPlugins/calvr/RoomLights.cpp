// RoomLights.cpp - copies of light sources, kept up to date. Layer: plugins.
// SPDX-License-Identifier: MIT
#include "RoomLights.h"

#include <cmath>

namespace osgRayTrace::calvr
{

namespace
{

std::vector<const osg::LightSource*> lightSourcesOf(const osg::Group& room)
{
    std::vector<const osg::LightSource*> sources;
    for (unsigned int i = 0; i < room.getNumChildren(); ++i)
    {
        const auto* source = dynamic_cast<const osg::LightSource*>(room.getChild(i));
        if (source && source->getLight()) sources.push_back(source);
    }
    return sources;
}

/// Copies values alone, so that the copy stays the same object.
void assign(osg::Light& to, const osg::Light& from)
{
    to.setName(from.getName());
    to.setLightNum(from.getLightNum());
    to.setAmbient(from.getAmbient());
    to.setDiffuse(from.getDiffuse());
    to.setSpecular(from.getSpecular());
    to.setPosition(from.getPosition());
    to.setDirection(from.getDirection());
    to.setConstantAttenuation(from.getConstantAttenuation());
    to.setLinearAttenuation(from.getLinearAttenuation());
    to.setQuadraticAttenuation(from.getQuadraticAttenuation());
    to.setSpotExponent(from.getSpotExponent());
    to.setSpotCutoff(from.getSpotCutoff());
}

} // namespace

osg::ref_ptr<osg::Light> placedLight(const osg::Light& light, const osg::Matrixd& hereFromThere)
{
    const osg::ref_ptr<osg::Light> placed = osg::clone(&light);
    placed->setPosition(osg::Vec4(osg::Vec4d(light.getPosition()) * hereFromThere));
    osg::Vec3d direction =
        osg::Matrixd::transform3x3(osg::Vec3d(light.getDirection()), hereFromThere);
    direction.normalize();
    placed->setDirection(osg::Vec3(direction));

    // OpenGL measures the distance in the eye's units, that is in the units of the coordinates
    // there.
    const osg::Matrixd& m = hereFromThere;
    const osg::Vec3d x(m(0, 0), m(0, 1), m(0, 2)), y(m(1, 0), m(1, 1), m(1, 2)),
        z(m(2, 0), m(2, 1), m(2, 2));
    const double scale = std::cbrt(std::abs((x ^ y) * z));
    if (scale > 0.0 && std::isfinite(1.0 / (scale * scale)))
    {
        placed->setLinearAttenuation(static_cast<float>(light.getLinearAttenuation() / scale));
        placed->setQuadraticAttenuation(
            static_cast<float>(light.getQuadraticAttenuation() / (scale * scale)));
    }
    return placed;
}

bool RoomLights::sameSources(const std::vector<const osg::LightSource*>& sources) const
{
    if (sources.size() != _copies.size()) return false;
    for (size_t i = 0; i < sources.size(); ++i)
        if (sources[i] != _copies[i].first) return false;
    return true;
}

void RoomLights::update(const osg::Group& room, const osg::Matrixd& belowFromRoom,
                        osg::Group& below)
{
    const std::vector<const osg::LightSource*> sources = lightSourcesOf(room);
    if (!sameSources(sources))
    {
        clear(below);
        for (const osg::LightSource* source : sources)
        {
            const osg::ref_ptr<osg::LightSource> copy = new osg::LightSource;
            copy->setName(source->getName());
            below.addChild(copy);
            _copies.emplace_back(source, copy);
        }
    }

    for (const auto& [source, copy] : _copies)
    {
        const bool withEye = source->getReferenceFrame() == osg::LightSource::ABSOLUTE_RF;
        const osg::ref_ptr<osg::Light> placed =
            placedLight(*source->getLight(), withEye ? osg::Matrixd() : belowFromRoom);
        if (copy->getReferenceFrame() != source->getReferenceFrame())
            copy->setReferenceFrame(source->getReferenceFrame());
        if (!copy->getLight() || !copy->getLight()->isSameKindAs(placed) ||
            copy->getLight()->getLightNum() != placed->getLightNum())
            copy->setLight(placed);
        else if (copy->getLight()->compare(*placed) != 0)
        {
            assign(*copy->getLight(), *placed);
            copy->dirtyBound();
        }
    }
}

void RoomLights::clear(osg::Group& below)
{
    for (const auto& [source, copy] : _copies)
        below.removeChild(copy);
    _copies.clear();
}

} // namespace osgRayTrace::calvr
