// DenoiseFilter.cpp - takes noise out of an image of few samples. Layer: session.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/session/denoise/DenoiseFilter.h"

#include "osgRayTrace/base/Parallel.h"
#include "osgRayTrace/session/denoise/DenoiseCells.h"

#include <algorithm>
#include <functional>

namespace osgRayTrace::engine
{

namespace
{

constexpr int kLevels = 4;
static_assert(1 << (kLevels - 1) <= CellPlane::kMargin, "taps stay within the margin");

} // namespace

struct DenoiseFilter::Implementation
{
    void allocate();

    DenoiseGuides guides;
    int width = 0, height = 0; ///< size of the arrays below
    CellStatistics statistics;
    CellLight light, other;
};

DenoiseFilter::DenoiseFilter() : _implementation(std::make_unique<Implementation>()) {}
DenoiseFilter::~DenoiseFilter() = default;

void DenoiseFilter::Implementation::allocate()
{
    if (width == guides.width && height == guides.height) return;
    width = height = 0; // no size is valid if memory runs out below
    for (CellPlane* plane :
         {&light.r, &light.g, &light.b, &other.r, &other.g, &other.b, &statistics.mean})
        plane->allocate(guides.cellsX, guides.cellsY, kNoLight);
    for (CellPlane* plane : {&light.variance, &other.variance, &statistics.spread,
                             &statistics.error, &statistics.variance})
        plane->allocate(guides.cellsX, guides.cellsY, 0.0f);
    width = guides.width;
    height = guides.height;
}

void DenoiseFilter::setSurfaces(const std::vector<SurfaceSample>& surfaces, int width, int height,
                                const Workers& workers)
{
    Implementation& self = *_implementation;
    self.guides.set(surfaces, width, height, workers);
    self.allocate();
}

void DenoiseFilter::filter(ResolvedImage& image, const Workers& workers)
{
    Implementation& self = *_implementation;
    const DenoiseGuides& guides = self.guides;
    if (image.width != self.width || image.height != self.height || image.width == 0) return;

    const auto forRows = [&](int count, const std::function<void(int)>& row)
    {
        workers.forEach(static_cast<std::size_t>(count),
                        [&](std::size_t y) { row(static_cast<int>(y)); });
    };
    const bool hasErrors = !image.error.empty();
    CellLight *from = &self.light, *to = &self.other;
    forRows(guides.cellsY, [&](int y) { gatherCells(image, guides, y, *from, self.statistics); });
    forRows(guides.cellsY,
            [&](int y) { boundCells(guides, self.statistics, *from, hasErrors, y, *to); });
    std::swap(from, to);
    for (int level = 0; level < kLevels; ++level)
    {
        forRows(guides.cellsY, [&](int y) { filterCells(guides, *from, 1 << level, y, *to); });
        std::swap(from, to);
    }
    CellPlane& kept = to->variance;
    if (hasErrors)
        forRows(guides.cellsY, [&](int y) { compareCells(guides, *from, y, self.statistics); });
    forRows(guides.cellsY,
            [&](int y)
            {
                if (hasErrors)
                    keepDetail(guides, self.statistics, y, kept);
                else
                    std::fill_n(kept.row(y), guides.cellsX, 0.0f);
            });
    forRows(guides.height, [&](int y) { spreadCells(guides, *from, kept, y, image); });
}

} // namespace osgRayTrace::engine
