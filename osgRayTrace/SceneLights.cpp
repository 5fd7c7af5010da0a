// SceneLights.cpp - makes the nodes of a sky and a sun. Layer: public API.
// SPDX-License-Identifier: MIT
#include <osgRayTrace/SceneLights>

#include <osgRayTrace/EnvironmentLight>
#include <osgRayTrace/TracedLight>

#include "osgRayTrace/base/NumberText.h"
#include "osgRayTrace/bridge/common/WarnOnce.h"

#include <osg/LightSource>
#include <osg/NodeVisitor>
#include <osgDB/FileNameUtils>
#include <osgDB/ReadFile>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <set>

namespace osgRayTrace
{

namespace
{

constexpr const char* kNames[] = {"environment", "environment-turn", "environment-strength", "sun",
                                  "headlight"};

class FindLightNumbers : public osg::NodeVisitor
{
public:
    FindLightNumbers() : osg::NodeVisitor(TRAVERSE_ALL_CHILDREN) {}

    void apply(osg::LightSource& source) override
    {
        const osg::Light* light = source.getLight();
        if (light && !dynamic_cast<const TracedLight*>(light)) used.insert(light->getLightNum());
        traverse(source);
    }
    using osg::NodeVisitor::apply;

    std::set<int> used;
};

osg::ref_ptr<osg::Node> environmentOf(const SceneLights& lights, osg::Image* image)
{
    osg::ref_ptr<EnvironmentLight> light = new EnvironmentLight(image);
    light->setRotation(
        osg::Quat(osg::DegreesToRadians(lights.turnDegrees), osg::Vec3d(0.0, 0.0, 1.0)));
    const auto strength = static_cast<float>(lights.strength);
    light->setScale(osg::Vec3(strength, strength, strength));
    return light;
}

osg::ref_ptr<osg::LightSource> sunOf(const SceneLights::Sun& sun, int number)
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

/// Returns a finite number; nothing if the text is none.
std::optional<double> finiteFrom(const std::string& text)
{
    const auto number = engine::parseNumber<double>(text);
    return number && std::isfinite(*number) ? number : std::nullopt;
}

std::optional<SceneLights::Sun> sunFrom(const std::string& text)
{
    const std::size_t colon = text.find(':');
    if (colon == std::string::npos) return std::nullopt;
    const auto azimuth = finiteFrom(text.substr(0, colon));
    const auto elevation = finiteFrom(text.substr(colon + 1));
    if (!azimuth || !elevation || std::abs(*elevation) > 90.0) return std::nullopt;
    return SceneLights::Sun{*azimuth, *elevation};
}

/// Returns the variable of a name: "OSGRAYTRACE_ENVIRONMENT_TURN".
std::string variableOf(const std::string& name)
{
    std::string variable = "OSGRAYTRACE_" + name;
    for (char& c : variable)
        c = c == '-' ? '_' : c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
    return variable;
}

} // namespace

bool SceneLights::knows(const std::string& name)
{
    return std::find(std::begin(kNames), std::end(kNames), name) != std::end(kNames);
}

bool SceneLights::set(const std::string& name, const std::string& value)
{
    const std::optional<double> number = finiteFrom(value);
    const std::optional<Sun> asSun = sunFrom(value);
    const bool isGood = name == "environment"            ? !value.empty()
                        : name == "environment-turn"     ? number.has_value()
                        : name == "environment-strength" ? number && *number > 0.0
                        : name == "sun"                  ? asSun.has_value()
                        : name == "headlight"            ? value == "on" || value == "off"
                                                         : false;
    if (!isGood) return false;
    if (name == "environment") environment = value;
    if (name == "environment-turn") turnDegrees = *number;
    if (name == "environment-strength") strength = *number;
    if (name == "sun") sun = asSun;
    if (name == "headlight") headlight = value == "on";
    return true;
}

void SceneLights::readVariables()
{
    for (const char* name : kNames)
    {
        const std::string variable = variableOf(name);
        const char* value = std::getenv(variable.c_str());
        if (value && *value && !set(name, value))
            engine::warnOnce(variable + " cannot be '" + value + "'");
    }
}

void SceneLights::readVariables(int argc, const char* const* argv)
{
    const auto isOfLoader = [](const char* word)
    { return osgDB::getLowerCaseFileExtension(word) == "raytrace"; };
    if (std::none_of(argv, argv + argc, isOfLoader)) readVariables();
}

std::string SceneLights::addTo(osg::Group& scene) const
{
    osg::ref_ptr<osg::Image> image;
    if (!environment.empty()) image = osgDB::readRefImageFile(environment);
    if (!environment.empty() && !image) return "cannot load " + environment + ": it is no image";
    FindLightNumbers find;
    scene.accept(find);
    int number = 0;
    while (find.used.count(number) > 0)
        ++number;
    if (!hasHeadlight() && find.used.count(0) == 0)
        scene.getOrCreateStateSet()->setMode(GL_LIGHT0, osg::StateAttribute::OFF);
    if (sun)
    {
        scene.addChild(sunOf(*sun, number));
        scene.getOrCreateStateSet()->setMode(static_cast<GLenum>(GL_LIGHT0 + number),
                                             osg::StateAttribute::ON);
    }
    if (image) scene.addChild(environmentOf(*this, image.get()));
    return "";
}

} // namespace osgRayTrace
