// ClipPlanes.cpp - takes planes to engine space, and tests boxes against planes. Layer: bridge.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/bridge/common/ClipPlanes.h"

#include <algorithm>
#include <cmath>

namespace osgRayTrace::engine
{

bool ClipPlanes::set(const osg::ClipPlane& plane, const osg::Matrixd& engineFromLocal)
{
    if (plane.getClipPlaneNum() >= kClipPlanes) return false;
    // p_local . plane = p_engine . (M^-1 plane), as points are rows.
    const osg::Vec4d inEngine =
        osg::Matrixd::inverse(engineFromLocal).postMult(osg::Vec4d(plane.getClipPlane()));
    const Vec4d values(inEngine.x(), inEngine.y(), inEngine.z(), inEngine.w());
    for (int k = 0; k < 4; ++k)
        if (!(std::fabs(values[k]) < 1e150)) return false;
    _planes[plane.getClipPlaneNum()] = values;
    return true;
}

void ClipPlanes::applyUnit(double unit)
{
    for (Vec4d& plane : _planes)
        plane.w /= unit;
}

void ClipPlanes::take(const ClipPlanes& other, uint64_t numbers)
{
    for (unsigned int i = 0; i < kClipPlanes; ++i)
        if (numbers >> i & 1) _planes[i] = other._planes[i];
}

uint64_t ClipPlanes::differences(const ClipPlanes& other) const
{
    uint64_t numbers = 0;
    for (unsigned int i = 0; i < kClipPlanes; ++i)
        if (_planes[i] != other._planes[i]) numbers |= uint64_t(1) << i;
    return numbers;
}

std::vector<Vec4d> ClipPlanes::planesOf(uint64_t numbers) const
{
    std::vector<Vec4d> planes;
    for (unsigned int i = 0; i < kClipPlanes; ++i)
        if ((numbers >> i & 1) && _planes[i] != Vec4d(0.0)) planes.push_back(_planes[i]);
    return planes;
}

Clipping clippingOf(const VertexBounds& bounds, const osg::Matrixd& m,
                    const std::vector<Vec4d>& planes)
{
    if (planes.empty()) return Clipping::None;
    if (bounds.count == 0) return Clipping::Partly;
    const Vec3d centre = bounds.centre(), half = 0.5 * (bounds.high - bounds.low);
    Clipping result = Clipping::None;
    for (const Vec4d& plane : planes)
    {
        double height = plane.w, reach = 0.0, size = std::fabs(plane.w);
        for (int k = 0; k < 3; ++k)
        {
            const double slope = m(k, 0) * plane.x + m(k, 1) * plane.y + m(k, 2) * plane.z;
            const double offset = m(3, k) * plane[k];
            height += slope * centre[k] + offset;
            reach += std::fabs(slope) * half[k];
            size += std::fabs(slope * centre[k]) + std::fabs(offset);
        }
        reach += 1e-6 * (size + reach); // positions are float
        if (height < -reach) return Clipping::Wholly;
        if (!(height > reach)) result = Clipping::Partly;
    }
    return result;
}

} // namespace osgRayTrace::engine
