// ChannelImage.cpp - normals, distances and the like of a view's first hits. Layer: session.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/session/image/ChannelImage.h"

#include "osgRayTrace/base/Parallel.h"
#include "osgRayTrace/film/Resolve.h"
#include "osgRayTrace/integrators/shared/FirstHit.h"

#include <algorithm>

namespace osgRayTrace::engine
{

int channelSize(Channel channel)
{
    switch (channel)
    {
    case Channel::Depth:
    case Channel::Distance:
    case Channel::Id:
        return 1;
    case Channel::Normal:
    case Channel::Albedo:
    case Channel::Position:
    case Channel::Error:
        return 3;
    }
    return 0;
}

namespace
{

void writeChannel(Channel channel, const FirstHit& hit, const Scene& scene, float* out)
{
    switch (channel)
    {
    case Channel::Distance:
        out[0] = static_cast<float>(hit.distance * scene.unit);
        return;
    case Channel::Id:
        out[0] = hit.hit ? static_cast<float>(hit.instance + 1u) : 0.0f;
        return;
    case Channel::Normal:
        std::copy_n(&hit.normal.x, 3, out);
        return;
    case Channel::Albedo:
        std::copy_n(&hit.albedo.x, 3, out);
        return;
    case Channel::Position:
    {
        const Vec3 world =
            hit.hit ? Vec3(scene.origin + scene.unit * Vec3d(hit.position)) : Vec3(0.0f);
        std::copy_n(&world.x, 3, out);
        return;
    }
    case Channel::Depth:
    case Channel::Error:
        return; // the film holds the errors
    }
}

} // namespace

std::vector<float> channelImage(Channel channel, const Film& film, const PassContext& context,
                                const Workers& workers)
{
    const auto size = static_cast<std::size_t>(channelSize(channel));
    const auto width = static_cast<std::size_t>(film.width());
    std::vector<float> image(size * width * static_cast<std::size_t>(film.height()));
    const Scene& scene = context.traced->scene();
    workers.forEach(static_cast<std::size_t>(film.tileCount()),
                    [&](std::size_t index)
                    {
                        const int tile = static_cast<int>(index);
                        const int left = film.tileX(tile), bottom = film.tileY(tile);
                        if (channel == Channel::Error)
                        {
                            resolveTileError(film, tile, scene.displayReferred, image.data());
                            return;
                        }
                        if (channel == Channel::Depth)
                        {
                            resolveTileDepth(film, tile, image.data());
                            return;
                        }
                        FirstHit hits[kTilePixels];
                        firstHits(context, left, bottom, hits);
                        for (int b = 0; b < kTileBlocks; ++b)
                            for (int i = 0; i < kLanes; ++i)
                            {
                                const int x = left + laneX(b, i), y = bottom + laneY(b, i);
                                if (x >= film.width() || y >= film.height()) continue;
                                const std::size_t pixel = static_cast<std::size_t>(y) * width +
                                                          static_cast<std::size_t>(x);
                                writeChannel(channel, hits[b * kLanes + i], scene,
                                             &image[size * pixel]);
                            }
                    });
    return image;
}

void setSurfaceSamples(const SurfaceSample* tile, int left, int bottom, int width, int height,
                       std::vector<SurfaceSample>& samples)
{
    for (int b = 0; b < kTileBlocks; ++b)
    {
        const int x = left + laneX(b, 0), columns = std::min(kBlockSize, width - x);
        for (int row = 0; row < kBlockSize && columns > 0; ++row)
        {
            const int y = bottom + laneY(b, row * kBlockSize);
            if (y >= height) break;
            std::copy_n(tile + b * kLanes + row * kBlockSize, columns,
                        &samples[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                                 static_cast<std::size_t>(x)]);
        }
    }
}

void surfaceSamples(const PassContext& context, const Workers& workers,
                    std::vector<SurfaceSample>& samples)
{
    const int tilesX = (context.width + kTileSize - 1) / kTileSize;
    const int tilesY = (context.height + kTileSize - 1) / kTileSize;
    samples.resize(static_cast<std::size_t>(context.width) *
                   static_cast<std::size_t>(context.height));
    workers.forEach(static_cast<std::size_t>(tilesX) * static_cast<std::size_t>(tilesY),
                    [&](std::size_t index)
                    {
                        const int left = static_cast<int>(index) % tilesX * kTileSize;
                        const int bottom = static_cast<int>(index) / tilesX * kTileSize;
                        SurfaceSample tile[kTilePixels];
                        firstSamples(context, left, bottom, tile);
                        setSurfaceSamples(tile, left, bottom, context.width, context.height,
                                          samples);
                    });
}

} // namespace osgRayTrace::engine
