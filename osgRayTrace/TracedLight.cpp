// TracedLight.cpp - keeps the light from OpenGL. Layer: public API.
// SPDX-License-Identifier: MIT
#include <osgRayTrace/TracedLight>

namespace osgRayTrace
{

TracedLight::TracedLight() = default;

TracedLight::TracedLight(const TracedLight& other, const osg::CopyOp& copyop)
    : osg::Light(other, copyop)
{
}

TracedLight::~TracedLight() = default;

bool TracedLight::getModeUsage(ModeUsage&) const
{
    return false;
}

void TracedLight::apply(osg::State&) const {}

} // namespace osgRayTrace
