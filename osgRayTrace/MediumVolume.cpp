// MediumVolume.cpp - copies a volume, and refuses bad values. Layer: public API.
// SPDX-License-Identifier: MIT
#include <osgRayTrace/MediumVolume>

#include "osgRayTrace/bridge/common/WarnOnce.h"

#include <algorithm>
#include <cmath>

namespace osgRayTrace
{

MediumVolume::MediumVolume() = default;

MediumVolume::MediumVolume(Medium* medium) : _medium(medium) {}

MediumVolume::MediumVolume(const MediumVolume& other, const osg::CopyOp& copyop)
    : osg::Node(other, copyop),
      _medium(static_cast<Medium*>(copyop(static_cast<const osg::Object*>(other._medium.get())))),
      _radius(other._radius)
{
}

MediumVolume::~MediumVolume() = default;

void MediumVolume::setRadius(float value)
{
    if (!std::isfinite(value))
    {
        engine::warnOnce("MediumVolume '" + getName() + "': radius is not finite, left as it was");
        return;
    }
    if (value < 0.0f)
        engine::warnOnce("MediumVolume '" + getName() + "': negative radius, clamped to 0");
    _radius = std::max(value, 0.0f);
}

} // namespace osgRayTrace
