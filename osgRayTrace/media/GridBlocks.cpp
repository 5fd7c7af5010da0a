// GridBlocks.cpp - finds bounds of volumes, through their transfer functions. Layer: media.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/media/GridBlocks.h"

#include "osgRayTrace/base/Parallel.h"
#include "osgRayTrace/media/VolumeSample.h"

#include <algorithm>
#include <cmath>

namespace osgRayTrace::engine
{

namespace
{

/// Sets the bounds of one block. A look-up in it reads the voxels of the block and their
/// neighbours; beyond the image they are 0.
void boundBlock(const VolumeImage& image, ValueBlocks& blocks, std::size_t block)
{
    const std::array<int, 3> size{image.width, image.height, image.depth};
    std::array<int, 3> low, high;
    std::size_t rest = block;
    float least = kInfinity, most = -kInfinity;
    for (std::size_t k = 0; k < 3; ++k)
    {
        const int at = static_cast<int>(rest % static_cast<std::size_t>(blocks.count[k]));
        rest /= static_cast<std::size_t>(blocks.count[k]);
        low[k] = at * ValueBlocks::kSide - 1;
        high[k] = (at + 1) * ValueBlocks::kSide;
        if (low[k] < 0 || high[k] >= size[k]) least = most = 0.0f;
        low[k] = std::max(low[k], 0);
        high[k] = std::min(high[k], size[k] - 1);
    }
    const bool isBytes = image.floats.empty();
    const auto channels = static_cast<std::size_t>(image.channels);
    for (int z = low[2]; z <= high[2]; ++z)
        for (int y = low[1]; y <= high[1]; ++y)
        {
            const std::size_t row = (static_cast<std::size_t>(z) * std::size_t(image.height) +
                                     static_cast<std::size_t>(y)) *
                                    static_cast<std::size_t>(image.width);
            for (int x = low[0]; x <= high[0]; ++x)
            {
                const std::size_t at =
                    (row + static_cast<std::size_t>(x)) * channels + channels - 1;
                const float value = isBytes ? static_cast<float>(image.bytes[at]) * (1.0f / 255.0f)
                                            : image.floats[at];
                least = std::min(least, value);
                most = std::max(most, value);
            }
        }
    // Interpolation may round a value up by a few units in the last place.
    const float slack = 1e-6f * std::max(std::fabs(least), std::fabs(most));
    blocks.least[block] = least - slack;
    blocks.most[block] = most + slack;
}

/// The least and the largest opacity of the entries of a transfer function from any one to any
/// other, in constant time: level k has the bounds of 2^k entries from each one on.
class TransferRanges
{
public:
    explicit TransferRanges(const std::vector<Vec4>& entries)
    {
        std::vector<Range> level(entries.size() + 2, Range{0.0f, 0.0f}); // with a border
        for (std::size_t i = 0; i < entries.size(); ++i)
            level[i + 1] = {entries[i].w, entries[i].w};
        const std::size_t size = level.size();
        _levels.push_back(level);
        for (std::size_t step = 1; 2 * step <= size; step *= 2)
        {
            const std::vector<Range>& below = _levels.back();
            std::vector<Range> next(size - 2 * step + 1);
            for (std::size_t i = 0; i < next.size(); ++i)
                next[i] = joined(below[i], below[i + step]);
            _levels.push_back(std::move(next));
        }
    }

    struct Range
    {
        float least, most;
    };

    static Range joined(Range a, Range b)
    {
        return {std::min(a.least, b.least), std::max(a.most, b.most)};
    }

    /// Returns the bounds of the entries first to last, first <= last.
    Range of(std::size_t first, std::size_t last) const
    {
        std::size_t level = 0;
        while ((std::size_t(2) << level) <= last - first + 1)
            ++level;
        return joined(_levels[level][first], _levels[level][last + 1 - (std::size_t(1) << level)]);
    }

private:
    std::vector<std::vector<Range>> _levels;
};

/// Returns the bounds of the opacities that a volume gives to values from least to most.
TransferRanges::Range opacities(const Volume& volume, const TransferRanges& ranges, float least,
                                float most)
{
    const float one = transferPlace(volume, least), other = transferPlace(volume, most);
    const float a = std::min(one, other), b = std::max(one, other);
    return ranges.of(static_cast<std::size_t>(std::floor(a)),
                     static_cast<std::size_t>(std::ceil(b)));
}

} // namespace

std::shared_ptr<const ValueBlocks> ValueBlocks::of(const VolumeImage& image, const Workers* workers)
{
    const auto blocks = std::make_shared<ValueBlocks>();
    const std::array<int, 3> size{image.width, image.height, image.depth};
    std::size_t total = 1;
    for (std::size_t k = 0; k < 3; ++k)
    {
        blocks->count[k] = (size[k] + kSide - 1) / kSide;
        total *= static_cast<std::size_t>(blocks->count[k]);
    }
    blocks->least.resize(total);
    blocks->most.resize(total);
    constexpr std::size_t kGrain = 64;
    forEachPart(workers, total, kGrain,
                [&](std::size_t begin, std::size_t end)
                {
                    for (std::size_t i = begin; i < end; ++i)
                        boundBlock(image, *blocks, i);
                });
    return blocks;
}

std::shared_ptr<const GridBlocks> GridBlocks::of(const Volume& volume,
                                                 std::shared_ptr<const ValueBlocks> values)
{
    const auto blocks = std::make_shared<GridBlocks>();
    const std::size_t count = values->most.size();
    blocks->least.resize(count);
    blocks->most.resize(count);
    const TransferRanges ranges(volume.transfer.empty() ? std::vector<Vec4>(1) : volume.transfer);
    for (std::size_t i = 0; i < count; ++i)
    {
        TransferRanges::Range opacity{values->least[i], values->most[i]};
        if (!volume.transfer.empty())
            opacity = opacities(volume, ranges, values->least[i], values->most[i]);
        // Where values are cut off, there is nothing.
        const bool byOpacity = volume.law == VolumeLaw::Samples;
        const float least = byOpacity ? opacity.least * volume.transparency : values->least[i];
        const float most = byOpacity ? opacity.most * volume.transparency : values->most[i];
        if (!(most < volume.cutoff)) blocks->most[i] = amountOf(volume, opacity.most) * 1.00001f;
        if (!(least < volume.cutoff)) blocks->least[i] = amountOf(volume, opacity.least) * 0.99999f;
    }
    blocks->values = std::move(values);
    return blocks;
}

} // namespace osgRayTrace::engine
