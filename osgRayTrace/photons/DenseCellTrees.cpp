// DenseCellTrees.cpp - boxes over the photons of dense cells. Layer: photons.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/photons/DenseCellTrees.h"

#include "osgRayTrace/base/Parallel.h"
#include "osgRayTrace/photons/PhotonBlocks.h"
#include "osgRayTrace/photons/PhotonColumns.h"

#include <algorithm>
#include <cmath>

namespace osgRayTrace::engine
{

namespace
{

// Bounds of the rounding errors of insideDisc and of the boxes' own sums: relative to the radius,
// and of cosines.
constexpr double kRadiusError = 0x1p-20;
constexpr float kCosineError = 1e-5f;

constexpr int kAxisBits = 15;
constexpr int kDigitBits = 12;
constexpr int kDigits = 4; ///< digits of a key: three axes, and three bits for the side

/// Returns x with two bits of room after each of its bits.
uint64_t spread(uint64_t x)
{
    x = (x | x << 16) & 0x0000ff0000ffull;
    x = (x | x << 8) & 0x00f00f00f00full;
    x = (x | x << 4) & 0x0c30c30c30c3ull;
    return (x | x << 2) & 0x249249249249ull;
}

/// Returns which of the six half axes a normal is nearest to.
uint64_t sideOf(Vec3 n)
{
    const Vec3 size = glm::abs(n);
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    return static_cast<uint64_t>(2 * axis + (n[axis] < 0.0f));
}

struct Keyed
{
    uint64_t key;
    uint32_t photon;
};

/// Sorts by counting, digit by digit from the lowest.
void sortByKey(std::vector<Keyed>& list)
{
    std::vector<Keyed> other(list.size());
    for (int digit = 0; digit < kDigits; ++digit)
    {
        const int shift = digit * kDigitBits;
        constexpr uint64_t kMask = (1u << kDigitBits) - 1;
        std::vector<uint32_t> next(kMask + 2);
        for (const Keyed& k : list)
            ++next[((k.key >> shift) & kMask) + 1];
        for (std::size_t d = 1; d < next.size(); ++d)
            next[d] += next[d - 1];
        for (const Keyed& k : list)
            other[next[(k.key >> shift) & kMask]++] = k;
        list.swap(other);
    }
}

double squared(double x)
{
    return x * x;
}

} // namespace

void sortDenseCell(const PhotonSpans& photons, std::vector<uint32_t>& denseCell)
{
    Vec3 low(kInfinity), high(-kInfinity);
    for (const uint32_t k : denseCell)
    {
        low = glm::min(low, photons[k].position);
        high = glm::max(high, photons[k].position);
    }
    const Vec3d extent = Vec3d(high) - Vec3d(low);
    const double longest = std::max({extent.x, extent.y, extent.z});
    const double scale = longest > 0.0 ? ((1 << kAxisBits) - 1) / longest : 0.0;
    std::vector<Keyed> list(denseCell.size());
    for (std::size_t i = 0; i < denseCell.size(); ++i)
    {
        const Photon& p = photons[denseCell[i]];
        const Vec3d at = (Vec3d(p.position) - Vec3d(low)) * scale;
        const uint64_t place = spread(static_cast<uint64_t>(at.x)) |
                               spread(static_cast<uint64_t>(at.y)) << 1 |
                               spread(static_cast<uint64_t>(at.z)) << 2;
        list[i] = {place | sideOf(p.normal) << (3 * kAxisBits), denseCell[i]};
    }
    sortByKey(list);
    for (std::size_t i = 0; i < denseCell.size(); ++i)
        denseCell[i] = list[i].photon;
}

DenseCellTrees::Node DenseCellTrees::leafOf(const PhotonColumns& p, Range s)
{
    Node node{Vec3(kInfinity), Vec3(-kInfinity), Vec3(0.0f), 0.0f, 1.0f, 0, Vec3(0.0f)};
    Vec3d power(0.0), normal(0.0);
    for (uint32_t k = s.begin; k < s.end; ++k)
    {
        const Vec3 position(p.x[k], p.y[k], p.z[k]);
        node.low = glm::min(node.low, position);
        node.high = glm::max(node.high, position);
        node.mostEdges = std::max(node.mostEdges, static_cast<uint32_t>(edgesOf(p.normal[k])));
        normal += Vec3d(unpackNormal(p.normal[k]));
        power += Vec3d(p.r[k], p.g[k], p.b[k]);
    }
    node.normal = Vec3(normal / static_cast<double>(s.end - s.begin));
    node.power = Vec3(power);
    for (uint32_t k = s.begin; k < s.end; ++k)
    {
        const Vec3 wi(p.wiX[k], p.wiY[k], p.wiZ[k]);
        node.leastCosine = std::min(node.leastCosine, glm::dot(wi, node.normal));
        node.normalSpread =
            std::max(node.normalSpread, glm::distance(unpackNormal(p.normal[k]), node.normal));
    }
    return node;
}

DenseCellTrees::Node DenseCellTrees::joined(const Node* nodes, std::size_t count)
{
    Node node = nodes[0];
    Vec3d power(0.0), normal(0.0);
    for (std::size_t i = 0; i < count; ++i)
    {
        node.low = glm::min(node.low, nodes[i].low);
        node.high = glm::max(node.high, nodes[i].high);
        node.mostEdges = std::max(node.mostEdges, nodes[i].mostEdges);
        normal += Vec3d(nodes[i].normal);
        power += Vec3d(nodes[i].power);
    }
    node.normal = Vec3(normal / static_cast<double>(count));
    node.power = Vec3(power);
    node.leastCosine = 1.0f;
    node.normalSpread = 0.0f;
    for (std::size_t i = 0; i < count; ++i)
    {
        const float away = glm::distance(nodes[i].normal, node.normal);
        node.leastCosine = std::min(node.leastCosine, nodes[i].leastCosine - away);
        node.normalSpread = std::max(node.normalSpread, nodes[i].normalSpread + away);
    }
    return node;
}

DenseCellTrees::DenseCellTrees(const PhotonColumns& columns, const std::vector<Range>& denseCells,
                               const Workers& workers)
    : _denseCells(denseCells.size())
{
    for (std::size_t c = 0; c < denseCells.size(); ++c)
    {
        DenseCell& denseCell = _denseCells[c];
        denseCell.range = denseCells[c];
        const uint32_t begin = denseCell.range.begin, end = denseCell.range.end;
        denseCell.levels.emplace_back((end - begin + kLeaf - 1) / kLeaf);
        std::vector<Node>& leaves = denseCell.levels.back();
        constexpr std::size_t kChunk = 1024;
        workers.forEach((leaves.size() + kChunk - 1) / kChunk,
                        [&](std::size_t chunk)
                        {
                            const std::size_t last = std::min(leaves.size(), (chunk + 1) * kChunk);
                            for (std::size_t i = chunk * kChunk; i < last; ++i)
                            {
                                const uint32_t at = begin + static_cast<uint32_t>(i) * kLeaf;
                                leaves[i] = leafOf(columns, {at, std::min(end, at + kLeaf)});
                            }
                        });
        while (denseCell.levels.back().size() > 1)
        {
            const std::vector<Node>& below = denseCell.levels.back();
            std::vector<Node> level;
            for (std::size_t i = 0; i < below.size(); i += kFan)
                level.push_back(joined(&below[i], std::min<std::size_t>(kFan, below.size() - i)));
            denseCell.levels.push_back(std::move(level));
        }
    }
}

std::size_t DenseCellTrees::bytes() const
{
    std::size_t sum = 0;
    for (const DenseCell& denseCell : _denseCells)
        for (const std::vector<Node>& level : denseCell.levels)
            sum += level.size() * sizeof(Node);
    return sum;
}

void DenseCellTrees::visitNode(const PhotonQuery& q, const DenseCell& denseCell, std::size_t level,
                               std::size_t index, bool sums, Visit& visit)
{
    const Node& node = denseCell.levels[level][index];
    const double radius = q.radius;
    const Vec3d centre(q.position), normal(q.normal);
    const Vec3d low = Vec3d(node.low) - centre, high = Vec3d(node.high) - centre;
    const Vec3d nearest = glm::max(low, Vec3d(0.0)) + glm::min(high, Vec3d(0.0));
    const double off = 0.5 * glm::dot(low + high, normal);
    const double thickness = 0.5 * glm::dot(high - low, glm::abs(normal));
    const double plane = kPlaneShare * radius;
    if (glm::dot(nearest, nearest) > squared(radius * (1.0 + kRadiusError)) ||
        std::fabs(off) - thickness > plane + radius * kRadiusError)
        return;

    const std::size_t covers = std::size_t(kLeaf) << (3 * level); // kFan = 8
    const uint32_t begin = denseCell.range.begin + static_cast<uint32_t>(index * covers);
    const uint32_t end = static_cast<uint32_t>(
        std::min<std::size_t>(denseCell.range.end, std::size_t(begin) + covers));
    if (sums)
    {
        const Vec3d farthest = glm::max(glm::abs(low), glm::abs(high));
        const float turned = glm::distance(q.normal, node.normal);
        const double flat = std::min(plane, double(gapTolerance(q.position, q.radius)));
        const bool inside =
            glm::dot(farthest, farthest) <= squared(radius * (1.0 - kRadiusError)) &&
            std::fabs(off) + thickness <= flat - radius * kRadiusError &&
            node.leastCosine - turned > kCosineError &&
            glm::dot(q.normal, node.normal) - node.normalSpread >=
                kLeastNormalCosine + kCosineError &&
            node.mostEdges <= q.mostEdges;
        if (inside)
        {
            visit.power += Vec3d(node.power);
            visit.count += end - begin;
            return;
        }
    }
    if (level == 0)
    {
        if (!visit.read.empty() && visit.read.back().end == begin)
            visit.read.back().end = end;
        else
            visit.read.push_back({begin, end});
        return;
    }
    const std::size_t last =
        std::min<std::size_t>((index + 1) * kFan, denseCell.levels[level - 1].size());
    for (std::size_t child = index * kFan; child < last; ++child)
        visitNode(q, denseCell, level - 1, child, sums, visit);
}

void DenseCellTrees::visit(const PhotonQuery& query, Range range, bool sums, Visit& visit) const
{
    const auto isBefore = [](const DenseCell& denseCell, uint32_t begin)
    { return denseCell.range.begin < begin; };
    auto denseCell =
        std::lower_bound(_denseCells.begin(), _denseCells.end(), range.begin, isBefore);
    uint32_t at = range.begin;
    // A range consists of whole cells, so a dense cell is in it or is not.
    for (; denseCell != _denseCells.end() && denseCell->range.end <= range.end; ++denseCell)
    {
        if (at < denseCell->range.begin) visit.read.push_back({at, denseCell->range.begin});
        visitNode(query, *denseCell, denseCell->levels.size() - 1, 0, sums, visit);
        at = denseCell->range.end;
    }
    if (at < range.end) visit.read.push_back({at, range.end});
}

} // namespace osgRayTrace::engine
