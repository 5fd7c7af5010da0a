// ViewInputs.cpp - what the image of a view is made from, besides its matrices. Layer: session.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/session/view/ViewInputs.h"

#include "osgRayTrace/accel/TracedScene.h"

#include <algorithm>

namespace osgRayTrace::engine
{

namespace
{

/// Lets media veil the background if they veil anything. A background with an alpha below 1 stands
/// for something else, which is not known.
void setVeiled(const TracedScene& traced, ToneMap& toneMap)
{
    const Scene& scene = traced.scene();
    toneMap.veiled = traced.traits().veils && !scene.displayReferred && scene.background.w >= 1.0f;
    if (!toneMap.veiled) return;
    for (int c = 0; c < 3; ++c)
        toneMap.background[c] = std::clamp(srgbFromLinear(scene.background[c]), 0.0f, 1.0f);
}

} // namespace

ToneMap toneMapOf(const ViewInputs& inputs)
{
    ToneMap toneMap;
    toneMap.exposureEv = inputs.exposureEv;
    toneMap.curve = inputs.toneCurve;
    toneMap.displayReferred = inputs.scene->scene().displayReferred;
    setVeiled(*inputs.scene, toneMap);
    return toneMap;
}

bool sameImage(const ViewInputs& a, const ViewInputs& b)
{
    return a.scene == b.scene && a.workers == b.workers && a.photons == b.photons &&
           a.help == b.help && !a.options.needsRestart(b.options) && a.exposureEv == b.exposureEv &&
           a.autoExposure == b.autoExposure && a.toneCurve == b.toneCurve &&
           a.denoise == b.denoise && a.reprojects == b.reprojects &&
           a.keepsUnchanged == b.keepsUnchanged && a.maxPasses == b.maxPasses &&
           a.passesPerFrame == b.passesPerFrame;
}

} // namespace osgRayTrace::engine
