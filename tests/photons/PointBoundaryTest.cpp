// PointBoundaryTest.cpp - photons of dense media next to boundaries, where spheres are cut.
// SPDX-License-Identifier: MIT
#include "tests/PValues.h"
#include "tests/photons/BeamScenes.h"
#include "tests/photons/PhotonMeans.h"

#include "osgRayTrace/photons/PointMap.h"

using namespace osgRayTrace::engine;
using namespace osgRayTrace::engine::test;

TEST_CASE("points: the kernel of a cut ball has an integral of 1 and no first moment", "[photons]")
{
    const double depths[] = {0.0, 0.1, 0.5, 0.9, 1.0, 7.0};
    for (int k = 0; k < 36; ++k)
    {
        const double depth = depths[k / 6], beyond = depths[k % 6];
        if (beyond < depth || beyond == 0.0) continue; // the nearer plane comes first
        const CutBall kernel = cutBall(static_cast<float>(depth), static_cast<float>(beyond));
        double sum = 0.0, moment = 0.0;
        constexpr int kSteps = 20000;
        const double low = -std::min(depth, 1.0), step = (std::min(beyond, 1.0) - low) / kSteps;
        for (int i = 0; i < kSteps; ++i)
        {
            const double u = low + step * (i + 0.5);
            const double weight = step * 3.14159265358979 * (1.0 - u * u) *
                                  (double(kernel.constant) + double(kernel.slope) * u);
            sum += weight;
            moment += weight * u;
        }
        CAPTURE(depth, beyond);
        CHECK(sum == Approx(1.0).epsilon(1e-5));
        CHECK(moment == Approx(0.0).margin(1e-5));
    }
}

// Each comparison raises a false alarm in a thousand seeds.
TEST_CASE("points: next to a boundary the light is that of the place", "[photons][statistics]")
{
    // Photons below z = 0, whose density grows with the depth as near the face of a thick body.
    // Some of a neighbour beyond the boundary do not count.
    const auto fluence = [](double z) { return z < 0.0 ? 1.0 - 2.0 * z : 1.0; };
    constexpr double kDepths[] = {0.0, 0.02, 0.05, 0.09, 0.2};
    Estimate seen[5];
    for (uint32_t run = 0; run < 16; ++run)
    {
        Uniform random(11 + run);
        std::vector<PhotonPoint> points(40000);
        for (PhotonPoint& point : points)
        {
            point.position = Vec3(random() - 0.5f, random() - 0.5f, 0.2f - 0.7f * random());
            // The box of the points has a volume of 0.7.
            point.power = Vec3(float(fluence(double(point.position.z)) * 0.7 / 40000.0));
            point.direction = Vec3(0, 0, -1);
        }
        const PointMap map(points);
        for (int d = 0; d < 5; ++d)
        {
            double sum = 0.0;
            for (int k = 0; k < 50; ++k)
            {
                PointQuery query;
                query.position =
                    Vec3(0.6f * (random() - 0.5f), 0.6f * (random() - 0.5f), float(-kDepths[d]));
                query.towards = Vec3(0, 0, 1);
                query.radius = 0.1f;
                query.mostEdges = 9;
                query.inwards = Vec3(0, 0, -1);
                query.depth = float(kDepths[d]);
                sum += double(map.gather(query).x) * 4.0 * 3.14159265358979;
            }
            seen[d].add(sum / 50.0);
        }
    }
    for (int d = 0; d < 5; ++d)
    {
        CAPTURE(kDepths[d], seen[d].mean(), seen[d].standardError());
        CHECK(seen[d].standardError() < 0.02);
        CHECK(seen[d].agrees(fluence(-kDepths[d])));
    }
}

TEST_CASE("points: within a slab the light is that of the place", "[photons][statistics]")
{
    // Photons in a slab over the radius, whose density grows along its normal; as many per volume
    // in all slabs. Those beyond the faces do not count.
    constexpr double kThicknesses[] = {0.5, 0.3, 0.1}; // over the radius
    for (const double thickness : kThicknesses)
    {
        const double top = 0.1 * thickness, density = 400000.0;
        const auto fluence = [&](double z) { return 1.0 + z / top; };
        Estimate seen[3];
        for (uint32_t run = 0; run < 16; ++run)
        {
            Uniform random(31 + run);
            std::vector<PhotonPoint> points(static_cast<std::size_t>(density * 3.0 * top));
            for (PhotonPoint& point : points)
            {
                const double z = top * (3.0 * double(random()) - 1.0);
                point.position = Vec3(random() - 0.5f, random() - 0.5f, float(z));
                point.power = Vec3(float(std::max(fluence(z), 1.0) / density));
                point.direction = Vec3(0, 0, -1);
            }
            const PointMap map(points);
            for (int d = 0; d < 3; ++d)
            {
                // At the lower face, in the middle, and at the upper face, which is then nearest.
                const double z = top * 0.5 * d;
                double sum = 0.0;
                for (int k = 0; k < 50; ++k)
                {
                    PointQuery query;
                    query.position =
                        Vec3(0.6f * (random() - 0.5f), 0.6f * (random() - 0.5f), float(z));
                    query.towards = Vec3(0, 0, 1);
                    query.radius = 0.1f;
                    query.mostEdges = 9;
                    query.inwards = Vec3(0, 0, d == 2 ? -1 : 1);
                    query.depth = float(d == 2 ? 0.0 : z);
                    query.beyond = float(d == 2 ? top : top - z);
                    sum += double(map.gather(query).x) * 4.0 * 3.14159265358979;
                }
                seen[d].add(sum / 50.0);
            }
        }
        for (int d = 0; d < 3; ++d)
        {
            CAPTURE(thickness, d, seen[d].mean(), seen[d].standardError());
            CHECK(seen[d].standardError() < 0.03);
            CHECK(seen[d].agrees(fluence(top * 0.5 * d)));
        }
    }
}

// The mean way is a hundredth of the body, and the spheres of the first passes are wider than that.
// So is the slab.
TEST_CASE("points: a close-up of a dense body that does not absorb is not seen in a white sky",
          "[photons][statistics][media]")
{
    for (const float thickness : {2.0f, 0.02f})
    {
        SceneBuilder builder;
        addSky(builder);
        builder.add(boxMesh({-1, -1, 1.0f - thickness}, {1, 1, 1}), bodyOf(mediumOf(100.0f, 1.0f)));
        const auto traced = builder.build();
        RenderOptions options = optionsOf(IntegratorKind::Sppm, 24);
        options.photons = 2000;
        const Estimate seen = measure(traced, patchView({0, 0, 1}, {0, 0, 1}, 1.6, 16), options, 1);
        CAPTURE(thickness, seen.mean(), seen.standardError());
        CHECK(seen.standardError() < (thickness > 1.0f ? 0.05 : 0.02));
        CHECK(seen.agrees(1.0, 0.02));
    }
}
