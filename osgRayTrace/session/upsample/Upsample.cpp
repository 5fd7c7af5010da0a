// Upsample.cpp - brings an image of fewer pixels to a view's full size, sharp at edges. Layer:
// session.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/session/upsample/Upsample.h"

#include "osgRayTrace/base/Parallel.h"
#include "osgRayTrace/film/Resolve.h"
#include "osgRayTrace/session/upsample/UpsampleEdges.h"

#include <algorithm>
#include <memory>

namespace osgRayTrace::engine
{

namespace
{

constexpr int kStripRows = 16; ///< rows of the full size that are made at once: whole blocks

/// Holds a row of the image at the full width.
struct WideRow
{
    explicit WideRow(std::size_t wide) : rgba(4 * wide), depth(wide) {}

    void make(const UpsampleSource& source, const UpsampleCells& cells, int wanted);

    int row = -1;
    std::vector<float> rgba, depth;
};

OSGRAYTRACE_KERNEL
void widenRgba(const float* __restrict in, const int* __restrict first,
               const float* __restrict share, int step, int count, float* __restrict out)
{
    for (int i = 0; i < count; ++i)
    {
        const float* a = in + 4 * first[i];
        const float* b = a + 4 * step;
        const float t = share[i];
        OSGRAYTRACE_SIMD
        for (int k = 0; k < 4; ++k)
            out[4 * i + k] = a[k] + t * (b[k] - a[k]);
    }
}

OSGRAYTRACE_KERNEL
void widenDepth(const float* __restrict in, const int* __restrict first,
                const float* __restrict share, int step, int count, float* __restrict out)
{
    OSGRAYTRACE_SIMD
    for (int i = 0; i < count; ++i)
    {
        const float a = in[first[i]], b = in[first[i] + step];
        out[i] = a + share[i] * (b - a);
    }
}

OSGRAYTRACE_KERNEL
void mix(const float* __restrict a, const float* __restrict b, float t, std::size_t count,
         float* __restrict out)
{
    OSGRAYTRACE_SIMD
    for (std::size_t i = 0; i < count; ++i)
        out[i] = a[i] + t * (b[i] - a[i]);
}

OSGRAYTRACE_KERNEL
void mixDepths(const float* __restrict a, const float* __restrict b, float t, std::size_t count,
               float* __restrict out)
{
    OSGRAYTRACE_SIMD
    for (std::size_t i = 0; i < count; ++i)
    {
        const float z = a[i] + t * (b[i] - a[i]);
        const float low = select(z > 0.0f, z, 0.0f);
        out[i] = select(low < 1.0f, low, 1.0f);
    }
}

void WideRow::make(const UpsampleSource& source, const UpsampleCells& cells, int wanted)
{
    if (row == wanted) return;
    row = wanted;
    const int width = source.image.width, step = width > 1 ? 1 : 0;
    const std::size_t begin = static_cast<std::size_t>(row) * static_cast<std::size_t>(width);
    const int wide = source.full.width;
    widenRgba(&source.image.radiance[4 * begin], source.x.first.data(), source.x.share.data(), step,
              wide, rgba.data());
    widenDepth(&cells.depth[begin], source.x.first.data(), source.x.share.data(), step, wide,
               depth.data());
}

/// Interpolates linearly between the image's pixels, whatever they see.
void interpolateRows(const UpsampleSource& source, const UpsampleCells& cells, int begin, int end,
                     float* rgba, float* depth)
{
    const auto wide = static_cast<std::size_t>(source.full.width);
    WideRow below(wide), above(wide);
    for (int y = begin; y < end; ++y)
    {
        const int row = source.y.first[static_cast<std::size_t>(y)];
        const float t = source.y.share[static_cast<std::size_t>(y)];
        if (above.row == row) std::swap(below, above);
        below.make(source, cells, row);
        above.make(source, cells, std::min(row + 1, source.image.height - 1));
        const std::size_t at = static_cast<std::size_t>(y - begin) * wide;
        mix(below.rgba.data(), above.rgba.data(), t, 4 * wide, rgba + 4 * at);
        if (depth) mixDepths(below.depth.data(), above.depth.data(), t, wide, depth + at);
    }
}

/// Returns whether the pixels from (left, bottom) to (right, top), both included, lie between
/// pixels of one smooth surface.
bool isSmooth(const UpsampleSource& source, const UpsampleCells& cells, std::size_t left,
              std::size_t right, std::size_t bottom, std::size_t top)
{
    if (source.x.outside[left] | source.x.outside[right] | source.y.outside[bottom] |
        source.y.outside[top])
        return false;
    uint8_t smooth = 1;
    for (int row = source.y.first[bottom]; row <= source.y.first[top]; ++row)
        for (int column = source.x.first[left]; column <= source.x.first[right]; ++column)
            smooth &=
                cells.smooth[static_cast<std::size_t>(row) * static_cast<std::size_t>(cells.width) +
                             static_cast<std::size_t>(column)];
    return smooth != 0;
}

/// Traces the blocks that are not smooth; null cells: all blocks.
UpsampleCounts traceBlocks(const UpsampleSource& source, const UpsampleCells* cells, int begin,
                           int end, float* rgba, float* depth)
{
    const int wide = source.full.width;
    UpsampleCounts counts;
    LastTriangle last;
    for (int bottom = begin; bottom < end; bottom += kBlockSize)
    {
        const int rows = std::min(kBlockSize, end - bottom);
        for (int left = 0; left < wide; left += kBlockSize)
        {
            const int columns = std::min(kBlockSize, wide - left);
            if (cells && isSmooth(source, *cells, static_cast<std::size_t>(left),
                                  static_cast<std::size_t>(left + columns - 1),
                                  static_cast<std::size_t>(bottom),
                                  static_cast<std::size_t>(bottom + rows - 1)))
                continue;
            UpsampledBlock block;
            traceUpsampled(source, left, bottom, last, block);
            for (int y = 0; y < rows; ++y)
                for (int x = 0; x < columns; ++x)
                {
                    const int lane = kBlockSize * y + x;
                    const std::size_t pixel = static_cast<std::size_t>(bottom - begin + y) *
                                                  static_cast<std::size_t>(wide) +
                                              static_cast<std::size_t>(left + x);
                    float* out = rgba + 4 * pixel;
                    out[0] = block.rgba.r[lane];
                    out[1] = block.rgba.g[lane];
                    out[2] = block.rgba.b[lane];
                    out[3] = block.rgba.a[lane];
                    if (depth) depth[pixel] = block.depth[lane];
                    counts.unlike += (block.unlike >> lane) & 1u;
                }
            counts.traced += static_cast<uint64_t>(rows * columns);
        }
    }
    return counts;
}

/// Calls finish(first row, rows, their radiance) for each strip; place(first row) returns where the
/// radiance is written.
template <class Place, class Finish>
UpsampleCounts forEachStrip(const ResolvedImage& image, const std::vector<SurfaceSample>& samples,
                            const PassContext& full, double mostTraced, const Workers& workers,
                            float* depth, const Place& place, const Finish& finish)
{
    const UpsampleSource source{image, samples.data(), full, UpsampleAxis(image.width, full.width),
                                UpsampleAxis(image.height, full.height)};
    const UpsampleView view{full.camera, full.traced->scene().unit, source.x, source.y, image.width,
                            image.height};
    const bool all = mostTraced == kAllTraced;
    const UpsampleCells cells = upsampleCells(samples, view, all ? 1.0 : mostTraced, workers);
    const auto strips = static_cast<std::size_t>((full.height + kStripRows - 1) / kStripRows);
    std::vector<UpsampleCounts> counts(strips);
    workers.forEach(strips,
                    [&](std::size_t strip)
                    {
                        const int begin = static_cast<int>(strip) * kStripRows;
                        const int end = std::min(full.height, begin + kStripRows);
                        const auto first =
                            static_cast<std::size_t>(begin) * static_cast<std::size_t>(full.width);
                        auto&& buffer = place(first);
                        float* rgba = &buffer[0];
                        float* depths = depth ? depth + first : nullptr;
                        if (!all) interpolateRows(source, cells, begin, end, rgba, depths);
                        counts[strip] =
                            traceBlocks(source, all ? nullptr : &cells, begin, end, rgba, depths);
                        finish(first, static_cast<std::size_t>((end - begin) * full.width), rgba);
                    });
    UpsampleCounts sum;
    sum.edges = cells.edges;
    sum.around = cells.around;
    for (const UpsampleCounts& strip : counts)
    {
        sum.traced += strip.traced;
        sum.unlike += strip.unlike;
    }
    return sum;
}

} // namespace

UpsampleCounts upsample(const ResolvedImage& image, const std::vector<SurfaceSample>& samples,
                        const PassContext& full, double mostTraced, const Workers& workers,
                        ResolvedImage& result)
{
    const auto pixels =
        static_cast<std::size_t>(full.width) * static_cast<std::size_t>(full.height);
    result.width = full.width;
    result.height = full.height;
    result.radiance.resize(4 * pixels);
    result.depth.resize(pixels);
    result.error.clear();
    return forEachStrip(
        image, samples, full, mostTraced, workers, result.depth.data(),
        [&](std::size_t first) { return &result.radiance[4 * first]; },
        [](std::size_t, std::size_t, const float*) {});
}

UpsampleCounts presentUpsampled(const ResolvedImage& image,
                                const std::vector<SurfaceSample>& samples, const PassContext& full,
                                double mostTraced, const ToneMap& toneMap, const Workers& workers,
                                uint8_t* rgba, float* depth)
{
    const std::size_t values = 4 * kStripRows * static_cast<std::size_t>(full.width);
    return forEachStrip(
        image, samples, full, mostTraced, workers, depth,
        [&](std::size_t) { return std::unique_ptr<float[]>(new float[values]); },
        [&](std::size_t first, std::size_t pixels, const float* radiance)
        { displayPixels(radiance, pixels, toneMap, rgba + 4 * first); });
}

} // namespace osgRayTrace::engine
