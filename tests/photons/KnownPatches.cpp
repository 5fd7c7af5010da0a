// KnownPatches.cpp - patches of floor whose light by photons has a formula.
// SPDX-License-Identifier: MIT
#include "tests/photons/KnownPatches.h"
#include "tests/photons/Nephroid.h"

namespace osgRayTrace::engine::test
{

namespace
{

/// Returns a point light at (0, 0, 1) beside a mirror at x = 1: the light's image is at (2, 0, 1).
/// Light that falls onto the patch from the image has gone through the mirror wherever the patch's
/// discs reach.
SceneBuilder flatMirror()
{
    SceneBuilder builder;
    builder.add(quadMesh({-2, -2, 0}, {2.9f, 0, 0}, {0, 4, 0}), lambert(Vec3(1.0f)));
    builder.add(quadMesh({1, 0.45f, 0.1f}, {0, -0.9f, 0}, {0, 0, 0.53f}), mirror(Vec3(1.0f)));
    builder.addLight(pointLight({0, 0, 1}));
    return builder;
}

/// Returns the radiance of a white floor under a point light of intensity pi, which is one length
/// above the foot.
double underLight(double x, double y)
{
    return std::pow(1.0 + x * x + y * y, -1.5);
}

/// Returns the mean over a disc to the fourth order of the radius, which is 1e-6 at the discs of
/// the tests. E = (1 + q)^-1.5, where q is the square of the distance from the foot: its Laplacian
/// is (9 q - 6) (1 + q)^-3.5.
double mirroredMean(double x, double y, double radius)
{
    const double q = (x - 2.0) * (x - 2.0) + y * y;
    return underLight(x - 2.0, y) +
           radius * radius / 8.0 * (9.0 * q - 6.0) * std::pow(1.0 + q, -3.5);
}

double nephroidMean(double x, double y, double radius)
{
    return meanGain(x, y, radius, 8000);
}

double sunlight(double, double)
{
    return 1.0;
}

} // namespace

KnownPatch flatMirrorPatch()
{
    return {flatMirror(), {0.1, 0, 0}, 0.8, mirroredMean, underLight};
}

KnownPatch nephroidPatch()
{
    return {nephroid(), {0.28, 0, 0}, 0.24, nephroidMean, sunlight};
}

KnownPatch causticPatch()
{
    return {nephroid(), {0.5, 0.1, 0}, 0.3, nephroidMean, sunlight};
}

View viewOf(const KnownPatch& patch, int pixels)
{
    return patchView(patch.centre, {0, 0, 1}, patch.side, pixels);
}

Vec3d pixelCentre(const KnownPatch& patch, int pixels, int k)
{
    const double up = (k / pixels + 0.5) / pixels - 0.5, right = (k % pixels + 0.5) / pixels - 0.5;
    return patch.centre + Vec3d(up, -right, 0.0) * patch.side;
}

std::vector<double> truth(const KnownPatch& patch, int pixels)
{
    std::vector<double> values;
    const double pixelRadius = patch.side / pixels / std::sqrt(3.0);
    for (int k = 0; k < pixels * pixels; ++k)
    {
        const Vec3d p = pixelCentre(patch, pixels, k);
        values.push_back(patch.mean(p.x, p.y, pixelRadius) + patch.direct(p.x, p.y));
    }
    return values;
}

} // namespace osgRayTrace::engine::test
