// AddedLights.cpp - makes the nodes of a sky and a sun. Layer: apps.
// SPDX-License-Identifier: MIT
#include "AddedLights.h"

#include "Failure.h"

#include <osgRayTrace/EnvironmentLight>

#include <osg/Group>
#include <osg/LightSource>
#include <osg/NodeVisitor>
#include <osgDB/ReadFile>

#include <cmath>
#include <set>

namespace osgRayTrace::app
{

namespace
{

class FindLightNumbers : public osg::NodeVisitor
{
public:
    FindLightNumbers() : osg::NodeVisitor(TRAVERSE_ALL_CHILDREN) {}

    void apply(osg::LightSource& source) override
    {
        if (source.getLight()) used.insert(source.getLight()->getLightNum());
        traverse(source);
    }
    using osg::NodeVisitor::apply;

    std::set<int> used;
};

int freeLightNumber(osg::Node& scene)
{
    FindLightNumbers find;
    scene.accept(find);
    int number = 0;
    while (find.used.count(number) > 0)
        ++number;
    return number;
}

osg::ref_ptr<osg::Node> environmentOf(const AddedLights& lights)
{
    const osg::ref_ptr<osg::Image> image = osgDB::readRefImageFile(lights.environment);
    if (!image)
        throw Failure(kCannotLoad, "cannot load " + lights.environment + ": it is no image");
    osg::ref_ptr<EnvironmentLight> light = new EnvironmentLight(image.get());
    light->setRotation(
        osg::Quat(osg::DegreesToRadians(lights.turnDegrees), osg::Vec3d(0.0, 0.0, 1.0)));
    const auto strength = static_cast<float>(lights.strength);
    light->setScale(osg::Vec3(strength, strength, strength));
    return light;
}

osg::ref_ptr<osg::LightSource> sunOf(const Sun& sun, int number)
{
    const double azimuth = osg::DegreesToRadians(sun.azimuthDegrees);
    const double elevation = osg::DegreesToRadians(sun.elevationDegrees);
    const double level = std::cos(elevation);
    osg::ref_ptr<osg::Light> light = new osg::Light(static_cast<unsigned int>(number));
    light->setName("sun");
    light->setPosition(
        osg::Vec4d(level * std::sin(azimuth), level * std::cos(azimuth), std::sin(elevation), 0.0));
    light->setAmbient(osg::Vec4(0.0f, 0.0f, 0.0f, 1.0f));
    light->setDiffuse(osg::Vec4(1.0f, 1.0f, 1.0f, 1.0f));
    light->setSpecular(osg::Vec4(1.0f, 1.0f, 1.0f, 1.0f));
    osg::ref_ptr<osg::LightSource> source = new osg::LightSource;
    source->setLight(light.get());
    return source;
}

} // namespace

osg::ref_ptr<osg::Node> withLights(const osg::ref_ptr<osg::Node>& scene, const AddedLights& lights)
{
    if (!lights.any()) return scene;
    osg::ref_ptr<osg::Group> group = new osg::Group;
    if (!lights.environment.empty()) group->addChild(environmentOf(lights));
    if (lights.sun)
    {
        const int number = freeLightNumber(*scene);
        group->addChild(sunOf(*lights.sun, number));
        group->getOrCreateStateSet()->setMode(static_cast<GLenum>(GL_LIGHT0 + number),
                                              osg::StateAttribute::ON);
    }
    group->addChild(scene);
    return group;
}

} // namespace osgRayTrace::app
