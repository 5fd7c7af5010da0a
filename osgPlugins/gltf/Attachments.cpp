// Attachments.cpp - reads cameras and punctual lights. Layer: osgPlugins.
// SPDX-License-Identifier: MIT
#include "osgPlugins/gltf/Attachments.h"

#include <osgRayTrace/TracedLight>

#include <osg/Light>
#include <osg/Math>
#include <osg/ValueObject>

#include <algorithm>
#include <cmath>

namespace osgRayTrace::gltf
{

namespace
{

constexpr double kNoFarPlane = 1e6; ///< near planes from which a far plane at infinity is

osg::Matrixd perspectiveOf(const JsonPlace& place)
{
    const double yfov = place.at("yfov").number();
    if (!(yfov > 0.0 && yfov < osg::PI)) place.at("yfov").refuse("is not between 0 and pi");
    const double near = place.at("znear").number();
    if (!(near > 0.0)) place.at("znear").refuse("is not above 0");
    const double far = std::max<double>(place.numberOr("zfar", 0.0f), 0.0);
    const double aspect = place.numberOr("aspectRatio", 1.0f);
    if (!(aspect > 0.0)) place.at("aspectRatio").refuse("is not above 0");
    return osg::Matrixd::perspective(osg::RadiansToDegrees(yfov), aspect, near,
                                     far > near ? far : near * kNoFarPlane);
}

osg::Matrixd orthographicOf(const JsonPlace& place)
{
    const double x = place.at("xmag").number(), y = place.at("ymag").number();
    const double near = place.at("znear").number(), far = place.at("zfar").number();
    if (x == 0.0 || y == 0.0 || !(far > near)) place.refuse("has no extent");
    return osg::Matrixd::ortho(-x, x, -y, y, near, far);
}

/// Returns the exponent with which OpenGL's spot is half as bright as on its axis where glTF's is.
float spotExponent(double inner, double outer)
{
    const double cosInner = std::cos(inner), cosOuter = std::cos(outer);
    const double cosHalf = cosOuter + std::sqrt(0.5) * (cosInner - cosOuter);
    if (!(cosHalf > 0.0 && cosHalf < 1.0)) return 0.0f;
    return static_cast<float>(std::clamp(std::log(0.5) / std::log(cosHalf), 0.0, 128.0));
}

void setSpot(const JsonPlace& light, osg::Light& target)
{
    const auto spot = light.find("spot").value_or(JsonPlace::empty());
    const double outer = spot.numberOr("outerConeAngle", static_cast<float>(osg::PI_4));
    const double inner = spot.numberOr("innerConeAngle", 0.0f);
    if (!(inner >= 0.0 && inner <= outer && outer <= osg::PI_2 + 1e-6))
        spot.refuse("has cone angles that are not 0 <= inner <= outer <= pi / 2");
    target.setSpotCutoff(static_cast<float>(std::min(osg::RadiansToDegrees(outer), 90.0)));
    target.setSpotExponent(spotExponent(inner, outer));
}

/// Sets the range that rays honour. OpenGL's 1 / (c + l d + q d^2) ends nowhere, and any that is
/// darker at the range is darker near the light as well: it stays the square of the distance.
void setRange(const JsonPlace& place, osg::Light& target, Document& document)
{
    const float range = place.numberOr("range", 0.0f);
    if (!place.find("range")) return;
    if (!(range > 0.0f)) place.at("range").refuse("is not above 0");
    target.setUserValue("osgRayTrace.range", range);
    document.note("lights have a range; OpenGL's shine beyond it, traced ones do not");
}

} // namespace

osg::ref_ptr<osg::Camera> readCamera(const Document& document, const JsonPlace& node)
{
    const std::size_t number = node.at("camera").index(document.count("cameras"));
    const JsonPlace place = document.element("cameras", number);
    const osg::ref_ptr<osg::Camera> camera = new osg::Camera;
    const std::string& type = place.at("type").text();
    if (type == "perspective")
        camera->setProjectionMatrix(perspectiveOf(place.at("perspective")));
    else if (type == "orthographic")
        camera->setProjectionMatrix(orthographicOf(place.at("orthographic")));
    else
        place.at("type").refuse("is '" + type + "', and no kind of camera");
    const std::string own = place.textOr("name", "camera" + std::to_string(number));
    camera->setName(node.textOr("name", own));
    camera->setRenderOrder(osg::Camera::NESTED_RENDER);
    camera->setReferenceFrame(osg::Transform::RELATIVE_RF);
    camera->setClearMask(0);
    camera->setAllowEventFocus(false);
    return camera;
}

osg::ref_ptr<osg::LightSource> readLight(Document& document, const JsonPlace& use, int number)
{
    const JsonPlace lights =
        document.root().at("extensions").at("KHR_lights_punctual").at("lights");
    const JsonPlace place = lights[use.at("light").index(lights.size())];
    const osg::ref_ptr<osg::LightSource> source = new osg::LightSource;
    if (number >= kOpenGLLights) source->setLight(new TracedLight);
    osg::Light& light = *source->getLight();
    light.setLightNum(number);
    light.setName(place.textOr("name", ""));
    source->setName(light.getName());
    const auto rgb = place.numbersOr<3>("color", {1.0f, 1.0f, 1.0f});
    const float value = place.numberOr("intensity", 1.0f) / osg::PIf;
    const osg::Vec4 color(rgb[0] * value, rgb[1] * value, rgb[2] * value, 1.0f);
    light.setDiffuse(color);
    light.setSpecular(color);
    light.setAmbient(osg::Vec4(0.0f, 0.0f, 0.0f, 1.0f));

    const std::string& type = place.at("type").text();
    if (type != "directional" && type != "point" && type != "spot")
        place.at("type").refuse("is '" + type + "', and no kind of light");
    if (type == "directional")
    {
        light.setPosition(osg::Vec4(0.0f, 0.0f, 1.0f, 0.0f));
        return source;
    }
    light.setPosition(osg::Vec4(0.0f, 0.0f, 0.0f, 1.0f));
    light.setDirection(osg::Vec3(0.0f, 0.0f, -1.0f));
    light.setConstantAttenuation(0.0f);
    light.setQuadraticAttenuation(1.0f);
    if (type == "spot") setSpot(place, light);
    setRange(place, light, document);
    return source;
}

} // namespace osgRayTrace::gltf
