// EnvironmentStrata.cpp - thresholds, regions, and the strata within them. Layer: shading.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/shading/EnvironmentStrata.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <queue>

namespace osgRayTrace::engine
{

namespace
{

constexpr int kLayers = 6;             // [Agarwal03, sect. 3.2]
constexpr double kLargestAngle = 0.01; // [sr] [Agarwal03, sect. 3.1]
constexpr int kMostColumns = 512, kMostRows = 256;
constexpr int kLeastColumns = 256, kLeastRows = 128;

/// Holds one or more pixels of the image, or a part of one.
struct Cell
{
    Vec3d centre{0.0};      ///< unit
    Vec3d moment{0.0};      ///< integral of luminance times direction
    Vec3d integral{0.0};    ///< integral of radiance
    double luminance = 0.0; ///< integral of luminance
    double solidAngle = 0.0;
    int layer = 0;
    int region = -1;
};

struct Region
{
    int layer = 0;
    std::vector<int> cells;
    double luminance = 0.0;
    double solidAngle = 0.0;
    int strata = 0;

    double importance() const
    {
        return luminance * std::pow(std::min(solidAngle, kLargestAngle), 0.25);
    }
};

/// Holds the centre of a stratum, with the sums of the cells that are nearest to it so far.
struct Centre
{
    Vec3d direction{0.0};
    Vec3d moment{0.0};
    Vec3d integral{0.0};
};

double luminanceOf(const Vec3d& c)
{
    return 0.2126 * c.x + 0.7152 * c.y + 0.0722 * c.z;
}

/// Returns a number that grows with the angle between unit vectors.
double distance(const Vec3d& a, const Vec3d& b)
{
    return 1.0 - glm::dot(a, b);
}

class Stratification
{
public:
    explicit Stratification(const EnvironmentMap& map);
    std::vector<EnvironmentStratum> strata(int count);

private:
    void fillCells(const EnvironmentMap& map);
    void setLayers();
    void findRegions();
    void grow(int seed);
    void share(int count);
    void stratify(Region& region);
    void giveToNearest(const Region& region);

