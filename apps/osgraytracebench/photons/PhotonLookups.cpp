// PhotonLookups.cpp - photon look-ups and map building against a plain grid. Layer: apps.
// SPDX-License-Identifier: MIT
#include "apps/common/Failure.h"
#include "apps/osgraytracebench/Timing.h"
#include "apps/osgraytracebench/photons/PhotonsMode.h"
#include "apps/osgraytracebench/scenes/BenchScenes.h"
#include "apps/osgraytracebench/yardsticks/PlainPhotonGrid.h"
#include "osgRayTrace/accel/Intersector.h"
#include "osgRayTrace/accel/TracedScene.h"
#include "osgRayTrace/base/Parallel.h"
#include "osgRayTrace/film/Film.h"
#include "osgRayTrace/sampling/Sobol.h"
#include "osgRayTrace/sampling/Warp.h"

#include <glm/gtc/matrix_inverse.hpp>

#include <algorithm>
#include <cmath>

namespace osgRayTrace::bench
{

using namespace engine;

namespace
{

constexpr int kSide = 512; ///< side of the picture whose visible points are looked up at [pixels]
constexpr int kTile = 16;

/// Rounds to a lattice of 2^-9, so that distances are exact and no compiler's roundings can change
/// a count.
Vec3 onLattice(Vec3 p)
{
    return glm::floor(p * 512.0f + 0.5f) / 512.0f;
}

/// Returns photons that are uniform by area on the surfaces of the scene; their directions are
/// distributed as the cosine to the surface's normal.
std::vector<Photon> photonsOn(const Scene& scene, std::size_t count)
{
    struct Triangle
    {
        Vec3 a, ab, ac, normal;
    };
    std::vector<Triangle> triangles;
    std::vector<double> cumulative;
    double area = 0.0;
    for (const Instance& instance : scene.instances)
    {
        const Mesh& mesh = *scene.meshes[instance.mesh];
        for (const UVec3& t : mesh.triangles)
        {
            const Vec3 a = mesh.positions[t.x];
            const Vec3 ab = mesh.positions[t.y] - a, ac = mesh.positions[t.z] - a;
            const Vec3 across = glm::cross(ab, ac);
            triangles.push_back({a, ab, ac, glm::normalize(across)});
            cumulative.push_back(area += 0.5 * double(glm::length(across)));
        }
    }
    std::vector<Photon> photons(count);
    for (uint32_t k = 0; k < count; ++k)
    {
        float u, v, s, t, choice, side;
        sobol2(k, hash(1), choice, side);
        sobol2(k, hash(2), u, v);
        sobol2(k, hash(3), s, t);
        const auto at =
            std::upper_bound(cumulative.begin(), cumulative.end() - 1, double(choice) * area);
        const Triangle& triangle = triangles[static_cast<std::size_t>(at - cumulative.begin())];
        const float root = std::sqrt(u);
        const Vec3 local = squareToCosineHemisphere(s, t);
        Photon& p = photons[k];
        p.position =
            onLattice(triangle.a + triangle.ab * (root * (1.0f - v)) + triangle.ac * (root * v));
        p.normal = triangle.normal;
        Vec3 tangent, bitangent;
        frameOf(p.normal.x, p.normal.y, p.normal.z, tangent, bitangent);
        p.wi = tangent * local.x + bitangent * local.y + p.normal * local.z;
        p.power = Vec3(0.5f + side, 1.0f, 1.5f - side);
    }
    return photons;
}

/// Returns the points of surfaces that a picture of the scene sees, tile by tile; those of a tile
/// in blocks of 4 x 4.
std::vector<PhotonQuery> queriesOf(const BenchScene& bench, const TracedScene& traced)
{
    const glm::dmat4 worldFromClip =
        glm::inverse(bench.view.clipFromView * bench.view.viewFromWorld);
    const auto unproject = [&](double x, double y, double z)
    {
        const glm::dvec4 p = worldFromClip * glm::dvec4(x, y, z, 1.0);
        return Vec3d(p) / p.w;
    };
    std::vector<PhotonQuery> queries;
    for (int tile = 0; tile < kSide * kSide / (kTile * kTile); ++tile)
        for (int i = 0; i < kTile * kTile; ++i)
        {
            const int column = tile % (kSide / kTile) * kTile + laneX(i / kLanes, i % kLanes);
            const int row = tile / (kSide / kTile) * kTile + laneY(i / kLanes, i % kLanes);
            const double x = 2.0 * (column + 0.5) / kSide - 1.0,
                         y = 2.0 * (row + 0.5) / kSide - 1.0;
            const Vec3d origin = unproject(x, y, -1.0);
            const Vec3 direction(glm::normalize(unproject(x, y, 1.0) - origin));
            const std::optional<Hit> hit =
                traced.intersector().closestHit(Vec3(origin), direction, 0.0f, kInfinity);
            if (!hit) throw app::Failure(app::kCannotRender, "a look-up met no surface");
            const Mesh& mesh = *bench.scene->meshes[bench.scene->instances[hit->instance].mesh];
            const UVec3 t = mesh.triangles[hit->primitive];
            const Vec3 a = mesh.positions[t.x];
            PhotonQuery query;
            query.position = onLattice(Vec3(origin) + direction * hit->t);
            query.normal =
                glm::normalize(glm::cross(mesh.positions[t.y] - a, mesh.positions[t.z] - a));
            if (glm::dot(query.normal, direction) > 0.0f) query.normal = -query.normal;
            query.shadingNormal = query.normal;
            queries.push_back(query);
        }
    return queries;
}

template <class Map>
void gatherAll(const Map& map, const std::vector<PhotonQuery>& queries, const Workers& workers,
               std::vector<PhotonSum>& sums)
{
    constexpr std::size_t kChunk = kTile * kTile;
    workers.forEach(queries.size() / kChunk,
                    [&](std::size_t chunk)
                    {
                        for (std::size_t i = chunk * kChunk; i < (chunk + 1) * kChunk; ++i)
                            sums[i] = map.gather(queries[i]);
                    });
}

/// Gathers the blocks of 4 x 4 at once, as integrators do.
void gatherBlocks(const PhotonMap& map, const std::vector<PhotonQuery>& queries,
                  const Workers& workers, std::vector<PhotonSum>& sums)
{
    workers.forEach(queries.size() / kLanes,
                    [&](std::size_t block)
                    {
                        const std::size_t first = block * kLanes;
                        PhotonQueryLanes lanes;
                        lanes.lanes = kAllLanes;
                        for (int i = 0; i < kLanes; ++i)
                        {
                            const PhotonQuery& query = queries[first + static_cast<std::size_t>(i)];
                            setLane(lanes.position, i, query.position);
                            setLane(lanes.normal, i, query.normal);
                            setLane(lanes.shadingNormal, i, query.shadingNormal);
                            lanes.radius[i] = query.radius;
                        }
                        PhotonSumLanes found;
                        map.gather(lanes, found);
                        for (int i = 0; i < kLanes; ++i)
                            sums[first + static_cast<std::size_t>(i)] = {laneOf(found.power, i),
                                                                         found.count[i]};
                    });
}

/// Returns the number of photons found in all. Throws if a and b do not agree.
uint64_t compare(const std::vector<PhotonSum>& a, const std::vector<PhotonSum>& b)
{
    uint64_t count = 0;
    for (std::size_t i = 0; i < a.size(); ++i)
    {
        const Vec3 difference = glm::abs(a[i].power - b[i].power);
        if (a[i].count != b[i].count ||
            difference.x + difference.y + difference.z > 1e-4f * (1.0f + a[i].power.y))
            throw app::Failure(app::kCannotRender,
                               "photon map and plain grid do not find the same photons");
        count += a[i].count;
    }
    return count;
}

double millions(std::size_t count, double seconds)
{
    return static_cast<double>(count) / seconds * 1e-6;
}

void measureRadius(const std::vector<Photon>& photons, std::vector<PhotonQuery> queries,
                   float radius, int runs, Rows& rows)
{
    for (PhotonQuery& query : queries)
        query.radius = radius;
    std::vector<PhotonSum> sums(queries.size()), plainSums(queries.size());
    const auto one = std::make_shared<Workers>(1);
    const auto all = std::make_shared<Workers>();
    const PhotonMap map(photons, 2.0f * radius, *all);

    // The yardstick has the cell size that suits it.
    const PlainPhotonGrid small(photons, radius), large(photons, 2.0f * radius);
    const PairedTimes cells = timePair(
        runs, [&] { gatherAll(small, queries, *one, plainSums); },
        [&] { gatherAll(large, queries, *one, plainSums); }, threadSecondsOf);
    const float plainCell = cells.ratio < 1.0 ? radius : 2.0f * radius;
    const PlainPhotonGrid& plain = cells.ratio < 1.0 ? small : large;

    gatherAll(map, queries, *one, sums);
    gatherAll(plain, queries, *one, plainSums);
    const double found =
        static_cast<double>(compare(sums, plainSums)) / static_cast<double>(queries.size());
    const std::string name = "lookup r " + std::to_string(radius).substr(0, 3);
    rows.push_back({name + ": photons found a gather, by both", found, "photons"});
    gatherBlocks(map, queries, *one, sums);
    compare(sums, plainSums);
    rows.push_back({name + ": cells of the plain grid", plainCell / radius, "radii"});
    for (const auto& workers : {one, all})
    {
        const PairedTimes times = timePair(
            runs, [&] { gatherAll(plain, queries, *workers, plainSums); },
            [&] { gatherAll(map, queries, *workers, sums); }, stopwatchFor(workers->threads()));
        const std::string threads = name + ", " + std::to_string(workers->threads()) + " threads";
        rows.push_back(
            {threads + ": plain grid", millions(queries.size(), times.first), "M gathers/s"});
        rows.push_back(
            {threads + ": photon map", millions(queries.size(), times.second), "M gathers/s"});
        rows.push_back({threads + ": map / plain", times.ratio, "times", Goal::AtLeast, 1.7});
        const PairedTimes blocks = timePair(
            runs, [&] { gatherAll(plain, queries, *workers, plainSums); },
            [&] { gatherBlocks(map, queries, *workers, sums); }, stopwatchFor(workers->threads()));
        rows.push_back({threads + ": map, sixteen at once", millions(queries.size(), blocks.second),
                        "M gathers/s"});
        rows.push_back(
            {threads + ": sixteen at once / plain", blocks.ratio, "times", Goal::AtLeast, 3.0});
    }
    for (const auto& workers : {one, all})
    {
        const PairedTimes times = timePair(
            runs, [&] { PlainPhotonGrid(photons, plainCell); },
            [&] { PhotonMap(photons, 2.0f * radius, *workers); }, stopwatchFor(workers->threads()));
        const std::string threads = "build r " + std::to_string(radius).substr(0, 3) + ", " +
                                    std::to_string(workers->threads()) + " threads";
        rows.push_back({threads + ": plain grid, always 1 thread", times.first * 1e3, "ms"});
        rows.push_back({threads + ": photon map", times.second * 1e3, "ms"});
        rows.push_back({threads + ": map / plain", 1.0 / times.ratio, "of time",
                        workers->threads() > 1 ? Goal::AtMost : Goal::None, 1.0});
    }
}

} // namespace

void measurePhotonLookups(const PhotonsOptions& options, Rows& rows)
{
    const BenchScene bench = cornellBox(kSide, kSide);
    const auto traced = TracedScene::build(bench.scene, std::make_shared<Workers>(1));
    const std::vector<Photon> photons =
        photonsOn(*bench.scene, static_cast<std::size_t>(options.photons));
    const std::vector<PhotonQuery> queries = queriesOf(bench, *traced);
    measureRadius(photons, queries, 4.0f, options.runs, rows);
    measureRadius(photons, queries, 2.3f, options.runs, rows);
}

} // namespace osgRayTrace::bench
