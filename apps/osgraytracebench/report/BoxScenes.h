// BoxScenes.h - scenes without a formula, as in data/. Layer: apps.
// SPDX-License-Identifier: MIT
#pragma once

#include "apps/osgraytracebench/report/ReportScene.h"

namespace osgRayTrace::bench
{

enum class CornellKind
{
    Diffuse,
    Mirror, ///< the tall block is one
    Glass,  ///< a sphere of it in place of the blocks
};

/// The published box, by path tracing and photons.
ReportScene cornellScene(CornellKind kind);

enum class CausticKind
{
    Glasses, ///< a glass sphere and a glass of water under a small lamp
    Rings,   ///< metal rings and their caustics in a looking-glass
};

/// The scenes of data/ that path tracing alone hardly renders: by path tracing and photons, against
/// PHOTON_CAUSTICS with four times as many photons. Its bias is of the same kind, only smaller;
/// PATH, which has none, says by its mean what is left of it. What the rings' rims mirror of the
/// lamp is smaller than a pixel: it scatters with all methods alike, and may hide what the photons
/// do.
ReportScene causticScene(CausticKind kind);

/// Lattices below an area light: direct light by all strategies.
ReportScene gridsScene();

/// A scene with the view that it stores, or osgviewer's home view; the integrator that AUTOMATIC
/// takes, with all strategies if that samples lights by them.
ReportScene modelScene(const std::string& name, osg::Node& graph, bool physical);

} // namespace osgRayTrace::bench
