// GridMarch.cpp - the loops of osgVolume's shaders. Layer: media.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/media/GridMarch.h"

#include "osgRayTrace/base/Kernel.h"
#include "osgRayTrace/media/GridRay.h"
#include "osgRayTrace/media/VolumeSample.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace osgRayTrace::engine
{

namespace
{

/// The way of a ray through the image's unit cube.
struct March
{
    const Volume& volume;
    Vec3 from, to;       ///< where the ray enters and leaves
    Vec3 lightDirection; ///< of lit volumes
    float gradientStep;  ///< between the values of a gradient
};

/// Returns the number of steps of so many lengths, within bounds.
int stepCount(float length, float step, int most)
{
    const float count = std::ceil(length / step);
    return count >= 2.0f ? static_cast<int>(std::min(count, static_cast<float>(most))) : 2;
}

/// Tells how many steps of a ray lead through a block without any amount.
class EmptySteps
{
public:
    EmptySteps(const GridRecord& grid, Vec3 step) : _blocks(*grid.blocks)
    {
        const VolumeImage& image = *grid.volume->image;
        _scale = Vec3(Vec3d(image.width, image.height, image.depth)) /
                 static_cast<float>(ValueBlocks::kSide);
        _stepsPerBlock = 1.0f / (step * _scale); // infinite along the axes of a block
    }

    /// Returns the number of steps after a point of the unit cube that stay in its block, or fewer;
    /// 0 if there is anything in the block.
    int after(Vec3 p) const
    {
        const Vec3 at = p * _scale;
        const std::array<int, 3>& count = _blocks.values->count;
        std::size_t block = 0;
        float steps = kMost;
        for (int k = 2; k >= 0; --k)
        {
            const int size = count[static_cast<std::size_t>(k)];
            const int own = at[k] > 0.0f ? std::min(static_cast<int>(at[k]), size - 1) : 0;
            block = block * static_cast<std::size_t>(size) + static_cast<std::size_t>(own);
            const float border = static_cast<float>(_stepsPerBlock[k] > 0.0f ? own + 1 : own);
            steps = std::min(steps, (border - at[k]) * _stepsPerBlock[k]);
        }
        if (_blocks.most[block] > 0.0f || !(steps > 2.0f)) return 0;
        return static_cast<int>(steps) - 1; // sums of steps are rounded
    }

private:
    static constexpr float kMost = 8192.0f;

    const GridBlocks& _blocks;
    Vec3 _scale;         ///< blocks of the unit cube
    Vec3 _stepsPerBlock; ///< along each axis
};

/// Front to back, one step a cell and ratio.
OSGRAYTRACE_KERNEL
void marchCells(const GridRecord& grid, March march, MarchedVolume& result)
{
    const Volume& volume = march.volume;
    const VolumeImage& image = *volume.image;
    const Vec3 cell = 1.0f / Vec3(Vec3d(image.width, image.height, image.depth));
    constexpr int kMostSteps = 8192;
    const int count = stepCount(glm::length(march.to - march.from), cellStep(volume), kMostSteps);
    const Vec3 step = (march.to - march.from) / static_cast<float>(count - 1);
    const float scale = std::min(1.0f, 1.73f * glm::length(step) / glm::length(cell));
    march.gradientStep = gradientStep(volume, glm::length(step));
    const EmptySteps empty(grid, step);
    float left = 1.0f;
    constexpr float kCutoff = 1.0f / 256.0f;
    Vec3 p = march.from, sum(0.0f);
    int done = 0;
    for (; done < count && left >= kCutoff; ++done, p += step)
    {
        const VolumePoint point = volumePoint(volume, p);
        const float alpha = std::clamp(point.opacity * volume.transparency, 0.0f, 1.0f);
        if (!(alpha > 0.0f))
        {
            for (int rest = empty.after(p); rest > 0 && done + 1 < count; --rest, ++done)
                p += step; // one by one, so that all points are those without empty blocks
            continue;
        }
        const float behind = left * (scale < 1.0f ? std::pow(1.0f - alpha, scale) : 1.0f - alpha);
        const Vec3 color = volume.lit ? point.color * lightScale(image, p, march.gradientStep,
                                                                 march.lightDirection)
                                      : point.color;
        sum += color * (left - behind);
        left = behind;
    }
    result.opacity = done < count ? 1.0f : std::clamp(1.0f - left, 0.0f, 1.0f);
    result.color = sum * result.opacity; // the shader blends the sum by its opacity once more
}

/// Back to front, one step a sample length.
OSGRAYTRACE_KERNEL
void marchSamples(March march, MarchedVolume& result)
{
    const Volume& volume = march.volume;
    constexpr int kMostSteps = 2048;
    const int count = stepCount(glm::length(march.to - march.from),
                                std::max(volume.sampleLength, 1e-6f), kMostSteps);
    const Vec3 step = (march.from - march.to) / static_cast<float>(count - 1);
    march.gradientStep = gradientStep(volume, 0.0f);
    Vec3 p = march.to, color(0.0f);
    float sum = 0.0f;
    for (int k = 0; k < count; ++k, p += step)
    {
        const Voxel voxel = voxelAt(*volume.image, p);
        Vec4 here(voxel.color, voxel.value);
        if (!volume.transfer.empty()) here = transferred(volume, voxel.value);
        if (volume.lit)
            here = Vec4(Vec3(here) *
                            lightScale(*volume.image, p, march.gradientStep, march.lightDirection),
                        here.w);
        here.w = std::clamp(here.w, 0.0f, 1.0f); // as in textures of OpenGL
        const float alpha = std::clamp(here.w * volume.transparency, 0.0f, 1.0f);
        if (alpha > volume.cutoff)
        {
            color = color * (1.0f - alpha) + Vec3(here) * alpha;
            sum += alpha;
        }
        if (sum < here.w)
        {
            color = Vec3(here);
            sum = here.w;
        }
    }
    const float opacity = std::min(sum * volume.transparency, 1.0f);
    if (opacity < volume.cutoff) return;
    result.opacity = std::max(opacity, 0.0f);
    result.color = color * volume.tint * result.opacity;
}

} // namespace

MarchedVolume march(const GridRecord& grid, Vec3 origin, Vec3 direction, float begin, float end,
                    const VolumeLight& light)
{
    RayPart part{begin, end};
    clipToCube(grid.tileFromEngine, origin, direction, part);
    clipToCube(grid.imageFromEngine, origin, direction, part);
    MarchedVolume result;
    if (part.isEmpty() || !(part.end < kInfinity)) return result;
    const Vec3 exit = origin + direction * part.end;
    March way{*grid.volume, transformPoint(grid.imageFromEngine, origin + direction * part.begin),
              transformPoint(grid.imageFromEngine, exit), Vec3(0.0f), 0.0f};
    if (!isFinite(way.from) || !isFinite(way.to)) return result; // the box is too small for floats
    if (grid.volume->lit) way.lightDirection = litDirection(grid, light, exit);
    result.begin = part.begin;
    if (grid.volume->law == VolumeLaw::Samples)
        marchSamples(way, result);
    else
        marchCells(grid, way, result);
    return result;
}

} // namespace osgRayTrace::engine
