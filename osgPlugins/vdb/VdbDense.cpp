// VdbDense.cpp - finds the bounds of a tree, then fills an image. Layer: osgPlugins.
// SPDX-License-Identifier: MIT
#include "osgPlugins/vdb/VdbDense.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace osgRayTrace::vdb
{

namespace
{

/// Sums of values stay finite.
constexpr float kLargestValue = 1e30f;

/// Finds the bounds of active voxels, and where leaves are.
class Surveyor : public VdbVisitor
{
public:
    VdbIndex low, high; ///< high: one beyond the last voxel
    std::vector<VdbIndex> leaves;

    Surveyor()
    {
        low.fill(std::numeric_limits<std::int64_t>::max());
        high.fill(std::numeric_limits<std::int64_t>::min());
    }

    bool isEmpty() const { return low[0] >= high[0]; }

    void tile(const VdbIndex& at, int side, float, bool active) override
    {
        if (active) widen(at, {at[0] + side, at[1] + side, at[2] + side});
    }

    void leaf(const VdbIndex& at, const VdbMask& active) override
    {
        leaves.push_back(at);
        for (unsigned int i = 0; i < active.size(); ++i)
        {
            if (!active[i]) continue;
            const VdbIndex voxel{at[0] + (i >> 6), at[1] + (i >> 3 & 7), at[2] + (i & 7)};
            widen(voxel, {voxel[0] + 1, voxel[1] + 1, voxel[2] + 1});
        }
    }

private:
    void widen(const VdbIndex& from, const VdbIndex& to)
    {
        for (std::size_t k = 0; k < 3; ++k)
        {
            low[k] = std::min(low[k], from[k]);
            high[k] = std::max(high[k], to[k]);
        }
    }
};

std::int64_t cellsOf(std::int64_t voxels, std::int64_t factor)
{
    return (voxels + factor - 1) / factor;
}

bool fits(const Surveyor& bounds, std::int64_t factor, std::uint64_t mostCells)
{
    double cells = 1.0;
    for (std::size_t k = 0; k < 3; ++k)
    {
        const std::int64_t side = cellsOf(bounds.high[k] - bounds.low[k], factor);
        if (side > kMostCellSide) return false;
        cells *= static_cast<double>(side);
    }
    return cells <= static_cast<double>(mostCells);
}

/// Returns the least number of voxels along a side of a cell with which the cells are not too many.
std::int64_t factorFor(const Surveyor& bounds, std::uint64_t mostCells)
{
    std::int64_t tooFew = 0, enough = 1;
    for (; !fits(bounds, enough, mostCells); enough *= 2)
        tooFew = enough;
    while (enough - tooFew > 1)
    {
        const std::int64_t middle = (tooFew + enough) / 2;
        (fits(bounds, middle, mostCells) ? enough : tooFew) = middle;
    }
    return enough;
}

/// Puts the values of tiles and leaves into an image.
class Filler : public VdbVisitor
{
public:
    Filler(VdbDense& dense, const VdbGrid& grid, float background)
        : _dense(dense),
          _size{dense.image->s(), dense.image->t(), dense.image->r()},
          _levelSetWidth(grid.isLevelSet ? background : 0.0f),
          _background(0.0f),
          _cells(reinterpret_cast<float*>(dense.image->data()))
    {
        if (grid.isLevelSet && !(background > 0.0f && background <= kLargestValue))
            throw VdbError("it is a level set whose background is not a distance");
        _background = shown(background);
        std::fill_n(_cells, _size[0] * _size[1] * _size[2], _background);
    }

    void tile(const VdbIndex& low, int side, float value, bool) override
    {
        value = shown(value);
        if (value == _background) return;
        Range ranges[3];
        for (std::size_t k = 0; k < 3; ++k)
        {
            ranges[k] = rangeOf(low, side, k);
            if (ranges[k].begin >= ranges[k].end) return;
        }
        const std::int64_t f = _dense.factor;
        const auto lastCell = [f](const Range& range) { return (range.end - 1) / f; };
        const auto share = [f](const Range& range, std::int64_t cell)
        {
            const auto voxels =
                std::min(range.end, (cell + 1) * f) - std::max(range.begin, cell * f);
            return static_cast<double>(voxels) / static_cast<double>(f);
        };
        for (std::int64_t z = ranges[2].begin / f; z <= lastCell(ranges[2]); ++z)
            for (std::int64_t y = ranges[1].begin / f; y <= lastCell(ranges[1]); ++y)
            {
                const double shareOfRow = share(ranges[2], z) * share(ranges[1], y);
                for (std::int64_t x = ranges[0].begin / f; x <= lastCell(ranges[0]); ++x)
                    put(x, y, z, value, shareOfRow * share(ranges[0], x));
            }
    }

    void leaf(const VdbIndex&, const VdbMask&) override {}

    void fillLeaf(const VdbIndex& low, const std::vector<float>& values)
    {
        Range ranges[3];
        for (std::size_t k = 0; k < 3; ++k)
            ranges[k] = rangeOf(low, kLeafSide, k);
        const double f = static_cast<double>(_dense.factor), share = 1.0 / (f * f * f);
        for (std::int64_t z = ranges[2].begin; z < ranges[2].end; ++z)
            for (std::int64_t y = ranges[1].begin; y < ranges[1].end; ++y)
                for (std::int64_t x = ranges[0].begin; x < ranges[0].end; ++x)
                {
                    const auto place = static_cast<std::size_t>(
                        ((x + _dense.low[0] - low[0]) * kLeafSide + y + _dense.low[1] - low[1]) *
                            kLeafSide +
                        z + _dense.low[2] - low[2]);
                    put(x / _dense.factor, y / _dense.factor, z / _dense.factor,
                        shown(values[place]), share);
                }
    }

private:
    /// Voxels along an axis, counted from the image's lowest; end: one beyond the last.
    struct Range
    {
        std::int64_t begin, end;
    };

    Range rangeOf(const VdbIndex& low, std::int64_t side, std::size_t axis) const
    {
        const std::int64_t begin = low[axis] - _dense.low[axis];
        return {std::max<std::int64_t>(begin, 0),
                std::min(begin + side, _size[axis] * _dense.factor)};
    }

    /// Returns what the image has for a value of the grid.
    float shown(float value)
    {
        if (!(std::fabs(value) <= kLargestValue))
        {
            ++_dense.repaired;
            return _background;
        }
        if (_levelSetWidth == 0.0f) return value;
        return 0.5f - 0.5f * std::clamp(value / _levelSetWidth, -1.0f, 1.0f);
    }

    void put(std::int64_t x, std::int64_t y, std::int64_t z, float value, double share)
    {
        float& cell = _cells[(z * _size[1] + y) * _size[0] + x];
        cell = _dense.factor == 1
                   ? value
                   : static_cast<float>(cell + (double(value) - _background) * share);
    }

    VdbDense& _dense;
    const std::int64_t _size[3];
    const float _levelSetWidth; ///< 0: the grid is no level set
    float _background;
    float* const _cells;
};

} // namespace

VdbDense readDense(const std::string& file, const VdbGrid& grid, std::uint64_t mostCells)
{
    VdbTree tree(file, grid);
    Surveyor survey;
    const std::uint64_t leafValues = tree.visit(survey);
    if (survey.isEmpty()) throw VdbError("it has no active voxels");

    VdbDense dense;
    dense.low = survey.low;
    dense.factor = factorFor(survey, std::clamp<std::uint64_t>(mostCells, 1, kMostCells));
    int size[3];
    for (std::size_t k = 0; k < 3; ++k)
        size[k] = static_cast<int>(cellsOf(survey.high[k] - survey.low[k], dense.factor));
    dense.image = new osg::Image;
    dense.image->allocateImage(size[0], size[1], size[2], GL_LUMINANCE, GL_FLOAT);
    if (!dense.image->data()) throw std::bad_alloc();

    Filler filler(dense, grid, tree.background());
    tree.visit(filler);
    VdbLeafReader leaves(file, grid, leafValues, tree.background());
    for (const VdbIndex& low : survey.leaves)
        filler.fillLeaf(low, leaves.next());
    return dense;
}

} // namespace osgRayTrace::vdb