    int _columns, _rowCount;
    std::vector<Cell> _cells;
    std::vector<Region> _regions;
    std::vector<Centre> _centres;
};

Stratification::Stratification(const EnvironmentMap& map)
{
    fillCells(map);
    setLayers();
    findRegions();
}

void Stratification::fillCells(const EnvironmentMap& map)
{
    const EnvironmentImage& image = *map.image();
    const int partsX = (kLeastColumns + image.width - 1) / image.width; // parts of a pixel
    const int partsY = (kLeastRows + image.height - 1) / image.height;
    const int width = image.width * partsX, height = image.height * partsY;
    const int stepX = (width + kMostColumns - 1) / kMostColumns; // parts in a cell
    const int stepY = (height + kMostRows - 1) / kMostRows;
    _columns = (width + stepX - 1) / stepX;
    _rowCount = (height + stepY - 1) / stepY;
    _cells.resize(static_cast<std::size_t>(_columns) * static_cast<std::size_t>(_rowCount));
    std::vector<Vec3d> onEquator;
    for (int x = 0; x < width; ++x)
        onEquator.push_back(map.direction((x + 0.5) / partsX, 0.5 * image.height));
    for (int y = 0; y < height; ++y)
    {
        const auto on = [&](double row) // returns (0, across, z)
        { return map.direction(0.5 * image.width, row / partsY); };
        const Vec3d middle = on(y + 0.5);
        const double solidAngle = (on(y + 1.0).z - on(y).z) * 2.0 * kPi / width;
        const Vec3* row = &image.radiance[static_cast<std::size_t>(y / partsY) *
                                          static_cast<std::size_t>(image.width)];
        for (int x = 0; x < width; ++x)
        {
            const Vec3d& e = onEquator[static_cast<std::size_t>(x)];
            const Vec3d direction(e.x * middle.y, e.y * middle.y, middle.z);
            Cell& cell = _cells[static_cast<std::size_t>(y / stepY * _columns + x / stepX)];
            const Vec3d integral = Vec3d(row[x / partsX]) * solidAngle;
            const double luminance = luminanceOf(integral);
            cell.centre += direction * solidAngle;
            cell.moment += direction * luminance;
            cell.integral += integral;
            cell.luminance += luminance;
            cell.solidAngle += solidAngle;
        }
    }
    for (Cell& cell : _cells)
        cell.centre = glm::normalize(cell.centre);
}

void Stratification::setLayers()
{
    double angle = 0.0, sum = 0.0, squares = 0.0;
    for (const Cell& cell : _cells)
    {
        angle += cell.solidAngle;
        sum += cell.luminance;
        squares += cell.luminance * cell.luminance / cell.solidAngle;
    }
    const double mean = sum / angle;
    const double deviation = std::sqrt(std::max(0.0, squares / angle - mean * mean));
    // Rounding would make layers of an even sky.
    if (!(deviation > 1e-6 * mean)) return;
    for (Cell& cell : _cells)
        cell.layer = static_cast<int>(
            std::min<double>(kLayers - 1, cell.luminance / cell.solidAngle / deviation));
}

void Stratification::findRegions()
{
    for (int i = 0; i < static_cast<int>(_cells.size()); ++i)
    {
        const Cell& cell = _cells[static_cast<std::size_t>(i)];
        if (cell.region < 0 && cell.luminance > 0.0) grow(i);
    }
}

/// Makes a region of all cells of the layer that are connected with one, diagonally too. The
/// columns close to a ring, and across a pole the cells half a turn away are neighbours.
void Stratification::grow(int seed)
{
    const int number = static_cast<int>(_regions.size());
    Region region;
    region.layer = _cells[static_cast<std::size_t>(seed)].layer;
    std::vector<int> open{seed};
    _cells[static_cast<std::size_t>(seed)].region = number;
    while (!open.empty())
    {
        const int index = open.back();
        open.pop_back();
        const Cell& cell = _cells[static_cast<std::size_t>(index)];
        region.cells.push_back(index);
        region.luminance += cell.luminance;
        region.solidAngle += cell.solidAngle;
        for (int dy = -1; dy <= 1; ++dy)
            for (int dx = -1; dx <= 1; ++dx)
            {
                int x = index % _columns + dx, y = index / _columns + dy;
                if (y < 0 || y >= _rowCount)
                {
                    y = std::clamp(y, 0, _rowCount - 1);
                    x += _columns / 2;
                }
                x = (x + 2 * _columns) % _columns;
                const int next = y * _columns + x;
                Cell& other = _cells[static_cast<std::size_t>(next)];
                if (other.region >= 0 || other.layer != region.layer || !(other.luminance > 0.0))
                    continue;
                other.region = number;
                open.push_back(next);
            }
    }
    std::sort(region.cells.begin(), region.cells.end());
    _regions.push_back(std::move(region));
}

/// Gives one stratum after the other to the region that would then have the most importance for
/// each of its strata.
void Stratification::share(int count)
{
    using Bid = std::pair<double, int>; // of equal importances the first region wins
    std::priority_queue<Bid> bids;
    for (std::size_t r = 0; r < _regions.size(); ++r)
        bids.push({_regions[r].importance(), -static_cast<int>(r)});
    for (; count > 0 && !bids.empty(); --count)
    {
        const int number = -bids.top().second;
        bids.pop();
        Region& region = _regions[static_cast<std::size_t>(number)];
        ++region.strata;
        if (region.strata < static_cast<int>(region.cells.size()))
            bids.push({region.importance() / (region.strata + 1), -number});
    }
}

/// Chooses each centre as the cell farthest from all centres so far, also from those of brighter
/// regions [Hochbaum85].
void Stratification::stratify(Region& region)
{
    const std::size_t size = region.cells.size();
    const auto cell = [&](std::size_t k) -> const Cell&
    { return _cells[static_cast<std::size_t>(region.cells[k])]; };
    std::vector<double> toAny(size, 5.0), toOwn(size, 5.0);
    std::vector<std::size_t> own(size, 0);
    for (const Centre& centre : _centres)
        for (std::size_t k = 0; k < size; ++k)
            toAny[k] = std::min(toAny[k], distance(cell(k).centre, centre.direction));
    const std::size_t first = _centres.size();
    for (int s = 0; s < region.strata; ++s)
    {
        std::size_t farthest = 0;
        if (_centres.empty())
        {
            for (std::size_t k = 1; k < size; ++k)
                if (cell(k).luminance > cell(farthest).luminance) farthest = k;
        }
        else
            farthest = static_cast<std::size_t>(std::max_element(toAny.begin(), toAny.end()) -
                                                toAny.begin());
        const Vec3d direction = cell(farthest).centre;
        for (std::size_t k = 0; k < size; ++k)
        {
            const double d = distance(cell(k).centre, direction);
            toAny[k] = std::min(toAny[k], d);
            if (d >= toOwn[k]) continue;
            toOwn[k] = d;
            own[k] = _centres.size();
        }
        toAny[farthest] = -1.0; // never chosen again, whatever rounding says
        _centres.push_back({direction, Vec3d(0.0), Vec3d(0.0)});
    }
    if (_centres.size() == first) return;
    for (std::size_t k = 0; k < size; ++k)
    {
        _centres[own[k]].moment += cell(k).moment;
        _centres[own[k]].integral += cell(k).integral;
    }
}

/// Gives each cell of a region that has no stratum to the nearest stratum of any region.
void Stratification::giveToNearest(const Region& region)
{
    for (const int index : region.cells)
    {
        const Cell& cell = _cells[static_cast<std::size_t>(index)];
        const auto nearer = [&](const Centre& a, const Centre& b)
        { return distance(cell.centre, a.direction) < distance(cell.centre, b.direction); };
        Centre& centre = *std::min_element(_centres.begin(), _centres.end(), nearer);
        centre.moment += cell.moment;
        centre.integral += cell.integral;
    }
}

std::vector<EnvironmentStratum> Stratification::strata(int count)
{
    share(count);
    for (int layer = kLayers - 1; layer >= 0; --layer)
        for (Region& region : _regions)
            if (region.layer == layer && region.strata > 0) stratify(region);
    for (const Region& region : _regions)
        if (region.strata == 0 && !_centres.empty()) giveToNearest(region);

    std::vector<EnvironmentStratum> result;
    for (const Centre& centre : _centres)
    {
        const double luminance = luminanceOf(centre.integral);
        if (!(luminance > 0.0)) continue;
        // Light from all around has no mean direction.
        const double length = glm::length(centre.moment);
        const Vec3d direction =
            length > 1e-6 * luminance ? centre.moment / length : centre.direction;
        result.push_back({Vec3(direction), Vec3(centre.integral)});
    }
    return result;
}

} // namespace

std::vector<EnvironmentStratum> environmentStrata(const EnvironmentMap& map, int count)
{
    if (map.isBlack() || count < 1) return {};
    return Stratification(map).strata(count);
}

} // namespace osgRayTrace::engine
