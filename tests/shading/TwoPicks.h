// TwoPicks.h - choices of lanes from a light tree, made two at once as integrators do. Layer:
// tests.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/shading/SceneLightTree.h"
#include "tests/Statistics.h"

namespace osgRayTrace::engine::test
{

/// Returns one of two picks that are made at once, the first and the second one by turns.
inline SceneLightTree::Pick pickOf(const SceneLightTree& tree, const Vec3Lanes& p,
                                   const Vec3Lanes& normal, int turn, Uniform& random)
{
    SceneLightTree::Pick picks[2];
    for (SceneLightTree::Pick& pick : picks)
        for (int i = 0; i < kLanes; ++i)
            pick.u[i] = random();
    tree.chooseLanes(p, normal, picks, 2);
    return picks[turn % 2];
}

} // namespace osgRayTrace::engine::test
