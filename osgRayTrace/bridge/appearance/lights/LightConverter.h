// LightConverter.h - converts osg::Light, AreaLight and emitting geometry to Light. Layer: bridge.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/scene/Light.h"

#include <osg/Light>
#include <osg/Matrixd>

#include <memory>
#include <optional>
#include <string>

namespace osgRayTrace
{
class AreaLight;
}

namespace osgRayTrace::engine
{

/// Returns the range of a light [world lengths], its user value "osgRayTrace.range" of type float;
/// 0: none.
float rangeOf(const osg::Light& light);

/// Returns whether a light is a TracedLight, whose number means nothing.
bool isTracedLight(const osg::Light& light);

/// Converts a directional or point light with OpenGL's meaning of each value. The matrix places the
/// light in engine space, or is the identity for a light in eye space; unit is Scene::unit. Returns
/// nothing if a value is not finite.
std::optional<Light> convertLight(const osg::Light& light, const osg::Matrixd& engineFromLocal,
                                  bool eyeSpace, double unit);

/// Holds the light and the two triangles that rays hit, in engine space. A mirrored transform
/// leaves the front side where it is on the node. The conversion returns nothing if the light has
/// no area or is not finite.
struct ConvertedAreaLight
{
    Light light;
    std::shared_ptr<Mesh> mesh;
};
std::optional<ConvertedAreaLight> convertAreaLight(const AreaLight& source,
                                                   const osg::Matrixd& engineFromLocal);

/// Returns the light of an instance whose material emits.
Light meshLight(const std::string& name, const Vec3& radiance, uint32_t instance);

} // namespace osgRayTrace::engine
