// PathQueue.cpp - moves the paths of a tile that go on into full blocks. Layer: integrators.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/integrators/path/PathQueue.h"

#include <algorithm>

namespace osgRayTrace::engine
{

void copyPath(const PathBlock& from, int i, PathBlock& to, int k)
{
    to.rays.ray.originX[k] = from.rays.ray.originX[i];
    to.rays.ray.originY[k] = from.rays.ray.originY[i];
    to.rays.ray.originZ[k] = from.rays.ray.originZ[i];
    to.rays.ray.tNear[k] = from.rays.ray.tNear[i];
    to.rays.ray.directionX[k] = from.rays.ray.directionX[i];
    to.rays.ray.directionY[k] = from.rays.ray.directionY[i];
    to.rays.ray.directionZ[k] = from.rays.ray.directionZ[i];
    setLane(to.throughput, k, plainOf(from.throughput, i));
    to.pdfW[k] = from.pdfW[i];
    to.etaScale[k] = from.etaScale[i];
    to.seed[k] = from.seed[i];
    to.flags[k] = from.flags[i];
    to.cones.width[k] = from.cones.width[i];
    to.cones.spread[k] = from.cones.spread[i];
    to.depth[k] = from.depth[i];
    to.bodies[k] = from.bodies[i];
}

void clearRays(RayBlock& ray)
{
    for (int i = 0; i < kLanes; ++i)
    {
        ray.time[i] = 0.0f;
        ray.id[i] = ray.flags[i] = 0;
    }
}

namespace
{

void moveVertex(const PathBlock& from, int i, PathBlock& to, int k)
{
    setLane(to.vertices.position, k, plainOf(from.vertices.position, i));
    setLane(to.vertices.normal, k, plainOf(from.vertices.normal, i));
}

} // namespace

PathPlace addPath(PathQueue& paths, const PathBlock& from, int i, bool withVertices)
{
    OSGRAYTRACE_ASSERT(paths.hasRoom());
    PathBlock& to = paths.blocks[paths.count + paths.added / kLanes];
    const int lane = paths.added++ % kLanes;
    if (lane == 0) clearRays(to.rays.ray);
    copyPath(from, i, to, lane);
    if (withVertices) moveVertex(from, i, to, lane);
    to.active = lane == 0 ? 1u : to.active | (1u << lane);
    return {to, lane};
}

void compactPaths(PathQueue& paths, bool withVertices)
{
    int count = 0;
    const int used = paths.count + (paths.added + kLanes - 1) / kLanes;
    paths.added = 0;
    for (int b = 0; b < used; ++b)
    {
        PathBlock& from = paths.blocks[b];
        for (const int i : lanesIn(from.active))
        {
            if (count != b * kLanes + i)
            {
                PathBlock& to = paths.blocks[count / kLanes];
                copyPath(from, i, to, count % kLanes);
                if (withVertices) moveVertex(from, i, to, count % kLanes);
            }
            ++count;
        }
    }
    paths.count = (count + kLanes - 1) / kLanes;
    for (int b = 0; b < paths.count; ++b)
    {
        PathBlock& block = paths.blocks[b];
        const int lanes = std::min(kLanes, count - b * kLanes);
        block.active = (1u << lanes) - 1u;
        for (int i = 0; i < kLanes; ++i)
            block.rays.ray.tFar[i] = kInfinity;
    }
}

} // namespace osgRayTrace::engine
