// DaylightScenes.h - rooms with a window, open ground under skies, and rooms under large panels.
// Layer: apps.
// SPDX-License-Identifier: MIT
#pragma once

#include "apps/osgraytracebench/scenes/BenchScenes.h"

namespace osgRayTrace::bench
{

enum class Sky
{
    Sunny, ///< a gradient with a sun that gives some four times as much light
    Even,  ///< one radiance from all sides above the horizon, half of it below
};

enum class Glazing
{
    Open,
    Pane,  ///< one thin-walled quad
    Panes, ///< two thin-walled quads, 1 cm apart
    Box,   ///< a body of glass, 1 cm thick, which bends light
};

/// Returns a room of 4 x 5 x 2.7 m with a window of 1 m2 in its right wall, through which alone the
/// light of a sky comes.
BenchScene windowRoom(Sky sky, Glazing glazing, int width, int height);

/// Returns open ground with boxes under a sky.
BenchScene openGround(Sky sky, int width, int height);

/// Returns the room without a window, under a rectangle of 3 x 4 m that shines; skewed: under a
/// parallelogram that is none.
BenchScene panelRoom(bool skewed, int width, int height);

} // namespace osgRayTrace::bench
