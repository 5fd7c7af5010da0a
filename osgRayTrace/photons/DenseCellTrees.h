// DenseCellTrees.h - boxes over the photons of dense cells, so that look-ups need not read them
// all. Layer: photons.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/base/Math.h"

#include <cstdint>
#include <vector>

namespace osgRayTrace::engine
{

class Workers;
struct Photon;
struct PhotonColumns;
struct PhotonQuery;

/// Cells with more photons than this are dense.
constexpr uint32_t kDenseCell = 2048;

/// Puts the photons of a dense cell, by index into photons, into an order in which those that are
/// near each other follow each other: by the side that their surface looks to, then along a Z
/// curve. Equal places keep their order.
void sortDenseCell(const std::vector<Photon>& photons, std::vector<uint32_t>& denseCell);

/// Trees of boxes over sorted dense cells. Immutable once built; thread safe.
class DenseCellTrees
{
public:
    /// A range of photons as they lie in their columns.
    struct Range
    {
        uint32_t begin, end;
    };

    DenseCellTrees() = default;

    /// denseCells: ranges in ascending order.
    DenseCellTrees(const PhotonColumns& columns, const std::vector<Range>& denseCells,
                   const Workers& workers);

    bool empty() const { return _denseCells.empty(); }
    std::size_t bytes() const;

    /// What a look-up has yet to read, and what was added up without reading.
    struct Visit
    {
        std::vector<Range> read;
        Vec3d power{0.0};
        uint32_t count = 0;
    };

    /// Goes through a range in ascending order. Boxes outside of the query's disc are left out.
    /// With sums those whose photons are all in it, each of weight 1, are added up as they are, so
    /// that only the disc's rim is read.
    void visit(const PhotonQuery& query, Range range, bool sums, Visit& visit) const;

private:
    /// A box over up to kLeaf photons, or over up to kFan boxes of the level below.
    struct Node
    {
        Vec3 low, high;
        Vec3 normal;        ///< of the photons' surfaces, the mean
        float normalSpread; ///< largest distance of one of them from it
        float leastCosine;  ///< of a photon's direction and the mean
        uint32_t mostEdges;
        Vec3 power;
    };
    static constexpr uint32_t kLeaf = 64;
    static constexpr uint32_t kFan = 8;

    struct DenseCell
    {
        Range range;
        std::vector<std::vector<Node>> levels; ///< boxes of photons first; the last is one box
    };

    static Node leafOf(const PhotonColumns& columns, Range range);
    static Node joined(const Node* nodes, std::size_t count);
    static void visitNode(const PhotonQuery& query, const DenseCell& denseCell, std::size_t level,
                          std::size_t node, bool sums, Visit& visit);

    std::vector<DenseCell> _denseCells; ///< ascending
};

} // namespace osgRayTrace::engine
