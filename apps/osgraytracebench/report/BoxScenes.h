// BoxScenes.h - scenes without a formula, as in data/. Layer: apps.
// SPDX-License-Identifier: MIT
#pragma once

#include "apps/osgraytracebench/report/ReportScene.h"

namespace osgRayTrace::bench
{

/// Sets the scene's view to the one that its graph stores.
void useStoredView(ReportScene& scene);

enum class CornellKind
{
    Diffuse,
    Mirror, ///< the tall block is a mirror
    Glass,  ///< a glass sphere in place of the blocks
};

/// Returns the published box, by path tracing and photons.
ReportScene cornellScene(CornellKind kind);

enum class CausticKind
{
    Glasses, ///< a glass sphere and a glass of water under a small lamp
    Rings,   ///< metal rings and their caustics in a looking-glass
};

/// Returns a scene of data/ that path tracing alone hardly renders: by path tracing and photons,
/// against PHOTON_CAUSTICS with four times as many photons. The reference's bias is of the same
/// kind as the methods', only smaller; PATH, which has none, tells by its mean how much of the bias
/// is left. The mirror images of the lamp in the rings' rims are smaller than a pixel: they scatter
/// with all methods alike, and may hide the effect of the photons.
ReportScene causticScene(CausticKind kind);

/// Returns lattices below an area light: direct light by all strategies.
ReportScene gridsScene();

/// Returns a scene with the view that it stores, or osgviewer's home view. Its method is the
/// integrator that AUTOMATIC takes, with all strategies if that integrator samples lights by them.
ReportScene modelScene(const std::string& name, osg::Node& graph, bool physical);

} // namespace osgRayTrace::bench
