// FeatureScenes.h - pairs of scenes that give one picture, one with a feature. Layer: apps.
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

/// Returns pairs in which the feature is there, and out of sight.
std::vector<ScenePair> unusedFeatures(int size);

/// Returns pairs in which all of the scene goes the general way; the scene without goes the way
/// that is specialised for it.
std::vector<ScenePair> generalWays(int size);

} // namespace osgRayTrace::bench
