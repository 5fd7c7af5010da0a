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
      _radius(other._radius),
      _shape(other._shape),
      _scaleHeight(other._scaleHeight),
      _box(other._box)
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

void MediumVolume::setShape(Shape shape)
{
    _shape = shape == LAYER || shape == BOX ? shape : EVERYWHERE;
    dirtyBound();
}

void MediumVolume::setScaleHeight(float value)
{
    if (std::isfinite(value) && value > 0.0f)
        _scaleHeight = value;
    else
        engine::warnOnce("MediumVolume '" + getName() +
                         "': scale height is not positive and finite, left as it was");
}

void MediumVolume::setBox(const osg::BoundingBox& box)
{
    bool finite = true;
    for (int k = 0; k < 3; ++k)
        finite = finite && std::isfinite(box._min[k]) && std::isfinite(box._max[k]);
    if (!finite)
    {
        engine::warnOnce("MediumVolume '" + getName() + "': box is not finite, left as it was");
        return;
    }
    _box = box;
    dirtyBound();
}

osg::BoundingSphere MediumVolume::computeBound() const
{
    return _shape == BOX && _box.valid() ? osg::BoundingSphere(_box) : osg::BoundingSphere();
}

} // namespace osgRayTrace
