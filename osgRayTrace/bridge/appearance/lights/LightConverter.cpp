// LightConverter.cpp - places lights in engine space. Layer: bridge.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/bridge/appearance/lights/LightConverter.h"

#include "osgRayTrace/scene/Material.h"

#include <osgRayTrace/AreaLight>
#include <osgRayTrace/TracedLight>

#include <osg/ValueObject>
#include <osg/Vec3d>
#include <osg/Vec4d>

#include <cmath>

namespace osgRayTrace::engine
{

namespace
{

Vec3 toVec3(const osg::Vec3d& v)
{
    return Vec3(v.x(), v.y(), v.z());
}
Vec3 rgb(const osg::Vec4& color)
{
    return {color.r(), color.g(), color.b()};
}

constexpr float kLargestCoordinate = 1e18f; ///< limit as for vertices: Embree's is 1.844e18

/// Returns whether a point is within reach; returns false for NaN as well.
bool isWithinReach(const Vec3& p)
{
    return std::fabs(p.x) <= kLargestCoordinate && std::fabs(p.y) <= kLargestCoordinate &&
           std::fabs(p.z) <= kLargestCoordinate;
}

bool isFiniteLight(const Light& light)
{
    for (const Vec3& v :
         {light.ambient, light.diffuse, light.specular, light.position, light.direction})
        if (!isFinite(v)) return false;
    return std::isfinite(light.attenuationConstant) && std::isfinite(light.attenuationLinear) &&
           std::isfinite(light.attenuationQuadratic) && std::isfinite(light.spotExponent);
}

/// Returns the cosine of a cut-off angle. OpenGL knows cut-off angles of 0 to 90 degrees and 180,
/// and ignores others [OpenGL 2.1, sect. 2.14.1].
float cosCutoff(float degrees)
{
    const bool isSpot = degrees >= 0.0f && degrees <= 90.0f;
    return isSpot
               ? static_cast<float>(std::cos(osg::DegreesToRadians(static_cast<double>(degrees))))
               : -1.0f;
}

} // namespace

float rangeOf(const osg::Light& light)
{
    float range = 0.0f;
    if (!light.getUserValue("osgRayTrace.range", range)) return 0.0f;
    return std::isfinite(range) && range > 0.0f ? range : 0.0f;
}

bool isTracedLight(const osg::Light& light)
{
    return dynamic_cast<const TracedLight*>(&light) != nullptr;
}

std::optional<Light> convertLight(const osg::Light& source, const osg::Matrixd& engineFromLocal,
                                  bool eyeSpace, double unit)
{
    Light light;
    light.name = source.getName();
    light.number =
        isTracedLight(source) ? kNoLightNumber : static_cast<uint32_t>(source.getLightNum());
    light.eyeSpace = eyeSpace;
    light.ambient = rgb(source.getAmbient());
    light.diffuse = rgb(source.getDiffuse());
    light.specular = rgb(source.getSpecular());

    const osg::Vec4d position = osg::Vec4d(source.getPosition()) * engineFromLocal;
    if (source.getPosition().w() == 0.0f)
    {
        light.kind = LightKind::Directional;
        osg::Vec3d towards(position.x(), position.y(), position.z());
        if (!(towards.normalize() > 0.0)) return std::nullopt;
        light.direction = toVec3(-towards);
        return isFiniteLight(light) ? std::optional<Light>(light) : std::nullopt;
    }

    light.kind = LightKind::Point;
    light.position = toVec3(osg::Vec3d(position.x(), position.y(), position.z()) / position.w());
    osg::Vec3d axis =
        osg::Matrixd::transform3x3(osg::Vec3d(source.getDirection()), engineFromLocal);
    if (axis.normalize() > 0.0) light.direction = toVec3(axis);
    light.attenuationConstant = source.getConstantAttenuation();
    // OpenGL's values are given for world lengths; the engine evaluates them with engine lengths.
    light.attenuationLinear = static_cast<float>(source.getLinearAttenuation() * unit);
    light.attenuationQuadratic = static_cast<float>(source.getQuadraticAttenuation() * unit * unit);
    light.range = static_cast<float>(rangeOf(source) / unit);
    light.spotExponent = source.getSpotExponent();
    light.spotCosCutoff = cosCutoff(source.getSpotCutoff());
    return isFiniteLight(light) ? std::optional<Light>(light) : std::nullopt;
}

std::optional<ConvertedAreaLight> convertAreaLight(const AreaLight& source,
                                                   const osg::Matrixd& engineFromLocal)
{
    const auto placed = [&engineFromLocal](const osg::Vec3d& v)
    { return osg::Matrixd::transform3x3(v, engineFromLocal); };
    const osg::Vec3d corner = osg::Vec3d(source.getCorner()) * engineFromLocal;
    osg::Vec3d edgeU = placed(osg::Vec3d(source.getEdgeU()));
    osg::Vec3d edgeV = placed(osg::Vec3d(source.getEdgeV()));
    const osg::Vec3d x = placed({1.0, 0.0, 0.0}), y = placed({0.0, 1.0, 0.0}),
                     z = placed({0.0, 0.0, 1.0});
    if ((x ^ y) * z < 0.0) std::swap(edgeU, edgeV);

    ConvertedAreaLight result;
    Light& light = result.light;
    light.name = source.getName();
    light.kind = LightKind::Parallelogram;
    light.corner = toVec3(corner);
    light.edgeU = toVec3(edgeU);
    light.edgeV = toVec3(edgeV);
    light.radiance = {source.getRadiance().x(), source.getRadiance().y(), source.getRadiance().z()};
    light.twoSided = source.getTwoSided();

    // The area is computed in double, as the square of a small light's area is no normal float.
    const auto area =
        static_cast<float>(glm::length(glm::cross(Vec3d(light.edgeU), Vec3d(light.edgeV))));
    if (!(area > 0.0f) || !std::isfinite(area) || !isFinite(light.corner) ||
        !isFinite(light.radiance))
        return std::nullopt;

    std::vector<Vec3> positions;
    positions.reserve(5); // Embree reads past the last one
    positions = {light.corner, light.corner + light.edgeU, light.corner + light.edgeU + light.edgeV,
                 light.corner + light.edgeV};
    for (const Vec3& p : positions)
        if (!isWithinReach(p)) return std::nullopt;
    result.mesh = std::make_shared<Mesh>();
    result.mesh->name = light.name;
    result.mesh->positions = std::move(positions);
    result.mesh->triangles = std::vector<UVec3>{{0, 1, 2}, {0, 2, 3}};
    return result;
}

Light meshLight(const std::string& name, const Vec3& radiance, uint32_t instance)
{
    Light light;
    light.name = name;
    light.kind = LightKind::Mesh;
    light.radiance = radiance;
    light.twoSided = true; // both sides of a face emit: see PhysicalMaterial
    light.instance = instance;
    return light;
}

} // namespace osgRayTrace::engine
