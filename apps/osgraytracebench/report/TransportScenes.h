// TransportScenes.h - scenes that are hard for light transport. Layer: apps.
// SPDX-License-Identifier: MIT
#pragma once

#include "apps/osgraytracebench/report/ReportScene.h"

namespace osgRayTrace::bench
{

/// Returns the scenes of data/generator/Transport.h at the sizes that are measured. Those without a
/// formula have a method that renders their reference; another method of the scene, which does not
/// share its estimators, should have the same mean.
std::vector<ReportScene> transportScenes();

/// Returns twoSpheres: the radiance of the dark sphere is known. f: the port's share of a sphere.
ReportScene twoSpheresScene(double f);

/// Returns lampField: the sum of Lambert's formulas.
ReportScene lampFieldScene(int lamps);

} // namespace osgRayTrace::bench
