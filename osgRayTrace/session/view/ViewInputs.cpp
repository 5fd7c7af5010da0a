// ViewInputs.cpp - what the image of a view is made from, besides its matrices. Layer: session.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/session/view/ViewInputs.h"

#include "osgRayTrace/accel/TracedScene.h"

namespace osgRayTrace::engine
{

ToneMap toneMapOf(const ViewInputs& inputs)
{
    ToneMap toneMap;
    toneMap.exposureEv = inputs.exposureEv;
    toneMap.curve = inputs.toneCurve;
    toneMap.displayReferred = inputs.scene->scene().displayReferred;
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
