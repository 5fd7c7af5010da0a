// Volume.cpp - compares volumes. Layer: scene.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/scene/Volume.h"

#include <tuple>

namespace osgRayTrace::engine
{

bool sameVolume(const Volume& a, const Volume& b)
{
    const auto values = [](const Volume& v)
    {
        return std::tie(v.image, v.transferScale, v.transferOffset, v.imageFromEngine.linear,
                        v.imageFromEngine.translation, v.tileFromEngine.linear,
                        v.tileFromEngine.translation, v.law, v.medium, v.transparency, v.cutoff,
                        v.sampleRatio, v.sampleLength, v.lit, v.tint);
    };
    return values(a) == values(b) && a.transfer == b.transfer;
}

} // namespace osgRayTrace::engine
