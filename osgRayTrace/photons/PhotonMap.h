// PhotonMap.h - photons of one pass, sorted by cell, and look-ups around points. Layer: photons.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgRayTrace/base/Lanes.h"
#include "osgRayTrace/base/LargeArray.h"
#include "osgRayTrace/base/Math.h"
#include "osgRayTrace/photons/DenseCellTrees.h"
#include "osgRayTrace/photons/PhotonBlocks.h"

#include <cstdint>
#include <vector>

namespace osgRayTrace::engine
{

class Workers;

/// Tells how large a disc around one place has to be to hold each of the photons there.
class NeighbourDistances
{
public:
    std::size_t size() const { return _radius2.size(); }

    /// Returns the largest radius of a look-up whose disc holds no more than count photons, to 5e-6
    /// of the radius; infinity if the disc may hold all that were found. Reorders the distances.
    float radiusOfNearest(std::size_t count);

private:
    friend class PhotonMap;
    std::vector<float> _radius2; ///< square of the least radius whose look-up finds the photon
};

/// Holds a grid over hashed cells with its photons in cell order: photons of neighbouring cells
/// along x lie one after the other [Teschner03, spatial hashing; but only y and z are hashed, and x
/// is added]. Immutable once built; thread safe.
class PhotonMap
{
public:
    PhotonMap() = default;

    /// cellSize: twice the radius of most queries is fastest; results are right with any size. The
    /// sort is stable: photons of a cell keep the order of the list, so results do not depend on
    /// threads. keepBins: photon() is to return Photon::bin, too.
    PhotonMap(const PhotonSpans& photons, float cellSize, const Workers& workers,
              bool keepBins = false)
        : PhotonMap(photons, cellSize, workers, keepBins, PhotonMap())
    {
    }

    /// The same in the memory of a former map: see PhotonMapMemory.
    PhotonMap(const PhotonSpans& photons, float cellSize, const Workers& workers, bool keepBins,
              PhotonMap former);

    std::size_t size() const { return _count; }
    std::size_t bytes() const;

    /// Returns the power through the disc of the query, as a surface with the query's shading
    /// normal would receive it [Veach97, sect. 5.3].
    PhotonSum gather(const PhotonQuery& query) const;

    /// Sums the power of sixteen discs, which differs from that of single look-ups by rounding.
    void gather(const PhotonQueryLanes& queries, PhotonSumLanes& sums) const;

    /// Appends the photons of the disc to found, by index for photon().
    void find(const PhotonQuery& query, std::vector<uint32_t>& found) const;

    /// Appends the photons of sixteen discs to found. A photon may be found more than once, for
    /// different lanes.
    void find(const PhotonQueryLanes& queries, std::vector<FoundPhoton>& found) const;

    /// The same, but for photons that are in discs outside of the window, which may be left out.
    void find(const PhotonQueryLanes& queries, const ImageWindow& window,
              std::vector<FoundPhoton>& found) const;

    /// Replaces distances by those of the disc's photons. Returns false if there are more photons
    /// than most: distances then holds only some of them.
    bool findDistances(const PhotonQuery& query, std::size_t most,
                       NeighbourDistances& distances) const;

    Photon photon(uint32_t index) const;
    Vec3 position(uint32_t index) const
    {
        return Vec3(column(X)[index], column(Y)[index], column(Z)[index]);
    }

    /// Returns how many photons gather reads for a query, which is the cost of the query. In a
    /// dense cell these are the photons at the rim of the disc, if sums are used (see
    /// DenseCellTrees), or else those in the disc and a few around it. In other cells they are at
    /// most kDenseCell for each cell that the disc touches. So a pass reads no more photons than
    /// its look-ups times its photons, and far fewer unless normals are interpolated and all
    /// photons are in all discs.
    std::size_t work(const PhotonQuery& query) const;

private:
    using Range = DenseCellTrees::Range;
    static constexpr int kMaxRanges = 512;

    /// Holds the values that are stored of a photon beside its normal.
    enum Column
    {
        X,
        Y,
        Z,
        WiX,
        WiY,
        WiZ,
        Red,
        Green,
        Blue,
        kColumns
    };
    std::size_t stride() const { return _count + kLanes; }
    float* column(Column c) { return _columns.data() + c * stride(); }
    const float* column(Column c) const { return _columns.data() + c * stride(); }

    PhotonColumns columns() const;

    // These functions are the sort by cell and its steps, in PhotonMapBuild.cpp.
    struct Sorting;
    void sort(const PhotonSpans& photons, const Workers& workers, bool keepBins);
    void findBuckets(Sorting& s, const Workers& workers) const;
    static void orderByPart(Sorting& s, const Workers& workers);
    std::vector<Range> sortPart(Sorting& s, std::size_t part);
    void store(const Photon& p, uint32_t to);

    // These functions find the ranges of photons that a look-up reads, in PhotonMap.cpp and
    // PhotonMapLanes.cpp.
    struct BucketLine;
    int rangesOf(const PhotonQuery& query, Range* ranges) const;
    int rangesIn(Vec3d low, Vec3d high, Range* ranges) const;
    int rangesOfLines(BucketLine* lines, int count, Range* ranges) const;
    template <class Together, class Alone>
    void forEachGroup(const PhotonQueryLanes& queries, const Together& together,
                      const Alone& alone) const;
    template <class Add> void forEachFound(const PhotonQuery& query, const Add& add) const;
    void findLane(const PhotonQueryLanes& queries, int lane, std::vector<FoundPhoton>& found) const;
    uint32_t bucketOf(int64_t x, int64_t y, int64_t z) const
    {
        const uint64_t line = static_cast<uint64_t>(y) * 0x9e3779b97f4a7c15ull ^
                              static_cast<uint64_t>(z) * 0xc2b2ae3d27d4eb4full;
        return static_cast<uint32_t>((line >> 24) + static_cast<uint64_t>(x)) & _mask;
    }
    bool isDense(Range range) const
    {
        return range.end - range.begin > kDenseCell && !_denseCells.empty();
    }

    std::size_t _count = 0;
    Vec3d _low{0.0};
    Vec3d _high{0.0};
    double _cellsPerUnit = 0.0;
    uint32_t _mask = 0;              ///< number of buckets - 1
    UnclearedArray<uint32_t> _first; ///< by bucket: its first photon; then the end of the last
    // Photons are in cell order, one column after the other. Each column has kLanes of padding, as
    // loops read whole blocks.
    UnclearedArray<float> _columns;
    UnclearedArray<uint32_t> _normal; ///< with edges and direct: see packNormal
    DenseCellTrees _denseCells;       ///< boxes over the photons of dense buckets
    UnclearedArray<uint32_t> _bin;    ///< Photon::bin; empty unless kept
};

} // namespace osgRayTrace::engine
