// EnvironmentLight.cpp - setters that refuse bad values. Layer: public API.
// SPDX-License-Identifier: MIT
#include <osgRayTrace/EnvironmentLight>

#include "osgRayTrace/bridge/common/WarnOnce.h"

#include <algorithm>
#include <cmath>

namespace osgRayTrace
{

EnvironmentLight::EnvironmentLight() = default;

EnvironmentLight::EnvironmentLight(osg::Image* image) : _image(image) {}

EnvironmentLight::EnvironmentLight(const EnvironmentLight& other, const osg::CopyOp& copyop)
    : osg::Node(other, copyop),
      _image(copyop(other._image.get())),
      _cubeMap(static_cast<osg::TextureCubeMap*>(copyop(other._cubeMap.get()))),
      _rotation(other._rotation),
      _scale(other._scale),
      _visible(other._visible)
{
}

EnvironmentLight::~EnvironmentLight() = default;

void EnvironmentLight::setRotation(const osg::Quat& value)
{
    const double length2 = value.length2();
    if (!std::isfinite(length2) || !(length2 > 0.0))
    {
        engine::warnOnce("EnvironmentLight '" + getName() +
                         "': rotation is zero or not finite, left as it was");
        return;
    }
    _rotation = value;
}

void EnvironmentLight::setScale(const osg::Vec3& value)
{
    if (!std::isfinite(value.x()) || !std::isfinite(value.y()) || !std::isfinite(value.z()))
    {
        engine::warnOnce("EnvironmentLight '" + getName() +
                         "': scale is not finite, left as it was");
        return;
    }
    const osg::Vec3 clamped(std::max(value.x(), 0.0f), std::max(value.y(), 0.0f),
                            std::max(value.z(), 0.0f));
    if (clamped != value)
        engine::warnOnce("EnvironmentLight '" + getName() + "': negative scale, clamped to 0");
    _scale = clamped;
}

} // namespace osgRayTrace
