// FeatureScenes.h - pairs of scenes that give one picture, one of them with a feature. Layer: apps.
// SPDX-License-Identifier: MIT
#pragma once

#include "apps/osgraytracebench/scenes/BenchScenes.h"

#include <string>
#include <vector>

namespace osgRayTrace::bench
{

struct ScenePair
{
    std::string name;
    BenchScene without, with;
};

/// The feature is there, and out of sight.
std::vector<ScenePair> unusedFeatures(int size);

/// All of the scene goes the general way; without, the way that is specialised for what it is.
std::vector<ScenePair> generalWays(int size);

} // namespace osgRayTrace::bench
