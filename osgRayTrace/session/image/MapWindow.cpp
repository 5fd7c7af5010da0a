// MapWindow.cpp - cuts a part out of a surface map, and moves maps. Layer: session.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/session/image/MapWindow.h"

namespace osgRayTrace::engine
{

namespace
{

template <class Value>
void cutRows(const std::vector<Value>& from, int width, const PixelWindow& window,
             std::vector<Value>& to)
{
    to.reserve(window.area());
    for (int y = window.bottom; y < window.top; ++y)
    {
        const auto row = from.begin() + static_cast<std::ptrdiff_t>(y) * width;
        to.insert(to.end(), row + window.left, row + window.right);
    }
}

} // namespace

View windowView(const View& view, const PixelWindow& window)
{
    const double width = window.width(), height = window.height();
    Mat4d windowFromClip(1.0);
    windowFromClip[0][0] = view.width / width;
    windowFromClip[1][1] = view.height / height;
    windowFromClip[3][0] = (view.width - 2.0 * window.left) / width - 1.0;
    windowFromClip[3][1] = (view.height - 2.0 * window.bottom) / height - 1.0;
    return {view.viewFromWorld, windowFromClip * view.clipFromView, window.width(),
            window.height()};
}

SurfaceMap cutMap(const SurfaceMap& map, const PixelWindow& window, const Workers& workers)
{
    SurfaceMap result;
    result.view = windowView(map.view, window);
    result.rays = map.rays;
    CameraRays& rays = result.rays.rays;
    const auto left = static_cast<float>(window.left), bottom = static_cast<float>(window.bottom);
    rays.origin += left * rays.originDx + bottom * rays.originDy;
    rays.direction += left * rays.directionDx + bottom * rays.directionDy;
    cutRows(map.normalX, map.view.width, window, result.normalX);
    cutRows(map.normalY, map.view.width, window, result.normalY);
    cutRows(map.normalZ, map.view.width, window, result.normalZ);
    cutRows(map.along, map.view.width, window, result.along);
    cutRows(map.lobe, map.view.width, window, result.lobe);
    cutRows(map.object, map.view.width, window, result.object);
    result.smooth.resize(window.area());
    result.interior.resize(window.area());
    findSmooth(workers, result);
    findInteriors(workers, result);
    result.finished = true;
    return result;
}

void moveMap(const Mat4d& toMoved, SurfaceMap& map)
{
    const Mat3 turn{toMoved};
    map.view.viewFromWorld = map.view.viewFromWorld * glm::inverse(toMoved);
    map.rays.pole = Vec3d(toMoved * Vec4d(map.rays.pole, 1.0));
    CameraRays& rays = map.rays.rays;
    for (Vec3* vector : {&rays.origin, &rays.originDx, &rays.originDy, &rays.direction,
                         &rays.directionDx, &rays.directionDy})
        *vector = turn * *vector;
    for (std::size_t i = 0; i < map.normalX.size(); ++i)
    {
        const Vec3 normal = turn * Vec3(map.normalX[i], map.normalY[i], map.normalZ[i]);
        map.normalX[i] = normal.x;
        map.normalY[i] = normal.y;
        map.normalZ[i] = normal.z;
    }
}

} // namespace osgRayTrace::engine
