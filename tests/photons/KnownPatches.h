// KnownPatches.h - patches of floor whose light by photons has a formula.
// SPDX-License-Identifier: MIT
#pragma once

#include "tests/EngineScenes.h"

namespace osgRayTrace::engine::test
{

/// A patch of floor whose radiance is known, for each pixel and as a mean over discs.
struct KnownPatch
{
    SceneBuilder builder;
    Vec3d centre;
    double side;
    double (*mean)(double x, double y, double radius); ///< of the light that photons carry
    double (*direct)(double x, double y);
};

/// Returns a patch in the light of a point light's image in a flat mirror.
KnownPatch flatMirrorPatch();

/// Returns a patch between the centre and the nephroid's cusp, where G rises from 1.4 to 5.
KnownPatch nephroidPatch();

/// Returns a patch over the nephroid, whose light is infinite on a curve through the patch.
KnownPatch causticPatch();

/// Returns the view of the patch in pixels * pixels.
View viewOf(const KnownPatch& patch, int pixels);

/// Returns the centre of pixel k; pixels count row by row from below, and the view looks down with
/// +x up.
Vec3d pixelCentre(const KnownPatch& patch, int pixels, int k);

/// Returns the radiance of the pixels without noise and bias. The mean over a disc with the
/// square's second moments is the mean over the pixel, to the fourth order of the pixel's size.
std::vector<double> truth(const KnownPatch& patch, int pixels);

} // namespace osgRayTrace::engine::test
