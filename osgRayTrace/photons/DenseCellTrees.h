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
class PhotonSpans;
struct PhotonColumns;
struct PhotonQuery;

/// Cells with more photons than this are dense.
constexpr uint32_t kDenseCell = 2048;

/// Sorts the photons of a dense cell, by place in photons, so that photons near each other follow
/// each other: by the side that their surface faces, then along a Z curve. Photons at equal places
/// keep their order.
void sortDenseCell(const PhotonSpans& photons, std::vector<uint32_t>& denseCell);

/// Holds trees of boxes over sorted dense cells. The trees are immutable once built; thread safe.
class DenseCellTrees
{
public:
    /// Names a range of photons as they lie in their columns.
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

    /// Holds the photons that a look-up has yet to read, and the sums of those that it need not
    /// read.
    struct Visit
    {
        std::vector<Range> read;
        Vec3d power{0.0};
        uint32_t count = 0;
    };

    /// Goes through a range in ascending order. Boxes outside of the query's disc are left out.
    /// With sums, boxes whose photons are all in the disc, each of weight 1, are added up as they
    /// are, so that only the disc's rim is read.
    void visit(const PhotonQuery& query, Range range, bool sums, Visit& visit) const;

private:
    /// Holds a box over up to kLeaf photons, or over up to kFan boxes of the level below.
    struct Node
    {
        Vec3 low, high;
        Vec3 normal;        ///< mean normal of the photons' surfaces
        float normalSpread; ///< largest distance of one of these normals from the mean
        float leastCosine;  ///< least cosine between a photon's direction and the mean normal
        uint32_t mostEdges;
        Vec3 power;
    };
    static constexpr uint32_t kLeaf = 64;
    static constexpr uint32_t kFan = 8;

    struct DenseCell
    {
        Range range;
        std::vector<std::vector<Node>> levels; ///< from boxes over photons up to one box over all
    };

    static Node leafOf(const PhotonColumns& columns, Range range);
    static Node joined(const Node* nodes, std::size_t count);
    static void visitNode(const PhotonQuery& query, const DenseCell& denseCell, std::size_t level,
                          std::size_t node, bool sums, Visit& visit);

    std::vector<DenseCell> _denseCells; ///< ascending
};

} // namespace osgRayTrace::engine
