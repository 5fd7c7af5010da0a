// LightSteps.h - the choice of a step down a light tree, which is two levels long. Layer: shading.
// SPDX-License-Identifier: MIT
//
// From a pair of nodes a step leads to a node of one of the two pairs below it, or to a node of the
// pair itself that is a leaf: to one of two to four nodes, in proportion to their importance().
// Their bounds are closer to the lights than those of the nodes between, which a step passes over.
// Places 0 and 1 of a step are below the first node of the pair, or place 0 is that node; places 2
// and 3 are the second node's.
#pragma once

#include "osgRayTrace/base/QuickCompare.h"

namespace osgRayTrace::engine
{

/// The weights of the places of a step; 0: it does not lead there.
struct StepWeights
{
    float w0, w1, w2, w3;
};

OSGRAYTRACE_INLINE float sumOf(StepWeights w)
{
    return ((w.w0 + w.w1) + w.w2) + w.w3;
}

/// Returns a weight. least: of places that are not dark.
OSGRAYTRACE_INLINE float stepWeight(float importance, float least)
{
    return select(maskOf(importance > 0.0f), atLeast(importance, least), 0.0f);
}

/// Returns the weights of places with these importances. has1, has3: masks, whether there are nodes
/// at places 1 and 3. Steps lead to place 0 if all are dark.
OSGRAYTRACE_INLINE StepWeights stepWeights(StepWeights importances, uint32_t has1, uint32_t has3)
{
    // Rounding must not take the last chance of a node that may shine.
    constexpr float kLeastShare = 0x1p-20f, kLeast = 1e-30f, kMost = 1e30f;
    const StepWeights i{
        atMost(importances.w0, kMost), select(has1, atMost(importances.w1, kMost), 0.0f),
        atMost(importances.w2, kMost), select(has3, atMost(importances.w3, kMost), 0.0f)};
    const float sum = sumOf(i), least = atLeast(kLeastShare * sum, kLeast);
    return {select(maskOf(sum > 0.0f), stepWeight(i.w0, least), 1.0f), stepWeight(i.w1, least),
            stepWeight(i.w2, least), stepWeight(i.w3, least)};
}

/// A place that a random number has chosen, whose weight is not 0.
struct StepChoice
{
    uint32_t is0, is1, is2; ///< masks, of which one at most has bits: place 3 else
    float probability;
    float u; ///< what is left of the random number, in [0,1)
};

/// Chooses a place. u: at most kOneMinusEpsilon, whose product with the sum is less than the sum.
OSGRAYTRACE_INLINE StepChoice chooseStep(StepWeights w, float u)
{
    const float below1 = w.w0, below2 = w.w0 + w.w1, below3 = below2 + w.w2;
    const float sum = below3 + w.w3;
    const float x = u * sum;
    const uint32_t less1 = isLess(x, below1), less2 = isLess(x, below2), less3 = isLess(x, below3);
    StepChoice choice;
    choice.is0 = less1;
    choice.is1 = less2 & ~less1;
    choice.is2 = less3 & ~less2;
    const float own = select(less1, w.w0, select(less2, w.w1, select(less3, w.w2, w.w3)));
    const float before = select(less1, 0.0f, select(less2, below1, select(less3, below2, below3)));
    choice.probability = own / sum;
    choice.u = atMost(atLeast((x - before) / own, 0.0f), kOneMinusEpsilon);
    return choice;
}

} // namespace osgRayTrace::engine
