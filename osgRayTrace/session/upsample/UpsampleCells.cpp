// UpsampleCells.cpp - the cells of an image in which one may interpolate. Layer: session.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/session/upsample/UpsampleCells.h"

#include "osgRayTrace/base/Lanes.h"
#include "osgRayTrace/base/Parallel.h"

#include <algorithm>
#include <cmath>

namespace osgRayTrace::engine
{

namespace
{

/// Largest distance of neighbours from a straight line through two others, in pixels of the image.
/// Between them the surface is an eighth of that off at most, if its curvature stays the same.
constexpr float kBend = 0.25f;
constexpr float kLeastCosine = 0.95f; ///< least cosine between the neighbours' normals
/// Albedos that differ more belong to a texture, which is looked up.
constexpr float kAlbedoStep = 0.05f;

/// Holds inverse distances with a margin of zeros, the value of pixels that see nothing.
class DistancePlane
{
public:
    DistancePlane(std::size_t width, std::size_t height)
        : _stride(width + 2 * kMargin), _values(_stride * (height + 2 * kMargin))
    {
    }

    float* row(std::size_t y) { return &_values[(y + kMargin) * _stride + kMargin]; }
    const float* row(std::size_t y) const { return &_values[(y + kMargin) * _stride + kMargin]; }
    int stride() const { return static_cast<int>(_stride); }

private:
    static constexpr int kMargin = 2;

