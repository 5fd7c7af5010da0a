// WatertightTest.cpp - closed surfaces are closed, and hits of skinny triangles lie on them.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"
#include "tests/EngineScenes.h"
#include "tests/Rays.h"
#include "tests/Statistics.h"

#include "osgRayTrace/accel/Intersector.h"
#include "osgRayTrace/accel/Surface.h"

using namespace osgRayTrace::engine;
using namespace osgRayTrace::engine::test;

TEST_CASE("watertight: no ray leaves a closed sphere, at random or through edges",
          "[accel][statistics]")
{
    for (const Vec3& centre : {Vec3(0.0f), Vec3(148376.0f, 1234.0f, -223423.0f)})
    {
        const auto mesh = sphereMesh(centre, 2.0f, 100);
        SceneBuilder builder;
        builder.add(mesh, lambert(Vec3(0.5f)));
        const auto traced = builder.build();
        Uniform random(1);
        int randomMisses = 0, edgeMisses = 0, vertexMisses = 0;
        constexpr int kRays = 100000;
        const auto misses = [&](Vec3 direction) {
            return !traced->intersector().closestHit(centre, glm::normalize(direction), 0.0f,
                                                     kInfinity);
        };
        for (int i = 0; i < kRays; ++i)
        {
            randomMisses +=
                misses(Vec3(random.between(-1, 1), random.between(-1, 1), random.between(-1, 1)) +
                       Vec3(1e-3f));
            const UVec3 t = mesh->triangles[static_cast<std::size_t>(
                random() * static_cast<float>(mesh->triangles.size()))];
            const Vec3d a(mesh->positions[t.x]), b(mesh->positions[t.y]);
            edgeMisses += misses(Vec3(a + (b - a) * double(random()) - Vec3d(centre)));
            vertexMisses += misses(Vec3(a - Vec3d(centre)));
        }
        CAPTURE(centre.x);
        CHECK(randomMisses == 0);
        // In Embree's robust mode no ray to an edge misses at the origin; far away, rounding moves
        // the directions off the edges.
        CHECK(edgeMisses <= (centre == Vec3(0.0f) ? 0 : kRays / 400));
        CHECK(vertexMisses <= kRays / 80);
    }
}

TEST_CASE("watertight: points on skinny triangles lie on them, however grazing the ray",
          "[accel][statistics]")
{
    // The triangles have aspects of 10 to 1000, and the rays are 0.1 to 1 degree off their planes,
    // from 100 to 500 away. The point that Embree reports may be hundreds of units off; the surface
    // point may leave the triangle by no more than rounding.
    Uniform random(2);
    double worst = 0.0;
    int hits = 0;
    for (int k = 0; k < 300; ++k)
    {
        const double aspect = 10.0 * std::pow(100.0, random());
        const Vec3d a(0.0), b(10.0, 0.0, 0.0), c(random.between(2, 8), 10.0 / aspect, 0.0);
        SceneBuilder builder;
        builder.add(newMesh({Vec3(a), Vec3(b), Vec3(c)}, {{0, 1, 2}}), lambert(Vec3(0.5f)));
        const auto traced = builder.build(1);
        for (int r = 0; r < 200; ++r)
        {
            double u = random(), v = random();
            if (u + v > 1.0)
            {
                u = 1.0 - u;
                v = 1.0 - v;
            }
            const Vec3d target = a + u * (b - a) + v * (c - a);
            const double angle = random.between(0.1, 1.0) * M_PI / 180.0,
                         turn = random.between(0.0, 2.0 * M_PI);
            const Vec3d d(std::cos(turn) * std::cos(angle), std::sin(turn) * std::cos(angle),
                          -std::sin(angle));
            RayHitBlock block = {};
            const Vec3 origin(target - d * random.between(100.0, 500.0)), direction(d);
            setRay(block.ray, 0, origin, direction);
            traced->intersector().closestHits(block, 1u, Coherence::Incoherent);
            SurfaceLanes surface;
            surfacesOf(traced->surfaces(), block, 1u, surface);
            if (!surface.hits) continue;
            ++hits;
            const Vec3d p(surface.position.x[0], surface.position.y[0], surface.position.z[0]);
            const auto outside = [&p](const Vec3d& from, const Vec3d& to)
            {
                const Vec3d edge = glm::normalize(to - from);
                return -glm::cross(edge, p - from).z; // counter-clockwise: inside is on the left
            };
            worst = std::max({worst, std::abs(p.z), outside(a, b), outside(b, c), outside(c, a)});
        }
    }
    CHECK(hits > 10000);
    CHECK(worst < 8.0 * 0x1p-24 * 10.0 * 4.0);
}
