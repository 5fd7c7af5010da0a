// ResolvedImage.cpp - a view's image on its way to the display. Layer: session.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/session/image/ResolvedImage.h"

#include "osgRayTrace/base/Parallel.h"
#include "osgRayTrace/film/Resolve.h"

#include <algorithm>

namespace osgRayTrace::engine
{

void presentImage(const ResolvedImage& image, const ToneMap& toneMap, const Workers& workers,
                  uint8_t* rgba, float* depth)
{
    const auto width = static_cast<std::size_t>(image.width);
    workers.forEach(static_cast<std::size_t>(image.height),
                    [&](std::size_t row)
                    {
                        displayPixels(&image.radiance[4 * row * width], width, toneMap,
                                      rgba + 4 * row * width);
                        if (depth)
                            std::copy_n(&image.depth[row * width], width, depth + row * width);
                    });
}

} // namespace osgRayTrace::engine