    std::size_t _stride;
    std::vector<float> _values;
};

/// Gives the points of a row of pixels: origin + s * direction, linear in the pixel's number.
struct RowRays
{
    Vec3 origin, originStep, direction, directionStep;
};

RowRays rowRays(const CameraRays& c, float scaleX, float y)
{
    const float x0 = 0.5f * scaleX;
    return {c.origin + x0 * c.originDx + y * c.originDy, scaleX * c.originDx,
            c.direction + x0 * c.directionDx + y * c.directionDy, scaleX * c.directionDx};
}

/// Computes window depths, and the quantity that is linear on the image of a plane: 1/s, or s if
/// the view is orthographic.
OSGRAYTRACE_KERNEL
void linearDistances(const CameraRays& camera, const RowRays& row, const SurfaceSample* samples,
                     int count, float inverseUnit, float* __restrict depth,
                     float* __restrict linear)
{
    const Vec4 zRow = camera.depthRow, wRow = camera.wRow;
    const RowRays r = row;
    const uint32_t orthographic = maskOf(camera.orthographic);
    const float* distances = &samples->distance;
    constexpr int kStride = sizeof(SurfaceSample) / sizeof(float);
    OSGRAYTRACE_SIMD
    for (int i = 0; i < count; ++i)
    {
        const float x = static_cast<float>(i);
        const float ox = r.origin.x + x * r.originStep.x, oy = r.origin.y + x * r.originStep.y,
                    oz = r.origin.z + x * r.originStep.z;
        const float dx = r.direction.x + x * r.directionStep.x,
                    dy = r.direction.y + x * r.directionStep.y,
                    dz = r.direction.z + x * r.directionStep.z;
        const float distance = distances[kStride * i] * inverseUnit;
        const float length = std::sqrt(dx * dx + dy * dy + dz * dz);
        const uint32_t hit = maskOf(distance < kInfinity);
        const float s = select(hit, distance / length, 1.0f);
        const float px = ox + s * dx, py = oy + s * dy, pz = oz + s * dz;
        const float z = zRow.x * px + zRow.y * py + zRow.z * pz + zRow.w;
        const float w = wRow.x * px + wRow.y * py + wRow.z * pz + wRow.w;
        depth[i] = select(hit, 0.5f * (z / w) + 0.5f, 1.0f);
        linear[i] = select(hit, select(orthographic, s, 1.0f / s), 0.0f);
    }
}

/// Limits how far three neighbours may be off a straight line, on the plane of inverse distances:
/// relative to the middle one in a perspective view, absolute in an orthographic one.
struct Bend
{
    float relative, absolute;
};

/// Sets agree to whether the samples and those a step farther see one surface.
OSGRAYTRACE_KERNEL
void agreements(const SurfaceSample* samples, int step, const float* linear, int linearStep,
                Bend largest, int count, uint8_t* __restrict agree)
{
    const float relative = largest.relative, absolute = largest.absolute;
    const float* a = &samples->normal.x;
    const uint32_t* objects = &samples->object;
    constexpr int kStride = sizeof(SurfaceSample) / sizeof(float);
    const int far = kStride * step;
    OSGRAYTRACE_SIMD
    for (int i = 0; i < count; ++i)
    {
        const float* q = linear + i;
        const float here = std::fabs(q[-linearStep] - 2.0f * q[0] + q[linearStep]);
        const float there = std::fabs(q[0] - 2.0f * q[linearStep] + q[2 * linearStep]);
        const float bend = select(here < there, here, there);
        const int k = kStride * i, m = k + far;
        const float cosine = a[k] * a[m] + a[k + 1] * a[m + 1] + a[k + 2] * a[m + 2];
        const float red = std::fabs(a[k + 4] - a[m + 4]), green = std::fabs(a[k + 5] - a[m + 5]),
                    blue = std::fabs(a[k + 6] - a[m + 6]);
        const uint32_t object = objects[k], other = objects[m];
        const uint32_t one = maskOf(object == other);
        const uint32_t nothing = maskOf(object == 0u);
        const uint32_t flat = maskOf(bend <= relative * q[0] + absolute) &
                              maskOf(cosine >= kLeastCosine) & maskOf(red <= kAlbedoStep) &
                              maskOf(green <= kAlbedoStep) & maskOf(blue <= kAlbedoStep);
        agree[i] = static_cast<uint8_t>(one & (nothing | flat) & 1u);
    }
}

OSGRAYTRACE_KERNEL
void joinCells(const uint8_t* right, const uint8_t* rightAbove, const uint8_t* up, int count,
               uint8_t* __restrict smooth)
{
    OSGRAYTRACE_SIMD
    for (int i = 0; i < count; ++i)
        smooth[i] = right[i] & rightAbove[i] & up[i] & up[i + 1];
}

/// Keeps the smooth cells that have only smooth cells beside them; the rows below and above may be
/// the same one.
OSGRAYTRACE_KERNEL
void erode(const uint8_t* below, const uint8_t* row, const uint8_t* above, int count,
           uint8_t* __restrict eroded)
{
    OSGRAYTRACE_SIMD
    for (int i = 1; i < count - 1; ++i)
        eroded[i] = (below[i - 1] & below[i] & below[i + 1]) & (row[i - 1] & row[i] & row[i + 1]) &
                    (above[i - 1] & above[i] & above[i + 1]);
    const int last = count - 1, second = count > 1 ? 1 : 0;
    eroded[0] = below[0] & below[second] & row[0] & row[second] & above[0] & above[second];
    eroded[last] = below[last] & below[last - second] & row[last] & row[last - second] &
                   above[last] & above[last - second];
}

/// Returns the share of the cells that are not smooth.
double edges(const std::vector<uint8_t>& smooth, std::size_t columns, std::size_t rows,
             std::size_t stride)
{
    std::size_t count = 0;
    for (std::size_t row = 0; row < rows; ++row)
        count += static_cast<std::size_t>(
            std::count(&smooth[row * stride], &smooth[row * stride] + columns, uint8_t(0)));
    return static_cast<double>(count) / static_cast<double>(columns * rows);
}

Bend largestBend(const UpsampleView& view)
{
    // The length is a pixel's width over its distance in the middle of the image; in an
    // orthographic view it is the width.
    const CameraRays& camera = view.camera;
    const auto middleX = 0.5f * view.x.scale * static_cast<float>(view.width);
    const auto middleY = 0.5f * view.y.scale * static_cast<float>(view.height);
    const float length =
        glm::length(camera.direction + middleX * camera.directionDx + middleY * camera.directionDy);
    const float pixel = std::max(view.x.scale * glm::length(camera.directionDx + camera.originDx),
                                 view.y.scale * glm::length(camera.directionDy + camera.originDy)) /
                        length;
    return camera.orthographic ? Bend{0.0f, kBend * pixel} : Bend{kBend * pixel, 0.0f};
}

/// Returns 1 for the cells whose four pixels agree, as many in a row as the image has pixels.
std::vector<uint8_t> flatCells(const std::vector<SurfaceSample>& samples, const UpsampleView& view,
                               const DistancePlane& linear, const Workers& workers)
{
    // Rows of pairs are computed once more for each range of cells, which costs less than a pass of
    // their own.
    constexpr std::size_t kRows = 16;
    const auto w = static_cast<std::size_t>(view.width);
    const std::size_t cellRows = static_cast<std::size_t>(view.height) - 1;
    const Bend bend = largestBend(view);
    std::vector<uint8_t> flat(w * cellRows);
    const auto joinRange = [&](std::size_t range)
    {
        std::vector<uint8_t> right(w), rightAbove(w), up(w);
        const auto pairs = [&](std::size_t row, bool above, std::vector<uint8_t>& agree)
        {
            agreements(&samples[row * w], above ? view.width : 1, linear.row(row),
                       above ? linear.stride() : 1, bend, above ? view.width : view.width - 1,
                       agree.data());
        };
        const std::size_t begin = range * kRows, end = std::min(cellRows, begin + kRows);
        pairs(begin, false, right);
        for (std::size_t row = begin; row < end; ++row)
        {
            pairs(row + 1, false, rightAbove);
            pairs(row, true, up);
            joinCells(right.data(), rightAbove.data(), up.data(), view.width - 1, &flat[row * w]);
            right.swap(rightAbove);
        }
    };
    workers.forEach((cellRows + kRows - 1) / kRows, joinRange);
    return flat;
}

} // namespace

UpsampleAxis::UpsampleAxis(int small, int large)
    : scale(static_cast<float>(large) / static_cast<float>(small)),
      first(static_cast<std::size_t>(large)),
      share(first.size()),
      outside(first.size())
{
    for (int i = 0; i < large; ++i)
    {
        const double at = (i + 0.5) * small / large - 0.5;
        const int low = std::clamp(static_cast<int>(std::floor(at)), 0, std::max(0, small - 2));
        const auto pixel = static_cast<std::size_t>(i);
        first[pixel] = low;
        share[pixel] = static_cast<float>(std::clamp(at - low, 0.0, 1.0));
        outside[pixel] = at < 0.0 || at > small - 1;
    }
}

UpsampleCells upsampleCells(const std::vector<SurfaceSample>& samples, const UpsampleView& view,
                            double mostEdges, const Workers& workers)
{
    const auto w = static_cast<std::size_t>(view.width), h = static_cast<std::size_t>(view.height);
    UpsampleCells cells;
    cells.width = view.width;
    cells.height = view.height;
    cells.depth.resize(w * h);
    cells.smooth.resize(w * h);
    DistancePlane linear(w, h);
    workers.forEach(h,
                    [&](std::size_t row)
                    {
                        const RowRays rays =
                            rowRays(view.camera, view.x.scale,
                                    (static_cast<float>(row) + 0.5f) * view.y.scale);
                        linearDistances(view.camera, rays, &samples[row * w], view.width,
                                        static_cast<float>(1.0 / view.unit), &cells.depth[row * w],
                                        linear.row(row));
                    });
    const std::size_t cellRows = h - 1;
    if (w < 2 || cellRows == 0) return cells; // all cells are at the image's edge
    const std::vector<uint8_t> flat = flatCells(samples, view, linear, workers);
    workers.forEach(cellRows,
                    [&](std::size_t row)
                    {
                        const uint8_t* below = &flat[(row > 0 ? row - 1 : row) * w];
                        const uint8_t* above = &flat[(row + 1 < cellRows ? row + 1 : row) * w];
                        erode(below, &flat[row * w], above, view.width - 1, &cells.smooth[row * w]);
                    });
    cells.around = edges(cells.smooth, w - 1, cellRows, w);
    cells.edges = edges(flat, w - 1, cellRows, w);
    if (cells.around <= mostEdges) return cells;
    std::copy(flat.begin(), flat.end(), cells.smooth.begin());
    if (cells.edges <= mostEdges) return cells;
    std::fill(cells.smooth.begin(), cells.smooth.end(), uint8_t(1));
    return cells;
}

} // namespace osgRayTrace::engine
