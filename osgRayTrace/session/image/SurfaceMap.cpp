// SurfaceMap.cpp - the places of the surfaces of a view's pixels. Layer: session.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/session/image/SurfaceMap.h"

#include "osgRayTrace/base/Lanes.h"
#include "osgRayTrace/base/Parallel.h"

#include <algorithm>
#include <cmath>

namespace osgRayTrace::engine
{

namespace
{

/// Returns the eye of a perspective view, or a point of the near plane of an orthographic one.
std::optional<Vec3d> poleOf(const View& view)
{
    const Mat4d worldFromClip = glm::inverse(view.clipFromView * view.viewFromWorld);
    const Mat4d viewFromClip = glm::inverse(view.clipFromView);
    Vec4d pole = viewFromClip * Vec4d(0.0, 0.0, 1.0, 0.0);
    const bool orthographic = std::abs(pole.w) <= 1e-14 * glm::length(Vec3d(pole));
    pole = orthographic ? worldFromClip * Vec4d(0.0, 0.0, -1.0, 1.0)
                        : glm::inverse(view.viewFromWorld) * pole;
    const Vec3d place = Vec3d(pole) / pole.w;
    const double sum = place.x + place.y + place.z;
    if (sum - sum != 0.0) return std::nullopt;
    return place;
}

/// Points to one row of the map.
struct Row
{
    const float* normalX;
    const float* normalY;
    const float* normalZ;
    const float* along;
    const uint32_t* object;
};

Row rowOf(const SurfaceMap& map, std::size_t y, std::size_t x = 0)
{
    const std::size_t first = y * static_cast<std::size_t>(map.view.width) + x;
    return {&map.normalX[first], &map.normalY[first], &map.normalZ[first], &map.along[first],
            &map.object[first]};
}

/// Clears same[i] unless pixel i of row a and the pixel of row b that is (right, up) pixels away
/// show one surface.
OSGRAYTRACE_KERNEL
void compareRows(const PixelRays& pixelRays, const Row& a, float y, const Row& b, float right,
                 float up, std::size_t count, uint32_t* __restrict same)
{
    const CameraRays c = pixelRays.rays;
    const float footprint = pixelRays.footprint;
    const uint32_t orthographic = maskOf(c.orthographic);
    const float *nx = a.normalX, *ny = a.normalY, *nz = a.normalZ, *alongA = a.along;
    const float *mx = b.normalX, *my = b.normalY, *mz = b.normalZ, *alongB = b.along;
    const uint32_t *objectA = a.object, *objectB = b.object;
    const Vec3 direction = c.direction + y * c.directionDy, step = c.directionDx;
    const Vec3 startMove = right * c.originDx + up * c.originDy;
    const Vec3 directionMove = right * c.directionDx + up * c.directionDy;
    OSGRAYTRACE_SIMD
    for (std::size_t i = 0; i < count; ++i)
    {
        // pB - pA = E(B) - E(A) + (sB - sA) D(A) + sB (D(B) - D(A))has no difference of large
        // numbers.
        const float x = static_cast<float>(static_cast<int>(i)) + 0.5f;
        const float sA = alongA[i], sB = alongB[i], deeper = sB - sA;
        const float dx = startMove.x + deeper * (direction.x + x * step.x) + sB * directionMove.x;
        const float dy = startMove.y + deeper * (direction.y + x * step.y) + sB * directionMove.y;
        const float dz = startMove.z + deeper * (direction.z + x * step.z) + sB * directionMove.z;
        const float offPlane = std::fabs(nx[i] * dx + ny[i] * dy + nz[i] * dz);
        const float cosine = nx[i] * mx[i] + ny[i] * my[i] + nz[i] * mz[i];
        const float tolerance = kPlaneTolerance * footprint * select(orthographic, 1.0f, sA);
        // Neither holds for NaN.
        const uint32_t surface = maskOf(offPlane <= tolerance) & maskOf(cosine >= kNormalCosine);
        const uint32_t nothing = maskOf(objectA[i] == 0u);
        same[i] = same[i] & maskOf(objectA[i] == objectB[i]) & (surface | nothing);
    }
}

/// Finds the smooth pixels of a row. Pixels beyond the image count as those at its border.
void findEdges(SurfaceMap& map, std::size_t y, std::vector<uint32_t>& same,
               std::vector<uint32_t>& pairs)
{
    const auto width = static_cast<std::size_t>(map.view.width);
    const auto height = static_cast<std::size_t>(map.view.height);
    const float at = static_cast<float>(static_cast<int>(y)) + 0.5f;
    const Row row = rowOf(map, y);
    std::fill(same.begin(), same.end(), 0xffffffffu);
    std::fill(pairs.begin(), pairs.end(), 0xffffffffu);
    if (width > 1)
        compareRows(map.rays, row, at, rowOf(map, y, 1), 1.0f, 0.0f, width - 1, &pairs[1]);
    if (y > 0) compareRows(map.rays, row, at, rowOf(map, y - 1), 0.0f, -1.0f, width, same.data());
    if (y + 1 < height)
        compareRows(map.rays, row, at, rowOf(map, y + 1), 0.0f, 1.0f, width, same.data());
    uint8_t* smooth = &map.smooth[y * width];
    for (std::size_t x = 0; x < width; ++x) // pairs[x] compares x - 1 and x
        smooth[x] = static_cast<uint8_t>(same[x] & pairs[x] & pairs[x + 1] & 1u);
}

void findInterior(SurfaceMap& map, std::size_t y, std::vector<uint8_t>& columns)
{
    const auto width = static_cast<std::size_t>(map.view.width);
    const auto height = static_cast<std::size_t>(map.view.height);
    const uint8_t* row = &map.smooth[y * width];
    const uint8_t* below = y > 0 ? row - width : row;
    const uint8_t* above = y + 1 < height ? row + width : row;
    for (std::size_t x = 0; x < width; ++x)
        columns[x + 1] = below[x] & row[x] & above[x];
    columns.front() = columns[1];
    columns.back() = columns[width];
    uint8_t* interior = &map.interior[y * width];
    for (std::size_t x = 0; x < width; ++x)
        interior[x] = columns[x] & columns[x + 1] & columns[x + 2];
}

void resize(SurfaceMap& map, std::size_t pixels)
{
    for (std::vector<float>* values :
         {&map.normalX, &map.normalY, &map.normalZ, &map.along, &map.lobe})
        values->resize(pixels);
    map.object.resize(pixels);
    map.smooth.resize(pixels);
    map.interior.resize(pixels);
}

} // namespace

std::optional<PixelRays> pixelRays(const View& view)
{
    const std::optional<Vec3d> pole = poleOf(view);
    if (!pole) return std::nullopt;
    const std::optional<CameraRays> rays = cameraRays(view, *pole);
    if (!rays) return std::nullopt;
    PixelRays result;
    result.pole = *pole;
    result.rays = *rays;
    const Vec3 &dx = rays->orthographic ? rays->originDx : rays->directionDx,
               &dy = rays->orthographic ? rays->originDy : rays->directionDy;
    result.footprint = std::max(glm::length(dx), glm::length(dy));
    return result;
}

void forEachRows(const Workers& workers, int height,
                 const std::function<void(std::size_t, std::size_t)>& body)
{
    constexpr std::size_t kRows = 16;
    const auto rows = static_cast<std::size_t>(height);
    workers.forEach((rows + kRows - 1) / kRows,
                    [&](std::size_t i) { body(i * kRows, std::min(rows, (i + 1) * kRows)); });
}

bool beginSurfaceMap(const View& view, SurfaceMap& map)
{
    const std::optional<PixelRays> rays = pixelRays(view);
    map.view = View();
    map.finished = false;
    if (!rays) return false;
    resize(map, static_cast<std::size_t>(view.width) * static_cast<std::size_t>(view.height));
    map.view = view;
    map.rays = *rays;
    return true;
}

void setBlock(int left, int bottom, const SurfaceBlock& block, SurfaceMap& map)
{
    const int width = map.view.width;
    const int columns = std::min(kBlockSize, width - left);
    const int rows = std::min(kBlockSize, map.view.height - bottom);
    for (int y = 0; y < rows; ++y)
    {
        const int lane = y * kBlockSize;
        const auto pixel = static_cast<std::size_t>(bottom + y) * static_cast<std::size_t>(width) +
                           static_cast<std::size_t>(left);
        std::copy_n(block.normal.x.v + lane, columns, &map.normalX[pixel]);
        std::copy_n(block.normal.y.v + lane, columns, &map.normalY[pixel]);
        std::copy_n(block.normal.z.v + lane, columns, &map.normalZ[pixel]);
        std::copy_n(block.along.v + lane, columns, &map.along[pixel]);
        std::copy_n(block.lobe.v + lane, columns, &map.lobe[pixel]);
        std::copy_n(block.object.v + lane, columns, &map.object[pixel]);
    }
}

bool isSmooth(const SurfaceMap& map, int left, int bottom)
{
    const int right = std::min(left + kBlockSize, map.view.width);
    const int top = std::min(bottom + kBlockSize, map.view.height);
    uint8_t smooth = 1;
    for (int y = bottom; y < top; ++y)
        for (int x = left; x < right; ++x)
            smooth &=
                map.smooth[static_cast<std::size_t>(y) * static_cast<std::size_t>(map.view.width) +
                           static_cast<std::size_t>(x)];
    return smooth != 0;
}

void findSmooth(const Workers& workers, SurfaceMap& map)
{
    const auto width = static_cast<std::size_t>(map.view.width);
    forEachRows(workers, map.view.height,
                [&](std::size_t first, std::size_t end)
                {
                    std::vector<uint32_t> same(width), pairs(width + 1);
                    for (std::size_t y = first; y < end; ++y)
                        findEdges(map, y, same, pairs);
                });
}

void findInteriors(const Workers& workers, SurfaceMap& map)
{
    const auto width = static_cast<std::size_t>(map.view.width);
    forEachRows(workers, map.view.height,
                [&](std::size_t first, std::size_t end)
                {
                    std::vector<uint8_t> columns(width + 2);
                    for (std::size_t y = first; y < end; ++y)
                        findInterior(map, y, columns);
                });
}

} // namespace osgRayTrace::engine
