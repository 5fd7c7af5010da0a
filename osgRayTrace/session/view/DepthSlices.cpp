// DepthSlices.cpp - passes that show one picture, each a slice of its depths. Layer: session.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/session/view/DepthSlices.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace osgRayTrace::engine
{

namespace
{

constexpr int kDepthRow = 2;

/// The last depth that passes a test against the background is one unit of 24 bits below 1.
constexpr float kBeforeOne = 0.99999994f;
constexpr float kAfterZero = 5.9604645e-8f;

double farthest(const std::vector<DepthPlanes>& slices)
{
    double far = -std::numeric_limits<double>::infinity();
    for (const DepthPlanes& slice : slices)
        far = std::max(far, slice.far);
    return far;
}

double nearest(const std::vector<DepthPlanes>& slices)
{
    double near = std::numeric_limits<double>::infinity();
    for (const DepthPlanes& slice : slices)
        near = std::min(near, slice.near);
    return near;
}

std::vector<DepthPlanes> planesOf(const std::vector<View>& slices)
{
    std::vector<DepthPlanes> planes;
    for (const View& slice : slices)
        planes.push_back(depthPlanes(slice).value_or(DepthPlanes()));
    return planes;
}

bool isReversed(const View& view)
{
    const std::optional<CameraRays> rays = cameraRays(view, Vec3d(0.0));
    return rays && rays->nearDepth > 0.5f;
}

} // namespace

bool sameRays(const View& a, const View& b)
{
    if (a.width != b.width || a.height != b.height || a.viewFromWorld != b.viewFromWorld)
        return false;
    for (int column = 0; column < 4; ++column)
        for (int row = 0; row < 4; ++row)
            if (row != kDepthRow && a.clipFromView[column][row] != b.clipFromView[column][row])
                return false;
    return true;
}

bool sameDepth(const View& a, const View& b)
{
    for (int column = 0; column < 4; ++column)
        if (a.clipFromView[column][kDepthRow] != b.clipFromView[column][kDepthRow]) return false;
    return true;
}

View withDepthOf(View view, const View& other)
{
    for (int column = 0; column < 4; ++column)
        view.clipFromView[column][kDepthRow] = other.clipFromView[column][kDepthRow];
    return view;
}

std::optional<DepthPlanes> depthPlanes(const View& view)
{
    // Clip z is a z + b, clip w is -c z (c if orthographic), and z is -v.
    const Mat4d& m = view.clipFromView;
    if (m[0][2] != 0.0 || m[1][2] != 0.0 || m[0][3] != 0.0 || m[1][3] != 0.0) return std::nullopt;
    if (m[2][3] != 0.0 && m[3][3] != 0.0) return std::nullopt;
    DepthPlanes planes;
    planes.orthographic = m[2][3] == 0.0;
    const double a = m[2][2], b = m[3][2], c = planes.orthographic ? m[3][3] : -m[2][3];
    const double atMinus = planes.orthographic ? (b + c) / a : b / (a - c);
    const double atPlus = planes.orthographic ? (b - c) / a : b / (a + c);
    planes.constant = planes.orthographic ? b / c : -a / c;
    planes.factor = planes.orthographic ? -a / c : b / c;
    const bool reversed = planes.reversed();
    planes.near = reversed ? atPlus : atMinus;
    planes.far = reversed ? atMinus : atPlus;
    // The sign of a far plane at infinity depends on rounding.
    if (!planes.orthographic && !(planes.far > planes.near))
        planes.far = std::numeric_limits<double>::infinity();
    const bool usable = std::isfinite(planes.near) && planes.far > planes.near &&
                        std::isfinite(planes.constant) && std::isfinite(planes.factor) &&
                        (planes.orthographic || planes.near > 0.0);
    return usable ? std::optional<DepthPlanes>(planes) : std::nullopt;
}

View viewOfSlices(const std::vector<View>& slices)
{
    const std::vector<DepthPlanes> planes = planesOf(slices);
    const double near = nearest(planes), far = farthest(planes);
    View view = slices.front();
    Mat4d& m = view.clipFromView;
    if (planes.front().orthographic)
    {
        const double c = m[3][3];
        m[2][2] = -2.0 * c / (far - near);
        m[3][2] = -c * (far + near) / (far - near);
    }
    else
    {
        const double c = -m[2][3]; // depth = 2 near / v - 1
        m[2][2] = c;
        m[3][2] = 2.0 * near * c;
    }
    return view;
}

DepthMap depthMap(const View& pass)
{
    DepthMap map;
    map.background = isReversed(pass) ? kAfterZero : kBeforeOne;
    return map;
}

DepthMap depthMap(const View& pass, const std::vector<View>& slices)
{
    const std::vector<DepthPlanes> all = planesOf(slices);
    const double near = nearest(all), far = farthest(all);
    const DepthPlanes planes = depthPlanes(pass).value_or(DepthPlanes());
    // Orthographic views have v = near + (far - near) depth; others have 1 / v = depth / near.
    const double scale = planes.orthographic ? planes.factor * (far - near) : planes.factor / near;
    const double constant =
        planes.orthographic ? planes.constant + planes.factor * near : planes.constant;
    DepthMap map;
    map.scale = static_cast<float>(0.5 * scale);
    map.offset = static_cast<float>(0.5 + 0.5 * constant);
    const bool last = planes.far >= far;
    map.background = !last ? -1.0f : planes.reversed() ? kAfterZero : kBeforeOne;
    return map;
}

} // namespace osgRayTrace::engine
